#include "report/image_view.h"

#include "core/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>

namespace isolux {
namespace {

std::optional<std::array<std::size_t, 3>> layerChannels(const Image& image, const std::string& layer) {
    const auto r = image.channel(layer + ".R");
    const auto g = image.channel(layer + ".G");
    const auto b = image.channel(layer + ".B");
    if (!r || !g || !b) return std::nullopt;
    return std::array{*r, *g, *b};
}

double select(const Vec3d& rgb, Quantity quantity) {
    switch (quantity) {
    case Quantity::luminance: return luminance(rgb);
    case Quantity::red: return rgb.x;
    case Quantity::green: return rgb.y;
    case Quantity::blue: return rgb.z;
    }
    return 0.0;
}

} // namespace

const char* quantityName(Quantity quantity) {
    switch (quantity) {
    case Quantity::luminance: return "luminance";
    case Quantity::red: return "R";
    case Quantity::green: return "G";
    case Quantity::blue: return "B";
    }
    return "";
}

ImageView::ImageView(const Image& image, std::string_view role) : image_(image) {
    const auto rgb = image.rgbChannels();
    if (!rgb) {
        throwBadInput(role,
                      fmt::format("has no channels R, G and B; its channels are: {}", fmt::join(image.channels, ", ")));
    }
    rgb_ = *rgb;
    if (const auto errors = layerChannels(image, "se")) {
        varianceChannels_ = *errors;
        source_ = VarianceSource::standardErrors;
    }
    const auto variances = layerChannels(image, "variance");
    const auto samples = image.channel("samples.Y");
    if (!variances || !samples) return;
    varianceChannels_ = *variances;
    samplesChannel_ = *samples;
    luminanceVarianceChannel_ = image.channel("variance.Y").value_or(0);
    source_ = findVariance();
}

/// A variance estimated from one sample is not 0 but unknown, and so is then the variance of the whole.
VarianceSource ImageView::findVariance() const {
    for (std::size_t pixel = 0; pixel < pixelCount(); ++pixel) {
        if (!(image_.value(pixel, samplesChannel_) >= 2.0f)) return VarianceSource::none;
    }
    return image_.channel("variance.Y") ? VarianceSource::withLuminance : VarianceSource::channelsOnly;
}

Vec3d ImageView::layer(std::size_t pixel, const std::array<std::size_t, 3>& channels) const {
    return {image_.value(pixel, channels[0]), image_.value(pixel, channels[1]), image_.value(pixel, channels[2])};
}

Vec3d ImageView::color(std::size_t pixel) const { return layer(pixel, rgb_); }

std::vector<double> ImageView::values(Quantity quantity) const {
    std::vector<double> result(pixelCount());
    for (std::size_t pixel = 0; pixel < result.size(); ++pixel) result[pixel] = select(color(pixel), quantity);
    return result;
}

Vec3d ImageView::pixelVariance(std::size_t pixel) const {
    if (source_ == VarianceSource::none) return Vec3d(std::numeric_limits<double>::quiet_NaN());
    const Vec3d stored = layer(pixel, varianceChannels_);
    return source_ == VarianceSource::standardErrors ? stored * stored
                                                     : stored / double{image_.value(pixel, samplesChannel_)};
}

double ImageView::pixelVariance(std::size_t pixel, Quantity quantity) const {
    const Vec3d channels = pixelVariance(pixel);
    if (quantity != Quantity::luminance) return select(channels, quantity);
    if (source_ == VarianceSource::withLuminance) {
        return double{image_.value(pixel, luminanceVarianceChannel_)} / double{image_.value(pixel, samplesChannel_)};
    }
    const double deviation = luminance(Vec3d(glm::sqrt(channels))); // fully correlated: standard deviations add
    return deviation * deviation;
}

double ImageView::varianceOfMean(Quantity quantity) const {
    double sum = 0.0;
    for (std::size_t pixel = 0; pixel < pixelCount(); ++pixel) sum += pixelVariance(pixel, quantity);
    const double count = static_cast<double>(pixelCount());
    return sum / (count * count);
}

} // namespace isolux
