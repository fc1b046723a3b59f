// Pixels that stand out: differences that the images' own noise does not explain, and fireflies.
#pragma once

#include "film/image.h"

#include <cstdint>
#include <limits>
#include <optional>

namespace isolux {

/// A firefly is so many times brighter than all around it in the other image, and than its own neighbours' median.
inline constexpr double kFireflyFactor = 10.0;

/// Counts of pixels, by luminance. Pixels that are NaN or infinite are in none of them: PixelDefects counts those.
struct Outliers {
    /// |a - b| > zLimit * sqrt(variance of a + variance of b) + float32 storage, where zLimit gives a 1 % chance of any
    /// such pixel if noise were normal. Noise of few samples is not: its tails are heavy, and a pixel that missed a
    /// rare bright path believes itself exact. Nothing if neither image carries variance.
    std::optional<std::uint64_t> beyondNoise;
    double zLimit = std::numeric_limits<double>::quiet_NaN();
    /// Single pixels brighter than kFireflyFactor times both the brightest of the other image's 3 x 3 pixels there and
    /// the median of their own up to eight neighbours.
    std::uint64_t imageFireflies = 0;
    std::uint64_t referenceFireflies = 0;
};

/// The images must have the same size and channels R, G and B; throws Error (bad input) if channels are missing.
[[nodiscard]] Outliers findOutliers(const Image& image, const Image& reference);

} // namespace isolux
