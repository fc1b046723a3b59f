// Square lamps over a floor: of any area, and at any distance.
#include "stress/lights_parts.h"
#include "stress/sweep_parts.h"

#include <cmath>

namespace isolux {
namespace {

/// A lamp that looks down.
void addLamp(SceneBuilder& builder, const Vec3d& center, double halfSide, double radiance) {
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(radiance), Faces::front);
    builder.mesh(squareMesh(lamp), translation(center) * scaling({halfSide, halfSide, -1.0}));
}

/// The part of a full hemisphere's irradiance that a parallel square at height 1 sends to the point below its centre.
double formFactorOfSquare(double halfSide) {
    const double a = halfSide / std::sqrt(1.0 + halfSide * halfSide);
    return 4.0 / kPi * a * std::atan(a);
}

/// Over the patch that is seen.
RenderTrial lampOfArea(double area, const Vec2d& place) {
    const double halfSide = 0.5 * std::sqrt(area);
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    addLamp(builder, {place, 1.0}, halfSide, 1.0 / formFactorOfSquare(halfSide));
    parallelCamera(builder, {place, 0.5}, {place, 0.0}, kPatch);
    return expecting(1.0, builder.scene, directLight());
}

/// A square lamp of area 1 that looks down, seen from the origin in a floor: the part of irradiance, as above.
double formFactorFrom(const Vec3d& center) {
    return meanOverSquare(0.5, 64, [&](double x, double y) {
        const Vec3d way = center + Vec3d(x, y, 0.0);
        const double squared = glm::dot(way, way);
        return way.z * way.z / (kPi * squared * squared);
    });
}

RenderTrial lampAt(const Vec3d& center) {
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    addLamp(builder, center, 0.5, 1.0 / formFactorFrom(center));
    parallelCamera(builder, {0.0, 0.0, 0.4 * center.z}, Vec3d(0.0), kPatch);
    return expecting(1.0, builder.scene, directLight());
}

PlannedSweep areaSweep(Extent extent) {
    const StressSweep about{
        "area",
        "A lamp of any area at height 1, as bright on the floor",
        "area of the lamp",
        StressAxis::logarithmic,
        "None here: in the middle of the scene corners keep 24 bits. A large lamp is found by scattering, beside which "
        "light sampling has a weight of 1/area^2; a small one by light sampling.",
        {}};
    const auto trialAt = [](double area) { return lampOfArea(area, Vec2d(0.0)); };
    return {about, thinned(stepsBy({-12, 12, 2}, trialAt), extent)};
}

PlannedSweep asideSweep(Extent extent) {
    const StressSweep about{
        "area aside",
        "A small lamp that is not in the middle of its scene",
        "area of the lamp",
        StressAxis::logarithmic,
        "Corners at 0.7 are rounded by up to u/2, u = 2^-24, a side s by up to u, and the area by 2 u/s: 0.1 % where "
        "s = 1.2e-4, an area of 1.4e-8.",
        {},
        1.4e-8};
    const auto trialAt = [](double area) { return lampOfArea(area, {0.7, -0.3}); };
    return {about, thinned(stepsBy({0, -12, -2}, trialAt), extent)};
}

PlannedSweep distanceSweep(Extent extent) {
    const StressSweep about{"distance",
                            "A lamp of area 1 far above the floor, as bright",
                            "distance, in sizes of the lamp",
                            StressAxis::logarithmic,
                            "None here: floor and lamp lie on an axis of the scene and keep 24 bits across it. Rays "
                            "leave the floor from up "
                            "to 14 u = 8e-7 of the distance above it, which changes the light by 2e-6.",
                            {}};
    const auto trialAt = [](double distance) { return lampAt({0.0, 0.0, distance}); };
    return {about, thinned(stepsBy({0, 8}, trialAt), extent)};
}

PlannedSweep obliqueDistanceSweep(Extent extent) {
    const StressSweep about{
        "distance oblique",
        "The same lamp in no particular direction",
        "distance, in sizes of the lamp",
        StressAxis::logarithmic,
        "Floor and lamp cannot both lie where floats are finest: at the ends of a scene of size d their corners are "
        "rounded by up to u d/4, u = 2^-24, the slope of a floor of size 2 and the side of a lamp of size 1 as much: "
        "0.1 % "
        "where d = 7e4 if roundings are at their worst. From 1/u = 2e7 on their corners are one point.",
        {},
        0.0,
        7e4};
    const Vec3d direction = glm::normalize(Vec3d(2.0, -1.0, 3.0));
    const auto trialAt = [direction](double distance) { return lampAt(distance * direction); };
    return {about, thinned(stepsBy({0, 8}, trialAt), extent)};
}

} // namespace

std::vector<PlannedSweep> lampSweeps(Extent extent) {
    return {areaSweep(extent), asideSweep(extent), distanceSweep(extent), obliqueDistanceSweep(extent)};
}

} // namespace isolux
