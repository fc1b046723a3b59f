// WebP containers (Google 2010, "WebP Container Specification").
#pragma once

#include "load/bytes.h"

#include <optional>

namespace isolux {

struct WebpSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

/// What the first chunk says of the size, for OpenImageIO takes memory for all of it as soon as it opens a file;
/// nothing if that chunk starts no image.
[[nodiscard]] std::optional<WebpSize> webpSize(ByteSpan webp);

/// A WebP file as if it had no alpha: decoders then give colours as stored. OpenImageIO multiplies alpha into them (in
/// 2.4 whatever it is asked), which cannot be undone where alpha is small.
[[nodiscard]] Bytes withoutAlpha(ByteSpan webp);

/// Gives EXIF, XMP and ICCP chunks names that decoders skip.
void blankWebpMetadata(std::span<std::uint8_t> webp);

} // namespace isolux
