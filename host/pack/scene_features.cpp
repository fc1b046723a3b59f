#include "pack/scene_features.h"

#include "scene/lights.h"

#include <algorithm>

namespace isolux {
namespace {

bool isSmooth(const Scene& scene, const Instance& instance) { return !scene.meshes[instance.mesh].normals.empty(); }

LightCount countLights(const Scene& scene) {
    const std::size_t lights = buildLightTable(scene).lights.size();
    return lights == 0 ? LightCount::none : lights == 1 ? LightCount::one : LightCount::many;
}

} // namespace

SceneFeatures findFeatures(const Scene& scene, const RenderSettings& settings) {
    SceneFeatures features;
    features.spheres = !scene.spheres.empty();
    features.smoothNormals = std::any_of(scene.instances.begin(), scene.instances.end(),
                                         [&](const Instance& instance) { return isSmooth(scene, instance); });
    // A path of maxDepth bounces is never asked whether to make bounce maxDepth + 1.
    features.roulette = settings.maxDepth >= settings.rouletteStart;
    features.lights = countLights(scene);
    return features;
}

} // namespace isolux
