// The mean luminance of a film, and how well its own samples know it.
#pragma once

#include "film/film.h"

#include <cmath>
#include <limits>

namespace isolux {

[[nodiscard]] inline double meanLuminance(const Film& film) {
    double sum = 0.0;
    for (const PixelStatistics& pixel : film.pixels) sum += luminance(pixel.mean);
    return sum / static_cast<double>(film.pixels.size());
}

/// Of it; NaN while a pixel has fewer than two samples.
[[nodiscard]] inline double standardError(const Film& film) {
    double sum = 0.0;
    for (const PixelStatistics& pixel : film.pixels) {
        if (pixel.sampleCount < 2) return std::numeric_limits<double>::quiet_NaN();
        sum += pixel.luminanceVariance() / static_cast<double>(pixel.sampleCount);
    }
    return std::sqrt(sum) / static_cast<double>(film.pixels.size());
}

} // namespace isolux
