// The lights of a scene and the table that chooses among them; shared by both renderers so that the same random words
// choose the same light. Positions are not here: each renderer has its own.
#pragma once

#include "scene/alias_table.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace isolux {

inline constexpr std::uint32_t kNoLight = 0xFFFFFFFFu;

enum class LightKind : std::uint32_t { area, punctual, environment };

struct Light {
    LightKind kind = LightKind::area;
    std::uint32_t index = 0; ///< area: primitive id (the order of `primitiveCount`); punctual: into the scene's list

    friend bool operator==(const Light&, const Light&) = default;
};

struct LightTable {
    std::vector<Light> lights;          ///< emitting primitives, punctual lights, the environment
    std::vector<std::uint32_t> lightOf; ///< primitive id -> light, or kNoLight
    std::uint32_t environment = kNoLight;
    AliasTable choice; ///< chooses a light by its power (luminance of the emitted flux)
};

/// Collects every light of positive power: emitting primitives of positive area in primitive order, punctual lights in
/// scene order, the environment. Lights from infinitely far count with what they send through the disc of the scene's
/// radius (Pharr, Jakob and Humphreys 2023, 12.2 and 12.5).
[[nodiscard]] LightTable buildLightTable(const Scene& scene);

} // namespace isolux
