#include "film/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace isolux {
namespace {

std::optional<std::uint64_t> parseUnsigned(std::string_view digits) {
    std::uint64_t value = 0;
    const char* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (error != std::errc{} || stop != end) return std::nullopt;
    return value;
}

struct UnsignedReader {
    std::optional<std::uint64_t> operator()(const std::string& text) const { return parseUnsigned(text); }
    std::optional<std::uint64_t> operator()(std::int64_t value) const {
        return value < 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(value));
    }
    std::optional<std::uint64_t> operator()(double) const { return std::nullopt; }
};

std::array<float, 9> channelValues(const PixelStatistics& pixel) {
    const Vec3f mean(pixel.mean);
    const Vec3f variance(pixel.variance());
    const double count = static_cast<double>(pixel.sampleCount);
    const double coverage = pixel.sampleCount == 0 ? 0.0 : static_cast<double>(pixel.hitCount) / count;
    return {mean.x,
            mean.y,
            mean.z,
            static_cast<float>(coverage),
            variance.x,
            variance.y,
            variance.z,
            static_cast<float>(pixel.luminanceVariance()),
            static_cast<float>(count)};
}

} // namespace

std::optional<std::size_t> Image::channel(std::string_view name) const {
    const auto found = std::find(channels.begin(), channels.end(), name);
    if (found == channels.end()) return std::nullopt;
    return static_cast<std::size_t>(found - channels.begin());
}

std::optional<std::array<std::size_t, 3>> Image::rgbChannels() const {
    const auto r = channel("R");
    const auto g = channel("G");
    const auto b = channel("B");
    if (!r || !g || !b) return std::nullopt;
    return std::array{*r, *g, *b};
}

MetadataValue unsignedMetadata(std::uint64_t value) {
    if (std::in_range<std::int64_t>(value)) return static_cast<std::int64_t>(value);
    return fmt::format("{}", value);
}

std::optional<std::uint64_t> metadataUnsigned(const Metadata& metadata, const std::string& name) {
    const auto found = metadata.find(name);
    if (found == metadata.end()) return std::nullopt;
    return std::visit(UnsignedReader{}, found->second);
}

std::optional<std::string> metadataText(const Metadata& metadata, const std::string& name) {
    const auto found = metadata.find(name);
    if (found == metadata.end()) return std::nullopt;
    return std::visit([](const auto& value) { return fmt::format("{}", value); }, found->second);
}

Image imageFromFilm(const Film& film, Metadata metadata) {
    Image image;
    image.width = film.width;
    image.height = film.height;
    image.channels = {"R", "G", "B", "A", "variance.R", "variance.G", "variance.B", "variance.Y", "samples.Y"};
    image.values.reserve(film.pixels.size() * image.channels.size());
    for (const PixelStatistics& pixel : film.pixels) {
        const std::array<float, 9> values = channelValues(pixel);
        image.values.insert(image.values.end(), values.begin(), values.end());
    }
    image.metadata = std::move(metadata);
    image.metadata["isolux/sampleCount"] = unsignedMetadata(film.maxSampleCount());
    return image;
}

} // namespace isolux
