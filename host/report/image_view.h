// An image as the metrics see it: its colour channels, and the variance of its pixels in whichever form it carries.
#pragma once

#include "film/image.h"

#include <array>
#include <string_view>
#include <vector>

namespace isolux {

/// What a figure is about: luminance or one channel.
enum class Quantity { luminance, red, green, blue };
inline constexpr std::array kQuantities{Quantity::luminance, Quantity::red, Quantity::green, Quantity::blue};
[[nodiscard]] const char* quantityName(Quantity quantity);

/// In which form an image carries the variance of its pixels.
enum class VarianceSource {
    none,          ///< not at all, or some pixel has fewer than two samples
    withLuminance, ///< variance.R/G/B/Y and samples.Y
    channelsOnly,  ///< variance.R/G/B and samples.Y
    standardErrors ///< se.R/G/B: the standard error of each pixel
};

/// The colour of an image, in double. Keeps a reference to it.
class ImageView {
public:
    /// `role` names the image in the error: throws Error (bad input) if R, G or B is missing.
    ImageView(const Image& image, std::string_view role);

    [[nodiscard]] std::size_t pixelCount() const { return image_.pixelCount(); }
    [[nodiscard]] Vec3d color(std::size_t pixel) const;
    /// One quantity of every pixel.
    [[nodiscard]] std::vector<double> values(Quantity quantity) const;

    [[nodiscard]] VarianceSource varianceSource() const { return source_; }
    /// The variance of the mean of all pixels: sum(variance_i / samples_i) / N^2. NaN if the image carries no variance.
    /// Without variance.Y luminance is bounded from above: the channels are taken to be fully correlated.
    [[nodiscard]] double varianceOfMean(Quantity quantity) const;
    /// The variance of each channel of a pixel's value, variance / samples. NaN if the image carries none.
    [[nodiscard]] Vec3d pixelVariance(std::size_t pixel) const;
    /// The same of one quantity; luminance without variance.Y is bounded from above.
    [[nodiscard]] double pixelVariance(std::size_t pixel, Quantity quantity) const;

private:
    [[nodiscard]] VarianceSource findVariance() const;
    [[nodiscard]] Vec3d layer(std::size_t pixel, const std::array<std::size_t, 3>& channels) const;

    const Image& image_;
    std::array<std::size_t, 3> rgb_{};
    std::array<std::size_t, 3> varianceChannels_{};
    std::size_t luminanceVarianceChannel_ = 0;
    std::size_t samplesChannel_ = 0;
    VarianceSource source_ = VarianceSource::none;
};

} // namespace isolux
