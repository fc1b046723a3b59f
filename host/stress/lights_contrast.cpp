// Bright and dim lights: alone, beside each other, and a sun in its sky.
#include "stress/lights_parts.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace isolux {
namespace {

/// A white square in a closed room whose walls emit, and outside a lamp so many times brighter.
RenderTrial brightBesideDim(double ratio) {
    const double bright = std::sqrt(ratio), dim = 1.0 / bright;
    SceneBuilder builder;
    const std::uint32_t walls = builder.material(Vec3d(0.0), Vec3d(dim), Faces::front);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(bright), Faces::both);
    builder.mesh(roomMesh(walls));
    builder.mesh(squareMesh(0), translation({0.1, 0.0, -0.2}) * scaling({0.5, 0.5, 1.0}));
    builder.mesh(squareMesh(lamp), translation({2.0, 3.0, 6.0}));
    parallelCamera(builder, {0.1, 0.0, 0.5}, {0.1, 0.0, -0.2}, 0.4);
    return expecting(dim, builder.scene, directLight());
}

PunctualLight punctual(PunctualKind kind, const Vec3d& position, double intensity) {
    PunctualLight light;
    light.kind = kind;
    light.position = position;
    light.direction = glm::normalize(-position);
    light.intensity = Vec3d(intensity);
    return light;
}

/// Lights of every kind, all of them times a factor.
Scene everyLight(double factor) {
    SceneBuilder builder;
    const std::uint32_t lamp = builder.material(Vec3d(0.0), factor * Vec3d(9.0, 8.0, 7.0), Faces::front);
    const std::uint32_t glow = builder.material(Vec3d(0.2), factor * Vec3d(1.0, 2.0, 3.0), Faces::front);
    builder.scene.materials[0].baseColor = {0.7, 0.6, 0.5};
    builder.mesh(squareMesh(0), scaling({3.0, 3.0, 1.0}));
    builder.mesh(icosahedron(), translation({0.5, 0.3, 0.6}) * scaling(Vec3d(0.25)));
    builder.mesh(squareMesh(lamp), translation({0.0, 0.0, 2.5}) * scaling({0.5, 0.5, -1.0}));
    builder.scene.spheres = {{"", {-0.8, 0.2, 0.5}, 0.3, glow}};
    for (const PunctualKind kind : {PunctualKind::point, PunctualKind::spot, PunctualKind::directional})
        builder.scene.punctualLights.push_back(punctual(kind, {1.0, -1.0, 2.0}, 0.5 * factor));
    builder.scene.environment.radiance = Vec3d(0.25 * factor);
    builder.camera({0.5, -6.0, 2.5}, {0.0, 0.0, 0.6}, 0.5);
    return builder.scene;
}

RenderTrial alone(int exponent) {
    RenderTrial trial;
    trial.settings = directLight();
    trial.settings.maxDepth = 3;
    trial.imageFactor = std::exp2(exponent);
    trial.scene = everyLight(trial.imageFactor);
    trial.sameBitsAs = std::make_shared<Scene>(everyLight(1.0));
    return trial;
}

constexpr std::uint32_t kSkyWidth = 32, kSkyHeight = 16;
constexpr std::uint32_t kSunColumn = 2, kSunRow = 6;

/// Grey but for one texel.
EnvironmentMap skyWithSun(double sun) {
    EnvironmentMap map;
    map.width = kSkyWidth;
    map.height = kSkyHeight;
    map.texels.assign(std::size_t{kSkyWidth} * kSkyHeight, Vec3f(1.0f));
    map.texels[kSunRow * kSkyWidth + kSunColumn] = Vec3f(static_cast<float>(sun));
    return map;
}

/// What the sun's texel adds, at a height of 1 above the others, to the irradiance of a floor that looks along z: a
/// texel's share falls off to nothing over one texel to each side (host/scene/README.md, "Environment maps").
double irradianceOfTexel() {
    const double mean = meanOverSquare(1.0, 512, [](double x, double y) {
        const double turn = 2.0 * kPi * ((kSunColumn + 0.5 + x) / kSkyWidth - 0.5);
        const double theta = kPi * (kSunRow + 0.5 + y) / kSkyHeight;
        const double cosine = -std::sin(theta) * std::cos(turn);
        return (1.0 - std::abs(x)) * (1.0 - std::abs(y)) * cosine * std::sin(theta);
    });
    return mean * 4.0 * (2.0 * kPi / kSkyWidth) * (kPi / kSkyHeight);
}

RenderTrial sunInSky(double sun) {
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    builder.scene.environment.map = std::make_shared<EnvironmentMap>(skyWithSun(sun));
    builder.scene.environment.radiance = Vec3d(1.0 / (1.0 + (sun - 1.0) * irradianceOfTexel() / kPi));
    parallelCamera(builder, {0.0, 0.0, 1.0}, Vec3d(0.0), 0.5);
    return expecting(1.0, builder.scene, directLight());
}

PlannedSweep besideSweep(Extent extent) {
    const StressSweep about{"beside",
                            "A dim room beside a bright lamp, emission 1 to 1e36: what is seen is the room",
                            "ratio of their radiance",
                            StressAxis::logarithmic,
                            "Radiance is scaled so that what lies halfway between the lights, in logarithms, is near "
                            "1, but the brighter at most 2^30: the dim one is then 1e-27, and normal numbers end at "
                            "1.2e-38. Nearly all light samples go to the lamp and every one must be blocked by the "
                            "walls: a single leak would be seen. The room is found by scattering.",
                            {}};
    return {about, thinned(stepsBy({0, 36, 4}, brightBesideDim), extent)};
}

PlannedSweep aloneSweep(Extent extent) {
    const StressSweep about{
        "alone",
        "Lights of every kind, all times a power of two: the same image to the last bit",
        "factor",
        StressAxis::logarithmic,
        "None: the device scales radiance by a power of two. Single precision on the processor keeps the world's "
        "units and ends where its normal numbers do.",
        {}};
    std::vector<PlannedStep> steps;
    for (int exponent = -100; exponent <= 100; exponent += 20)
        steps.push_back(
            {std::exp2(exponent), fmt::format("2^{}", exponent), trialOf([exponent] { return alone(exponent); })});
    return {about, thinned(std::move(steps), extent)};
}

PlannedSweep sunSweep(Extent extent) {
    const StressSweep about{
        "sun",
        "A texel of an environment map brighter than the others, as bright on the floor",
        "ratio of its radiance to that of the others",
        StressAxis::logarithmic,
        "None: cells are chosen by an integer alias table, and densities come from what it holds. The other texels "
        "are 1/ratio on the device and vanish as normal numbers do, at 1e-38.",
        {}};
    return {about, thinned(stepsBy({0, 18, 3}, sunInSky), extent)};
}

} // namespace

std::vector<PlannedSweep> contrastSweeps(Extent extent) {
    return {besideSweep(extent), aloneSweep(extent), sunSweep(extent)};
}

} // namespace isolux
