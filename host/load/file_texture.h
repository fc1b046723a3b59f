// A texture as the file has it, before its image is read.
#pragma once

#include "scene/scene.h"

namespace isolux {

struct FileTexture {
    std::optional<std::uint32_t> image; ///< of the file; empty if it has none of a format that is supported
    Texture sampling{};                 ///< wrap modes and filter; its image is not set
};

} // namespace isolux
