// An image with named channels and metadata, and its files.
#pragma once

#include "film/film.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace isolux {

using MetadataValue = std::variant<std::string, std::int64_t, double>;
using Metadata = std::map<std::string, MetadataValue>;

/// Channels one after the other in memory order pixel by pixel (interleaved), rows from the top.
struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::string> channels; ///< EXR names: "R", "G", "B", "A", "variance.R", ..., "samples.Y"
    std::vector<float> values;         ///< width * height * channels.size()
    Metadata metadata;

    /// Index of a channel by name, or nothing.
    [[nodiscard]] std::optional<std::size_t> channel(std::string_view name) const;
    [[nodiscard]] float value(std::size_t pixel, std::size_t channelIndex) const {
        return values[pixel * channels.size() + channelIndex];
    }
};

/// Root R G B A, variance.R/G/B and variance.Y (of one sample; Y is luminance), samples.Y; metadata isolux/sampleCount.
[[nodiscard]] Image imageFromFilm(const Film& film, Metadata metadata);

/// Writes OpenEXR (float32, all channels), PNG (8 bit, sRGB transfer function) or HDR by the extension of `path`: to a
/// temporary name beside it, flushed, then renamed. Throws Error; a file already at `path` survives every failure.
void writeImage(const std::filesystem::path& path, const Image& image);

/// Throws Error (bad input) early if `path` has no supported extension or its folder does not exist or is not writable.
void checkImagePath(const std::filesystem::path& path);

/// Reads any image OpenImageIO knows, as float; 8-bit files are decoded from sRGB to linear. Throws Error (bad input).
[[nodiscard]] Image readImage(const std::filesystem::path& path);

} // namespace isolux
