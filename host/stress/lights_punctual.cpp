// Lights without extent: near, far, in narrow cones, and many of very different powers.
#include "stress/lights_parts.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace isolux {
namespace {

/// A white floor through the origin, which is not the middle of the scene, seen from above about it.
SceneBuilder floorSeen(double halfSize, const Mat4d& pose = Mat4d(1.0)) {
    SceneBuilder builder;
    builder.mesh(squareMesh(0), pose * translation({0.3, -0.2, 0.0}) * scaling({2.0, 2.0, 1.0}));
    parallelCamera(builder, placed(pose, {0.0, 0.0, 1.0}), Vec3d(0.0), halfSize);
    return builder;
}

PunctualLight pointLight(const Vec3d& position, double intensity) {
    PunctualLight light;
    light.position = position;
    light.intensity = Vec3d(intensity);
    return light;
}

/// What a point light of intensity 1 makes of a white floor at the origin.
double reflectedOf(const Vec3d& light) {
    const double squared = glm::dot(light, light);
    return light.z / (kPi * squared * std::sqrt(squared));
}

RenderTrial pointLightNear(double height) {
    const double halfSize = 0.25 * height;
    SceneBuilder builder = floorSeen(halfSize, askew());
    const double expected = meanOverSquare(halfSize, 64, [&](double x, double y) {
        return height * height * reflectedOf({x, y, height});
    });
    builder.scene.punctualLights = {pointLight(placed(askew(), {0.0, 0.0, height}), height * height)};
    return expecting(expected, builder.scene, directLight());
}

/// From no particular direction.
Vec3d obliquely(double distance) { return distance * glm::normalize(Vec3d(2.0, -1.0, 3.0)); }

RenderTrial pointLightFar(double distance) {
    SceneBuilder builder = floorSeen(kPatch);
    const Vec3d position = obliquely(distance);
    builder.scene.punctualLights = {pointLight(position, 1.0 / reflectedOf(position))};
    return expecting(1.0, builder.scene, directLight());
}

/// The patch lies within the inner cone, which is half as wide as the outer one.
RenderTrial narrowSpot(double angle) {
    SceneBuilder builder = floorSeen(std::min(0.125 * angle, kPatch));
    PunctualLight spot = pointLight(obliquely(1.0), 1.0 / reflectedOf(obliquely(1.0)));
    spot.kind = PunctualKind::spot;
    spot.direction = -obliquely(1.0);
    spot.cosInner = std::cos(0.5 * angle);
    spot.cosOuter = std::cos(angle);
    builder.scene.punctualLights = {spot};
    return expecting(1.0, builder.scene, directLight());
}

constexpr int kMany = 10'000;

/// Evenly over the decades, 1 the brightest; in an order that has nothing to do with brightness.
std::vector<double> intensitiesOver(double decades, std::mt19937_64& engine) {
    std::vector<double> intensities;
    intensities.reserve(kMany);
    for (int i = 0; i < kMany; ++i) intensities.push_back(std::pow(10.0, -decades * i / (kMany - 1)));
    for (std::size_t i = intensities.size() - 1; i > 0; --i) std::swap(intensities[i], intensities[engine() % (i + 1)]);
    return intensities;
}

RenderTrial manyLights(double decades) {
    std::mt19937_64 engine(1);
    const auto unit = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    SceneBuilder builder = floorSeen(kPatch);
    double expected = 0.0;
    for (const double intensity : intensitiesOver(decades, engine)) {
        const double x = 2.0 * unit() - 1.0, y = 2.0 * unit() - 1.0;
        const Vec3d position(x, y, 1.0 + unit());
        builder.scene.punctualLights.push_back(pointLight(position, intensity));
        expected += intensity * reflectedOf(position);
    }
    return expecting(expected, builder.scene, directLight());
}

PlannedSweep nearSweep(Extent extent) {
    const StressSweep about{
        "point near",
        "A point light closely over a floor of half side 2",
        "height",
        StressAxis::logarithmic,
        "Rays leave from a point pushed off the floor by a bound on its rounding, 7 u = 4e-7 of the scene's "
        "coordinates, u = 2^-24, and light is taken from there: brighter by 2 * 7 u/height in units of the floor's "
        "half "
        "side. 0.1 % is passed at 1e-3 or so; at 1e-6 the light lies below the point.",
        {},
        2e-3};
    return {about, thinned(stepsBy({0, -6, -1}, pointLightNear), extent)};
}

PlannedSweep farSweep(Extent extent) {
    const StressSweep about{
        "point far",
        "A point light at any distance, as bright",
        "distance",
        StressAxis::logarithmic,
        "None: the light's place is no part of the scene's size, so the floor keeps its digits. Beyond 1e18 scene "
        "sizes the square of the distance leaves single precision and the light is refused.",
        {}};
    return {about, thinned(stepsBy({0, 12, 2}, pointLightFar), extent)};
}

PlannedSweep spotSweep(Extent extent) {
    const StressSweep about{
        "spot",
        "The inner cone of a narrow spot light",
        "angle of the outer cone, rad",
        StressAxis::logarithmic,
        "1 - cos is kept in place of the cosine, and half the squared distance of two unit vectors, each known to some "
        "u = 2^-24, is compared with it: a direction is known to 2 u or so, the cone must be wider. Cosines would end "
        "at sqrt(2 u) = 3.5e-4, as the reference's do in single precision.",
        {}};
    return {about, thinned(stepsBy({0, -6, -1}, narrowSpot), extent)};
}

PlannedSweep manySweep(Extent extent) {
    const StressSweep about{
        "many",
        "10,000 point lights, one chosen at a time",
        "decades between the powers of the dimmest and the brightest",
        StressAxis::linear,
        "Probabilities are whole multiples of 2^-46 (integer alias table of 2^14 bins) and are divided by as they are: "
        "a light that deserves less is chosen more often and weighs less. None is out of reach.",
        {}};
    std::vector<PlannedStep> steps;
    for (const double decades : {0.0, 5.0, 10.0, 15.0, 20.0})
        steps.push_back({decades, fmt::format("{}", decades), trialOf([decades] { return manyLights(decades); })});
    return {about, thinned(std::move(steps), extent)};
}

} // namespace

std::vector<PlannedSweep> punctualSweeps(Extent extent) {
    return {nearSweep(extent), farSweep(extent), spotSweep(extent), manySweep(extent)};
}

} // namespace isolux
