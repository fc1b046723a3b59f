// The area lights of a scene and the table that chooses among them; shared by both renderers so that the same random
// words choose the same light. Positions are not here: each renderer has its own.
#pragma once

#include "scene/alias_table.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace isolux {

inline constexpr std::uint32_t kNoLight = 0xFFFFFFFFu;

struct LightTable {
    std::vector<std::uint32_t> primitives; ///< light -> primitive id (the order of `primitiveCount`)
    std::vector<std::uint32_t> lightOf;    ///< primitive id -> light, or kNoLight
    AliasTable choice;                     ///< chooses a light by its power (luminance of the emitted flux)
};

/// Collects every emitting primitive of positive area, in primitive order.
[[nodiscard]] LightTable buildLightTable(const Scene& scene);

} // namespace isolux
