// Surfaces seen and lit at grazing angles, and shading normals that lie almost in their surface. Floors that lie in a
// plane of coordinates, where rounding spares small heights, stand beside the same floors turned askew.
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <cmath>
#include <utility>

namespace isolux {
namespace {

constexpr Decades kAngles{-1, -7, -1};

const Mat4d kLevel(1.0);

/// Where an angle above the floor points to.
Vec3d atElevation(double angle) { return {std::cos(angle), 0.0, std::sin(angle)}; }

Material grey(double albedo) {
    Material material;
    material.baseColor = Vec3d(albedo);
    return material;
}

Material roughMetal() {
    Material material;
    material.metallic = 1.0;
    material.roughness = std::sqrt(0.1);
    return material;
}

/// Two fifths of a floor in a world of radiance 1.
Scene floorSeenAt(double angle, const Mat4d& pose, const Material& material) {
    SceneBuilder builder;
    builder.scene.materials[0] = material;
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.mesh(squareMesh(0), pose);
    parallelCamera(builder, placed(pose, 0.5 * atElevation(angle)), placed(pose, Vec3d(0.0)), 0.2 * std::sin(angle));
    return builder.scene;
}

/// A ray that misses the grey floor brings 1, one that meets it twice 0.
RenderTrial levelView(double angle) {
    RenderTrial trial = expecting(0.5, floorSeenAt(angle, kLevel, grey(0.5)), scatteringAlone(1));
    trial.probe = Probe{0.5, 0.5, Symptom::selfHit};
    return trial;
}

RenderTrial askewView(double angle) {
    RenderTrial trial = expecting(1.0, floorSeenAt(angle, askew(), grey(1.0)), scatteringAlone(1));
    trial.probe = Probe{1.0, 1.0, Symptom::selfHit};
    return trial;
}

RenderTrial metalView(double angle) {
    RenderTrial trial = expecting(1.0, floorSeenAt(angle, kLevel, roughMetal()), scatteringAlone(1));
    trial.expectedUncertainty = 5e-3; // of the compensation
    return trial;
}

/// A white floor under the sun, whose strength makes up for its angle.
RenderTrial floorLitAt(double angle, const Mat4d& pose) {
    SceneBuilder builder;
    builder.mesh(squareMesh(0), pose);
    PunctualLight sun;
    sun.kind = PunctualKind::directional;
    sun.direction = glm::normalize(placed(pose, -atElevation(angle)));
    sun.intensity = Vec3d(kPi / std::sin(angle));
    builder.scene.punctualLights.push_back(sun);
    parallelCamera(builder, placed(pose, {0.0, 0.0, 1.0}), placed(pose, Vec3d(0.0)), 0.5);
    return expecting(1.0, builder.scene, directLight());
}

RenderTrial levelLight(double angle) {
    RenderTrial trial = floorLitAt(angle, kLevel);
    trial.probe = Probe{1.0, 1.0, Symptom::selfHit};
    return trial;
}

constexpr double kLampHalfSide = 0.25;
constexpr double kLampHeight = 1.25;

/// What a square lamp of radiance 1, upright at x = 0, sends to a white floor: reflected radiance at (x, y).
double reflectedOfUprightLamp(double x, double y) {
    const double mean = meanOverSquare(kLampHalfSide, 64, [&](double across, double up) {
        const double z = kLampHeight + up;
        const double squared = x * x + (across - y) * (across - y) + z * z;
        return z * x / (squared * squared);
    });
    return mean * 4.0 * kLampHalfSide * kLampHalfSide / kPi;
}

/// The floor at a distance from the lamp's plane: it sees the lamp at that angle, about.
RenderTrial lampOnEdge(double distance) {
    SceneBuilder builder;
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(1.0 / distance), Faces::front);
    Mat4d upright(0.0); // x, y, z to y, z, x
    upright[0][1] = upright[1][2] = kLampHalfSide;
    upright[2][0] = upright[3][3] = 1.0;
    builder.mesh(squareMesh(0));
    builder.mesh(squareMesh(lamp), translation({0.0, 0.0, kLampHeight}) * upright);
    const double halfHeight = 0.5 * distance;
    parallelCamera(builder, {distance, 0.0, 0.5}, {distance, 0.0, 0.0}, halfHeight);
    const double expected = meanOverSquare(
        halfHeight, 4, [&](double x, double y) { return reflectedOfUprightLamp(distance + x, y) / distance; });
    return expecting(expected, builder.scene, directLight());
}

/// A floor whose shading normal lies that angle above it: what is scattered below it is lost.
RenderTrial bentNormal(double angle) {
    SceneBuilder builder;
    Mesh floor = squareMesh(0);
    floor.normals.assign(floor.positions.size(), Vec3f(atElevation(angle)));
    builder.mesh(floor, askew());
    builder.scene.environment.radiance = Vec3d(1.0);
    parallelCamera(builder, placed(askew(), {0.0, 0.0, 1.0}), Vec3d(0.0), 0.5);
    return expecting(0.5 * (1.0 + std::sin(angle)), builder.scene, scatteringAlone(1));
}

PlannedSweep sweepByAngle(StressSweep about, Extent extent, const TrialAt& trialAt) {
    return {std::move(about), thinned(stepsBy(kAngles, trialAt), extent)};
}

std::vector<PlannedSweep> viewSweeps(Extent extent) {
    constexpr const char* kAxis = "angle between view and floor, rad";
    const StressSweep level{
        "view",
        "A floor seen at a grazing angle",
        kAxis,
        StressAxis::logarithmic,
        "None here: near the plane z = 0 heights keep 24 bits however small they are, and rays meet the floor by "
        "differences of such heights. Every ray that misses it, or meets it twice, is counted.",
        {}};
    const StressSweep turned{
        "view askew",
        "The same of a floor that is turned",
        kAxis,
        StressAxis::logarithmic,
        "Corners are rounded by up to u = 2^-24 of their size, so the floor that is traced leans by about u: below "
        "1e-7 rad a ray may see its back or pass it by. White under white light, the image does not tell; a ray that "
        "meets the floor it leaves is counted.",
        {}};
    const StressSweep metal{
        "rough metal",
        "White metal of alpha 0.1 in a white furnace, seen at a grazing angle",
        kAxis,
        StressAxis::logarithmic,
        "None: visible normals (Dupuy and Benyoub 2023) divide by nothing that vanishes with the cosine, and where it "
        "is small the albedo depends on the cosine over alpha, which the table holds. Compensation is measured down "
        "to a cosine of 0.001 (0.15 %).",
        {}};
    return {sweepByAngle(level, extent, levelView), sweepByAngle(turned, extent, askewView),
            sweepByAngle(metal, extent, metalView)};
}

std::vector<PlannedSweep> lightingSweeps(Extent extent) {
    constexpr const char* kAxis = "angle between light and floor, rad";
    const StressSweep level{"light",
                            "A floor lit at a grazing angle, as bright",
                            kAxis,
                            StressAxis::logarithmic,
                            "None here: the sine is a component of the sun's direction and keeps 24 bits. A shadow ray "
                            "that meets the floor it leaves is counted.",
                            {}};
    const StressSweep turned{
        "light askew",
        "The same on a floor that is turned",
        kAxis,
        StressAxis::logarithmic,
        "The sine is the sum of three products that cancel. Direction, normal and sum are rounded by some u = 2^-24 "
        "each, 5 u at worst, so light is wrong by up to 5 u/angle: 0.1 % at 3e-4 at worst, typically at 1e-4.",
        {},
        3e-4};
    const StressSweep edge{
        "edge lamp",
        "A lamp seen on edge, as bright",
        kAxis,
        StressAxis::logarithmic,
        "Barycentric coordinates are rounded, so a point of a floor of size 1 is known to some u = 2^-24 (7 u at "
        "worst), and so is its distance from the lamp's plane: u/angle a sample, of either sign. The mean holds until "
        "points come to lie behind the lamp.",
        {},
        3e-4};
    return {sweepByAngle(level, extent, levelLight),
            sweepByAngle(turned, extent, [](double angle) { return floorLitAt(angle, askew()); }),
            sweepByAngle(edge, extent, lampOnEdge)};
}

PlannedSweep bentNormalSweep(Extent extent) {
    const StressSweep about{
        "bent normal",
        "A shading normal almost in its surface",
        "angle between shading normal and surface, rad",
        StressAxis::logarithmic,
        "Directions within some u = 2^-24 of the surface may count on either side: a share u of all, whatever the "
        "angle. Below u rounding decides to which side the shading normal is turned; paths then differ, their mean "
        "does not.",
        {}};
    return sweepByAngle(about, extent, bentNormal);
}

} // namespace

std::vector<PlannedSweep> grazingSweeps(Extent extent) {
    std::vector<PlannedSweep> sweeps = viewSweeps(extent);
    for (PlannedSweep& sweep : lightingSweeps(extent)) sweeps.push_back(std::move(sweep));
    sweeps.push_back(bentNormalSweep(extent));
    return sweeps;
}

} // namespace isolux
