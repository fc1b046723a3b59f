// Leaves of an image file what its picture is made of. Decoders read metadata too, of which nothing is used here, and
// OpenImageIO's readers of it do not keep to the bounds of what they read.
#pragma once

#include "load/bytes.h"

namespace isolux {

/// A PNG without its ancillary chunks (but transparency, tRNS), a JPEG whose application segments (but JFIF's and
/// Adobe's, which say what its colours are) and comments are zeros, a WebP whose EXIF, XMP and ICCP chunks have other
/// names. Anything else as it is, and from where it is damaged on.
[[nodiscard]] Bytes withoutMetadata(ByteSpan image);

} // namespace isolux
