// How far an image is from a reference: squared and absolute errors, means, and what is wrong with the pixels.
#pragma once

#include "report/image_view.h"
#include "report/statistics.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace isolux {

/// What keeps relative errors of dark pixels finite: they are relative to sqrt(b^2 + 0.01) (Rousselle et al. 2011).
inline constexpr double kRelMseOffset = 0.01;

/// Pixels with at least one such colour channel.
struct PixelDefects {
    std::uint64_t nan = 0;
    std::uint64_t infinite = 0;
    std::uint64_t negative = 0;

    [[nodiscard]] bool finite() const { return nan + infinite == 0; }
};

struct ColorMean {
    Vec3d rgb{std::numeric_limits<double>::quiet_NaN()};
    double luminance = std::numeric_limits<double>::quiet_NaN();
};

/// Errors of an image against a reference, over all pixels and the channels R, G and B (linear). If a pixel of either
/// is NaN or infinite, every error is NaN: a figure over the other pixels would hide it.
struct ImageErrors {
    double mse = std::numeric_limits<double>::quiet_NaN();
    double rmse = std::numeric_limits<double>::quiet_NaN();
    double relativeRmse = std::numeric_limits<double>::quiet_NaN(); ///< rmse / mean(reference)
    /// mean((a - b)^2 / (b^2 + 0.01)) (Rousselle et al. 2011), with the interval of `stratifiedMean`.
    Interval relMse;
    double relMseTrimmed = std::numeric_limits<double>::quiet_NaN(); ///< the same without the worst 0.1 % of pixels
    double mae = std::numeric_limits<double>::quiet_NaN();
    double maxAbs = std::numeric_limits<double>::quiet_NaN();
    /// The part of mse that noise alone explains: the mean of variance / samples of both images, as far as they carry
    /// it. For independent images mse - noiseMse estimates the squared bias. NaN if neither carries variance.
    double noiseMse = std::numeric_limits<double>::quiet_NaN();
    ColorMean imageMean;
    ColorMean referenceMean;
    PixelDefects imageDefects;
    PixelDefects referenceDefects;
    std::uint64_t pixelCount = 0;
    std::uint64_t litPixelCount = 0; ///< pixels where the reference's luminance is above 0
};

/// The views must have as many pixels as each other; `width` tells where rows end.
[[nodiscard]] ImageErrors imageErrors(const ImageView& image, const ImageView& reference, std::uint32_t width);

/// relMSE of each pixel, the mean of its channels.
[[nodiscard]] std::vector<double> relMsePixels(const ImageView& image, const ImageView& reference);

/// The mean over an image's pixels of a figure whose noise is independent from pixel to pixel, with the t interval of
/// that noise: the variance is estimated within blocks of about 16 x 16 pixels (strata), never between them, so that
/// what differs from place to place in the image does not count as noise. What differs inside a block does: the
/// interval is too wide rather than too narrow. One pixel has no interval.
[[nodiscard]] Interval stratifiedMean(std::span<const double> pixels, std::uint32_t width);

} // namespace isolux
