#include "report/sample_map.h"

#include "report/heatmap.h"

#include <algorithm>

namespace isolux {

Image sampleMap(const Film& film, std::uint64_t maxSamples) {
    Image image{film.width, film.height, {"R", "G", "B", "samples.Y"}, {}, {}};
    image.metadata["isolux/sampleMapMax"] = unsignedMetadata(maxSamples);
    image.values.reserve(4 * film.pixels.size());
    const auto most = static_cast<double>(std::max<std::uint64_t>(maxSamples, 1));
    for (const PixelStatistics& pixel : film.pixels) {
        const auto count = static_cast<double>(pixel.sampleCount);
        const Vec3f color(rampColor(Ramp::sequential, count / most));
        image.values.insert(image.values.end(), {color.x, color.y, color.z, static_cast<float>(count)});
    }
    return image;
}

} // namespace isolux
