// The lights of a scene and the table that chooses among them; shared by both renderers so that the same random words
// choose the same light. Positions are not here: each renderer has its own.
#pragma once

#include "scene/alias_table.h"
#include "scene/render_settings.h"
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
    std::vector<Light> lights;          ///< those to be sampled: emitting primitives, punctual lights, the environment
    std::vector<std::uint32_t> lightOf; ///< primitive id -> light, or kNoLight
    std::uint32_t environment = kNoLight;
    AliasTable choice; ///< chooses a light by its power (luminance of the emitted flux)

    LightChoice mode = LightChoice::one;
    std::uint32_t samplesPerArea = 1; ///< N of the settings
    std::uint32_t areaCount = 0;      ///< lights[0] ... lights[areaCount - 1] are area lights,
    std::uint32_t punctualCount = 0;  ///< so many punctual ones follow
    std::uint32_t sampleCount = 0;    ///< light samples taken at a shading point; 0 without a light
    std::vector<double> samplesOf;    ///< the expected number of samples of each light among them

    /// With LightChoice::all: the light that sample `index` of a shading point, below sampleCount, goes to.
    [[nodiscard]] std::uint32_t lightOfSample(std::uint32_t index) const;
};

/// Collects every light of positive power that the settings want sampled, which is none but punctual ones with
/// LightSampling::hemisphere and ::bsdf, as scattered rays find the others, and none at all where no light is followed.
/// Emitting primitives of positive area in primitive order, punctual lights in scene order, the environment. Surfaces
/// with an emission map count with its mean over each triangle (`emission.h`), whatever their alpha; those whose mean
/// is zero, though a texel between two lookups may shine, are left to scattering. Lights from infinitely far count with
/// what they send through the disc of the scene's radius (Pharr, Jakob and Humphreys 2023, 12.2 and 12.5). Throws Error
/// if more samples a shading point are asked for than can be numbered (2^31 - 1).
[[nodiscard]] LightTable buildLightTable(const Scene& scene, const RenderSettings& settings = {});

} // namespace isolux
