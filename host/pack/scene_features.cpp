#include "pack/scene_features.h"

#include "scene/lights.h"

#include <algorithm>
#include <array>

namespace isolux {
namespace {

bool isSmooth(const Scene& scene, const Instance& instance) { return !scene.meshes[instance.mesh].normals.empty(); }

LightCount countLights(const LightTable& table) {
    const std::size_t lights = table.lights.size();
    return lights == 0 ? LightCount::none : lights == 1 ? LightCount::one : LightCount::many;
}

bool hasKind(const LightTable& table, LightKind kind) {
    return std::any_of(table.lights.begin(), table.lights.end(),
                       [&](const Light& light) { return light.kind == kind; });
}

constexpr auto kNamed = std::to_array<NamedFeature>({
    {"spheres", &SceneFeatures::spheres},
    {"smooth-normals", &SceneFeatures::smoothNormals},
    {"area-lights", &SceneFeatures::areaLights},
    {"punctual-lights", &SceneFeatures::punctualLights},
    {"environment", &SceneFeatures::environment},
    {"environment-map", &SceneFeatures::environmentMap},
    {"specular", &SceneFeatures::specular},
    {"rough-specular", &SceneFeatures::roughSpecular},
    {"glass", &SceneFeatures::glass},
    {"rough-glass", &SceneFeatures::roughGlass},
    {"solids", &SceneFeatures::solids},
    {"absorption", &SceneFeatures::absorption},
    {"base-color-maps", &SceneFeatures::baseColorMaps},
    {"metallic-roughness-maps", &SceneFeatures::metallicRoughnessMaps},
    {"normal-maps", &SceneFeatures::normalMaps},
    {"emission-maps", &SceneFeatures::emissionMaps},
    {"transmission-maps", &SceneFeatures::transmissionMaps},
    {"specular-maps", &SceneFeatures::specularMaps},
    {"vertex-colors", &SceneFeatures::vertexColors},
    {"alpha-mask", &SceneFeatures::alphaMask},
    {"alpha-blend", &SceneFeatures::alphaBlend},
    {"unlit", &SceneFeatures::unlit},
});

} // namespace

std::span<const NamedFeature> namedFeatures() { return kNamed; }

SceneFeatures findFeatures(const Scene& scene, const RenderSettings& settings) {
    SceneFeatures features;
    features.spheres = !scene.spheres.empty();
    features.smoothNormals = std::any_of(scene.instances.begin(), scene.instances.end(),
                                         [&](const Instance& instance) { return isSmooth(scene, instance); });
    // A path of the last bounce is never asked whether to make another.
    const bool asked = followsLight(settings) && countedBounces(settings).last >= settings.roulette.start;
    features.roulette = asked ? settings.roulette.kind : Roulette::off;
    const LightTable lights = buildLightTable(scene, settings);
    features.lights = countLights(lights);
    features.areaLights = hasKind(lights, LightKind::area);
    features.punctualLights = hasKind(lights, LightKind::punctual);
    features.environment =
        followsLight(settings) && scene.environment.emits(); // seen, even if there is nothing that it could light
    return features;
}

std::vector<FeatureNote> explainFeatures(const Scene& scene, const RenderSettings& settings) {
    const SceneFeatures features = findFeatures(scene, settings);
    std::vector<FeatureNote> notes;
    for (const NamedFeature& named : kNamed)
        notes.push_back({std::string(named.name), features.*named.flag,
                         features.*named.flag ? "the scene has it" : "the scene has none"});
    return notes;
}

} // namespace isolux
