#include "report/sample_map.h"

#include "report/heatmap.h"

namespace isolux {

Image sampleMap(const Film& film, std::uint64_t maxSamples) {
    Image image;
    image.width = film.width;
    image.height = film.height;
    image.channels = {"R", "G", "B"};
    for (const PixelStatistics& pixel : film.pixels) {
        const Vec3d color =
            rampColor(Ramp::sequential, static_cast<double>(pixel.sampleCount) / static_cast<double>(maxSamples));
        for (int c = 0; c < 3; ++c) image.values.push_back(static_cast<float>(color[c]));
    }
    return image;
}

} // namespace isolux
