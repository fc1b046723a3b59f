#include "app/symptoms.h"

#include "reference/ray_caster.h"
#include "reference/surface.h"
#include "scene/lights.h"

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

SceneSide sideOf(const Scene& scene, const Camera& camera) {
    const Box3d bounds = worldBounds(scene);
    if (bounds.empty()) return SceneSide::unknown;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d point((corner & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                          (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                          (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z);
        if (glm::dot(point - camera.position, -camera.worldFromCamera[2]) > 0.0) return SceneSide::inFront;
    }
    return SceneSide::behind;
}

/// Directions all around, evenly: a Fibonacci lattice on the sphere (Gonzalez 2010, "Measurement of areas on a sphere
/// using Fibonacci and latitude-longitude lattices").
Vec3d latticeDirection(int index, int count) {
    const double z = 1.0 - (2.0 * index + 1.0) / count;
    const double turn = 2.0 * kPi * index * 0.6180339887498949;
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(turn), radius * std::sin(turn), z};
}

/// Inside a solid if one object's back faces are seen all around.
CameraPlace placeOf(const Scene& scene, const Camera& camera, BackFaces backFaces) {
    constexpr int kProbes = 128;
    const World<double> world = flatten<double>(scene);
    const RayCaster<double> caster(world);
    std::optional<std::uint32_t> around;
    for (int i = 0; i < kProbes; ++i) {
        const Ray<double> ray{camera.position, latticeDirection(i, kProbes)};
        const std::optional<Hit<double>> hit = caster.nearest(ray);
        if (!hit) return CameraPlace::outside;
        const bool fromBehind = surfaceAt(world, ray, *hit).side() == Side::back;
        const std::uint32_t object = world.objectOf(hit->primitive);
        const bool culled =
            backFaces == BackFaces::culled && scene.materials[world.materialOf(hit->primitive)].isSingleSided();
        if (!fromBehind || culled || (around && *around != object)) return CameraPlace::outside;
        around = object;
    }
    return CameraPlace::insideSolid;
}

} // namespace

ImageSymptoms gatherSymptoms(const Film& film, const SceneRun& run) {
    ImageSymptoms symptoms = symptomsOf(film);
    symptoms.surfaceCount = primitiveCount(run.scene);
    const bool followed = followsLight(run.settings);
    const std::uint32_t depth = countedBounces(run.settings).last;
    if (followed && depth != kUnlimitedDepth) symptoms.maxDepth = depth;
    if (symptoms.meanLuminance != 0.0) return symptoms;
    // Black is a base colour like another, and what leaves a pixel without ambient light is no fault of the scene.
    if (!followed && symptoms.hitShare > 0.0) symptoms.meanLuminance = std::numeric_limits<double>::quiet_NaN();
    const Camera& camera = run.scene.cameras[run.settings.camera];
    // Those that light nothing here count too: that there is nothing to light is another symptom.
    const std::size_t distant = run.scene.punctualLights.size() + (run.scene.environment.emits() ? 1 : 0);
    symptoms.lightCount = followed ? std::max(buildLightTable(run.scene).lights.size(), distant) : 1;
    symptoms.sceneSide = sideOf(run.scene, camera);
    symptoms.cameraPlace = placeOf(run.scene, camera, run.settings.backFaces);
    return symptoms;
}

} // namespace isolux
