// Camera rays and what scatters from their first hits, by the conventions and random numbers of the renderer.
#include "ray_sets.h"

#include "core/philox.h"
#include "reference/camera.h"
#include "reference/sampling.h"
#include "reference/surface.h"

namespace isolux::bench {
namespace {

/// Of the scene's radius. The renderer's own offset is a bound on its own rounding, a few units in the last place; with
/// that, Embree finds the surface that a ray leaves for one ray in seven.
constexpr float kOffset = 1e-4f;

/// Light that a Lambertian surface scatters.
Ray<float> scattered(const Surface<float>& surface, float offset, const PhiloxBlock& words) {
    const Vec3f local = sampleCosineHemisphere(unitReal<float>(words[0]), unitReal<float>(words[1]));
    return {surface.position + offset * surface.facing, glm::normalize(frameAbout(surface.facing).toWorld(local))};
}

} // namespace

RaySets makeRaySets(const Scene& scene, const World<float>& world, const RayCaster<float>& caster,
                    const RenderSettings& settings) {
    const CameraRays<float> camera(scene.cameras[settings.camera], settings);
    const float offset = kOffset * static_cast<float>(worldRadius(scene));
    RaySets rays;
    for (std::uint32_t y = 0; y < settings.height; ++y)
        for (std::uint32_t x = 0; x < settings.width; ++x)
            for (std::uint32_t sample = 0; sample < settings.sampleCount; ++sample) {
                const Ray<float> ray = camera.sample(x, y, randomBlock(settings.seed, x, y, sample, 0));
                rays.primary.push_back(ray);
                if (const auto hit = caster.nearest(ray))
                    rays.bounce.push_back(
                        scattered(surfaceAt(world, ray, *hit), offset, randomBlock(settings.seed, x, y, sample, 2)));
            }
    return rays;
}

} // namespace isolux::bench
