#include "pack/scene_features.h"

#include "scene/lights.h"

#include <algorithm>

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

} // namespace

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

} // namespace isolux
