// What a scene needs of the kernels. Everything it does not need is left out of them by specialisation.
#pragma once

#include "scene/render_settings.h"
#include "scene/scene.h"

#include <cstdint>

namespace isolux {

enum class LightCount : std::uint32_t { none, one, many };

/// Leaving a feature out never changes an image or a buffer's layout; it only removes code that the scene cannot reach.
struct SceneFeatures {
    bool spheres = true;
    bool smoothNormals = true;
    Roulette roulette = Roulette::throughput; ///< `off` also where no path is long enough
    LightCount lights = LightCount::many;
    bool areaLights = true;
    bool punctualLights = true;
    bool environment = true;

    friend bool operator==(const SceneFeatures&, const SceneFeatures&) = default;
};

/// The features that a render of this scene can reach.
[[nodiscard]] SceneFeatures findFeatures(const Scene& scene, const RenderSettings& settings);

} // namespace isolux
