// Spheres that emit: of any size, near to what they light, and from inside. They emit to both sides, so that rounding
// which takes a point for one beyond the surface leaves as much light as there is.
#include "stress/lights_parts.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <cmath>

namespace isolux {
namespace {

void addSphere(SceneBuilder& builder, double height, double radius, double radiance) {
    const std::uint32_t light = builder.material(Vec3d(0.0), Vec3d(radiance), Faces::both);
    builder.scene.spheres.push_back({"", {0.0, 0.0, height}, radius, light});
}

/// At height 1, its size is radius/distance. The floor below is seen from between; a camera that comes to lie in the
/// sphere sees the same radiance.
RenderTrial sphereOfRadius(double radius) {
    SceneBuilder builder;
    builder.mesh(squareMesh(0), translation({0.3, -0.2, 0.0}) * scaling({2.0, 2.0, 1.0}));
    addSphere(builder, 1.0, radius, radius < 1.0 ? 1.0 / (radius * radius) : 1.0);
    const double between = radius == 1.0 ? kPatch : 0.5 * std::abs(1.0 - radius);
    parallelCamera(builder, {0.0, 0.0, between}, Vec3d(0.0), kPatch);
    return expecting(1.0, builder.scene, directLight());
}

/// A sphere of radius 1 at that height over the floor. What lies below the floor as far as the sphere reaches above it
/// makes 0 its height on the device as well, or the camera could not be told from the floor.
RenderTrial sphereAbove(double gap) {
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    builder.mesh(squareMesh(0), translation({0.0, 0.0, -2.0 - gap}));
    addSphere(builder, 1.0 + gap, 1.0, (1.0 + gap) * (1.0 + gap));
    parallelCamera(builder, {0.0, 0.0, 0.5 * gap}, Vec3d(0.0), kPatch);
    return expecting(1.0, builder.scene, directLight());
}

/// A white square in a sphere of radius and radiance 1 looks at its surface from that deep below it. Whatever is seen
/// is 1.
RenderTrial insideSphere(double depth) {
    SceneBuilder builder;
    const double halfSide = 0.5 * std::sqrt(depth);
    builder.mesh(squareMesh(0), translation({0.0, 0.0, 1.0 - depth}) * scaling({halfSide, halfSide, 1.0}));
    addSphere(builder, 0.0, 1.0, 1.0);
    parallelCamera(builder, {0.0, 0.0, 1.0 - 0.5 * depth}, {0.0, 0.0, 1.0 - depth}, 0.5 * halfSide);
    return expecting(1.0, builder.scene, directLight());
}

std::vector<PlannedStep> stepsByRadius() {
    std::vector<PlannedStep> steps = stepsBy({-6, -1}, sphereOfRadius);
    for (const double radius : {0.5, 0.9, 0.99, 0.999, 1.0, 1.001, 1.01, 1.1})
        steps.push_back({radius, fmt::format("{}", radius), trialOf([radius] { return sphereOfRadius(radius); })});
    return steps;
}

PlannedSweep radiusSweep(Extent extent) {
    const StressSweep about{
        "sphere",
        "A sphere of any radius at distance 1, as bright; beyond 1 the floor runs through it",
        "radius/distance",
        StressAxis::logarithmic,
        "None: 1 - cos of the cone is taken from its sine squared, without cancellation however thin it is. Where the "
        "sphere touches the floor the cosine is the root of a difference that is known to 3 u = 2e-7, u = 2^-24, and "
        "the density to the root of that, 4e-4; within it points of the whole sphere take over.",
        {}};
    return {about, thinned(stepsByRadius(), extent)};
}

PlannedSweep gapSweep(Extent extent) {
    const StressSweep about{
        "sphere near",
        "A sphere closely over the floor",
        "gap/radius",
        StressAxis::logarithmic,
        "The density of directions errs by 3 u/(2 sqrt(2 gap)), u = 2^-24, or by sqrt(3 u) = 4e-4 at the most. Below "
        "u rounding puts the floor into the sphere: one that emits inwards too is as bright there.",
        {}};
    return {about, thinned(stepsBy({0, -7, -1}, sphereAbove), extent)};
}

PlannedSweep insideSweep(Extent extent) {
    const StressSweep about{
        "sphere inside",
        "A white square in a sphere that emits, close to its surface",
        "depth/radius",
        StressAxis::logarithmic,
        "The point of the sphere is known to some u = 2^-24 of its radius, so the density of one close by errs by "
        "u/depth; but there light sampling has hardly any weight beside scattering. Below 1e-6 nothing fits between.",
        {}};
    return {about, thinned(stepsBy({0, -6, -1}, insideSphere), extent)};
}

} // namespace

std::vector<PlannedSweep> sphereLightSweeps(Extent extent) {
    return {radiusSweep(extent), gapSweep(extent), insideSweep(extent)};
}

} // namespace isolux
