// What a load may take of memory, whatever the file says.
#pragma once

#include <cstdint>

namespace isolux {

/// The defaults are for scenes that people render; smaller ones keep a search for faults quick.
struct LoadLimits {
    int imageSide = 16384;                             ///< texels
    std::uint64_t texelBytes = std::uint64_t{1} << 32; ///< of all images together
    std::uint64_t meshBytes = std::uint64_t{1} << 30;  ///< of all meshes, before they are held against their buffers
    double environmentTexels = 0x1p28;
};

} // namespace isolux
