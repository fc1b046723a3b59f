// Decodes PNG, JPEG and WebP from memory, into texels as stored.
#pragma once

#include "load/bytes.h"
#include "load/json_reader.h"
#include "scene/scene.h"

namespace isolux {

/// Bytes of an image, and where the file names it.
struct EncodedImage {
    ByteSpan bytes;
    JsonReader where;
};

/// That an image of a format which is known has a header that can be read, and that this claims no more than 16384
/// texels a side and what so few bytes can hold. Nothing is decoded.
void requireReasonableHeader(const EncodedImage& image);

/// The format is told by the first bytes. Beside what the header is held to above, the texels may take `mostBytes`: all
/// is checked before memory is taken. No colour is converted, no alpha multiplied in.
[[nodiscard]] TextureImage decodeImage(const EncodedImage& image, std::uint64_t mostBytes);

} // namespace isolux
