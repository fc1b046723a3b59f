// An environment map as kernels read it.
#pragma once

#include "pack/tables.h"
#include "scene/scene.h"

#include <cstdint>

namespace isolux {

struct PackedEnvironment {
    std::uint32_t texels = 0; ///< first word: radiance of each texel, and in w the density of its cell's directions
    std::uint32_t bins = 0;   ///< first word of the alias table of its cells
    std::uint32_t bits = 0;
    std::uint32_t width = 0; ///< 0: there is no map
    std::uint32_t height = 0;
    double texelScale = 1.0; ///< packed texels over the map's: the brightest near 1
};

/// The brightest component of any texel.
[[nodiscard]] double brightestTexel(const EnvironmentMap& map);

/// With every texel times `texelScale`.
[[nodiscard]] PackedEnvironment appendEnvironment(Tables& tables, const EnvironmentMap& map, double texelScale);

} // namespace isolux
