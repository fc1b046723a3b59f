// An image with named channels and metadata, and its files.
#pragma once

#include "film/film.h"
#include "film/tonemap.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace isolux {

/// A 4 x 4 matrix as OpenEXR has it: row by row, for row vectors (p' = p M), so that the last row translates.
using MetadataMatrix = std::array<float, 16>;
using MetadataValue = std::variant<std::string, std::int64_t, double, MetadataMatrix>;
using Metadata = std::map<std::string, MetadataValue>;

/// Channels one after the other in memory order pixel by pixel (interleaved), rows from the top.
struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::string> channels; ///< EXR names: "R", "G", "B", "A", "variance.R", ..., "samples.Y"
    std::vector<float> values;         ///< width * height * channels.size()
    Metadata metadata;

    [[nodiscard]] std::size_t pixelCount() const { return std::size_t{width} * height; }
    /// Index of a channel by name, or nothing.
    [[nodiscard]] std::optional<std::size_t> channel(std::string_view name) const;
    /// Indices of the channels R, G and B, or nothing if one is missing.
    [[nodiscard]] std::optional<std::array<std::size_t, 3>> rgbChannels() const;
    [[nodiscard]] float value(std::size_t pixel, std::size_t channelIndex) const {
        return values[pixel * channels.size() + channelIndex];
    }
};

/// A count or seed as metadata: an integer, or its decimal digits where 64 bits with a sign cannot hold it.
[[nodiscard]] MetadataValue unsignedMetadata(std::uint64_t value);

/// A transform of column vectors, such as worldToCamera = cameraFromWorld, as metadata.
[[nodiscard]] MetadataValue matrixMetadata(const Mat4d& targetFromSource);

/// The value under `name` as an unsigned integer, given as a number or as decimal digits; nothing if there is none.
[[nodiscard]] std::optional<std::uint64_t> metadataUnsigned(const Metadata& metadata, const std::string& name);

/// The value under `name` as text, numbers in the shortest form that reads back exactly; nothing if there is none.
[[nodiscard]] std::optional<std::string> metadataText(const Metadata& metadata, const std::string& name);

/// The layers variance and samples of film/layers.h, which has images with others, beside R G B A.
[[nodiscard]] Image imageFromFilm(const Film& film, Metadata metadata);

/// Writes OpenEXR (float32, all channels), PNG (8 bit, `display` applied, sRGB transfer function) or HDR by the
/// extension of `path`: to a temporary name beside it, flushed, then renamed. Throws Error; a file already at `path`
/// survives every failure. Warns of values that HDR cannot hold.
void writeImage(const std::filesystem::path& path, const Image& image, const DisplayTransform& display = {});

/// Throws Error (bad input) early if `path` has no supported extension, names a folder, or its folder does not exist or
/// cannot be written to.
void checkImagePath(const std::filesystem::path& path);

/// Whether files of this name keep every channel: OpenEXR does, PNG and HDR show R G B alone.
[[nodiscard]] bool holdsLayers(const std::filesystem::path& path);

/// Reads any image OpenImageIO knows, as float: integer formats are decoded from sRGB to linear, with associated alpha;
/// others are taken as they are. EXR channels may come in another order than they were written in. Throws Error (bad
/// input).
[[nodiscard]] Image readImage(const std::filesystem::path& path);

} // namespace isolux
