// Scenes of every size: powers of two change nothing at all, other factors no more than rounding.
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <utility>

namespace isolux {
namespace {

std::uint32_t addGlass(SceneBuilder& builder) {
    Material glass;
    glass.transmission = 1.0;
    glass.roughness = 0.0;
    glass.thickness = 1.0;
    glass.attenuationColor = {0.4, 0.7, 0.9};
    glass.attenuationDistance = 0.5;
    return builder.material(glass);
}

void addPunctualLights(Scene& scene) {
    PunctualLight point;
    point.position = {-0.7, 0.8, 0.9};
    scene.punctualLights.push_back(point);
    PunctualLight spot;
    spot.kind = PunctualKind::spot;
    spot.position = {0.6, 1.1, 1.2};
    spot.direction = glm::normalize(Vec3d(-0.4, -1.2, -0.9));
    spot.intensity = Vec3d(2.0);
    scene.punctualLights.push_back(spot);
}

/// Everything that has a length: meshes, spheres, one of them a lamp and one a solid that absorbs, punctual lights.
Scene sceneOfLengths() {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Vec3d(0.7), Vec3d(0.0), Faces::front);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), {9.0, 8.0, 6.0}, Faces::front);
    const std::uint32_t glass = addGlass(builder);
    builder.mesh(squareMesh(grey), translation({0.0, -1.0, 0.0}) *
                                       glm::rotate(Mat4d(1.0), -0.5 * kPi, Vec3d(1.0, 0.0, 0.0)) * scaling(Vec3d(1.5)));
    builder.mesh(squareMesh(grey), translation({0.0, 0.0, -1.1}) * scaling(Vec3d(1.5)));
    builder.mesh(blockMesh(grey), translation({0.5, -0.7, 0.2}) * glm::rotate(Mat4d(1.0), 0.4, Vec3d(0.0, 1.0, 0.0)) *
                                      scaling(Vec3d(0.3)));
    builder.scene.spheres = {{"", {-0.5, -0.6, 0.1}, 0.4, glass}, {"", {0.2, 0.6, -0.3}, 0.15, lamp}};
    addPunctualLights(builder.scene);
    builder.camera({0.0, 0.1, 4.9}, {0.0, -0.2, 0.0}, 0.5);
    return builder.scene;
}

RenderTrial scaledByPower(const Scene& scene, int exponent) {
    RenderTrial trial;
    trial.scene = scaled(scene, std::exp2(exponent));
    trial.settings = stressSettings(32, 16);
    trial.sameBitsAs = std::make_shared<const Scene>(scene);
    return trial;
}

/// Through a lens, which is no part of the scene and grows with it.
RenderTrial scaledByAny(double factor) {
    RenderTrial trial;
    trial.scene = scaled(cornellBox(), factor);
    trial.settings = stressSettings(32, 16);
    trial.settings.lens = {0.3 * factor, 4.6 * factor};
    return trial;
}

PlannedSweep powersOfTwo(const StressSweep& about, Extent extent, Scene (*make)()) {
    std::vector<PlannedStep> steps;
    for (const int exponent : extent == Extent::quick ? std::vector{-90, 10, 90}
                                                      : std::vector{-90, -60, -30, -20, -10, -1, 1, 10, 20, 30, 60, 90})
        steps.push_back({std::exp2(exponent), fmt::format("2^{}", exponent),
                         trialOf([make, exponent] { return scaledByPower(make(), exponent); })});
    return {about, std::move(steps)};
}

PlannedSweep boxSweep(Extent extent) {
    const StressSweep about{
        .name = "box",
        .title = "A Cornell box times a power of two: the same image to the last bit",
        .axisTitle = "factor",
        .limit =
            "None between the sizes that scenes may have, 1e-30 and 1e30: device space scales the scene, in double, by "
            "the power of two that brings its half extent to (1/2, 1], so a power of two more or less cancels "
            "exactly. Without that areas, the squares of lengths, leave single precision's normal numbers, 2^-126 to "
            "2^128, at lengths below 2^-63 and above 2^64."};
    return powersOfTwo(about, extent, cornellBox);
}

PlannedSweep lengthsSweep(Extent extent) {
    const StressSweep about{
        .name = "all lengths",
        .title = "Sphere lamps, punctual lights and absorbing glass times a power of two: the same bits",
        .axisTitle = "factor",
        .limit =
            "As for the box: radii, distances of absorption and square roots of intensities are lengths too and go by "
            "the same power of two."};
    return powersOfTwo(about, extent, sceneOfLengths);
}

PlannedSweep anyFactorSweep(Extent extent) {
    const StressSweep about{.name = "any factor",
                            .title = "A Cornell box before a thin lens, times a power of ten",
                            .axisTitle = "factor",
                            .limit = "None between 1e-30 and 1e30: corners and lens are scaled in double and rounded "
                                     "once, to 2^-24 of at most 1, "
                                     "when a power of two has brought them to [-1, 1]."};
    return {about, extent == Extent::quick ? stepsBy({-27, 27, 27}, scaledByAny) : stepsBy({-27, 27, 3}, scaledByAny)};
}

} // namespace

std::vector<PlannedSweep> scaleSweeps(Extent extent) {
    return {boxSweep(extent), lengthsSweep(extent), anyFactorSweep(extent)};
}

} // namespace isolux
