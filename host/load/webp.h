// WebP containers (Google 2010, "WebP Container Specification").
#pragma once

#include "load/bytes.h"

namespace isolux {

/// A WebP file as if it had no alpha: decoders then give colours as stored. OpenImageIO multiplies alpha into them (in
/// 2.4 whatever it is asked), which cannot be undone where alpha is small.
[[nodiscard]] Bytes withoutAlpha(ByteSpan webp);

} // namespace isolux
