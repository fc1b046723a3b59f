#include "film/image.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
    std::optional<std::uint64_t> operator()(const MetadataMatrix&) const { return std::nullopt; }
};

struct TextWriter {
    std::string operator()(const MetadataMatrix& matrix) const { return fmt::format("{}", fmt::join(matrix, " ")); }
    template <typename Value> std::string operator()(const Value& value) const { return fmt::format("{}", value); }
};

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

MetadataValue matrixMetadata(const Mat4d& targetFromSource) {
    MetadataMatrix matrix{}; // a column of column vectors' matrix is a row of row vectors'
    for (int i = 0; i < 16; ++i)
        matrix[static_cast<std::size_t>(i)] = static_cast<float>(targetFromSource[i / 4][i % 4]);
    return matrix;
}

std::optional<std::uint64_t> metadataUnsigned(const Metadata& metadata, const std::string& name) {
    const auto found = metadata.find(name);
    if (found == metadata.end()) return std::nullopt;
    return std::visit(UnsignedReader{}, found->second);
}

std::optional<std::string> metadataText(const Metadata& metadata, const std::string& name) {
    const auto found = metadata.find(name);
    if (found == metadata.end()) return std::nullopt;
    return std::visit(TextWriter{}, found->second);
}

} // namespace isolux
