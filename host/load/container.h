// Splits a file into its JSON text and its binary chunk: .gltf is all JSON, .glb is told by its first four bytes.
#pragma once

#include "load/bytes.h"

#include <optional>
#include <string_view>

namespace isolux {

struct Container {
    std::string_view json;
    std::optional<ByteSpan> binary; ///< the BIN chunk of a .glb, if it has one
};

/// The parts point into `file`.
[[nodiscard]] Container splitContainer(ByteSpan file, LoadContext& context);

} // namespace isolux
