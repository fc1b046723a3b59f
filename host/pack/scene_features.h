// What a scene needs of the kernels. Everything it does not need is left out of them by specialisation.
#pragma once

#include "scene/render_settings.h"
#include "scene/scene.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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
    bool environmentMap = true;
    bool specular = true;      ///< some surface reflects other than diffusely
    bool roughSpecular = true; ///< some of them not as a mirror
    bool glass = true;         ///< some surface transmits
    bool roughGlass = true;    ///< some of them not smoothly
    bool solids = true;        ///< some of them bounds a solid: refraction
    bool absorption = true;    ///< some solid absorbs
    bool baseColorMaps = true; ///< maps that are constant, and normal maps that are flat, count as absent
    bool metallicRoughnessMaps = true;
    bool normalMaps = true;
    bool emissionMaps = true;
    bool transmissionMaps = true; ///< and those of thickness
    bool specularMaps = true;     ///< and those of its colour
    bool vertexColors = true;
    bool alphaMask = true;
    bool alphaBlend = true;
    bool unlit = true;
    bool backFaceCulling = true; ///< some surface has no back
    bool coincident = true;      ///< some triangles lie at the same spot

    friend bool operator==(const SceneFeatures&, const SceneFeatures&) = default;
};

/// The features that are there or not, by the names that options and reports have for them.
struct NamedFeature {
    std::string_view name; ///< in kebab case
    bool SceneFeatures::*flag;
};
[[nodiscard]] std::span<const NamedFeature> namedFeatures();

/// The features that a render of this scene can reach.
[[nodiscard]] SceneFeatures findFeatures(const Scene& scene, const RenderSettings& settings);

/// A feature, and what in the scene or the settings decided about it.
struct FeatureNote {
    std::string name; ///< as in `namedFeatures`; "light-choice" and "roulette" besides
    bool used = false;
    std::string reason; ///< half a sentence: "2 of 5 materials have one", "no mesh has any"
};

/// Why each feature is used or left out, in the order of the struct.
[[nodiscard]] std::vector<FeatureNote> explainFeatures(const Scene& scene, const RenderSettings& settings);

} // namespace isolux
