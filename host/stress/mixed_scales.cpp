// Small detail in large scenes: about the camera, on one large triangle, under a tiny lamp, and far from the camera.
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace isolux {
namespace {

constexpr double kLargest = 1e6; // half side of a landscape
constexpr double kFloor = -1.05; // height of the ground in half sizes of the box: just below it
constexpr double kGrowth = 4.0;  // from a ring of the ground to the next
constexpr double kNearest = 4.0; // half side of the first, in half sizes of the detail

/// The corners of a ring, in an order that makes fronts look up. The landscape does not lie about the detail.
void addRing(Mesh& mesh, double halfSide) {
    for (const auto& [x, z] : {std::pair(-0.6, -1.0), {-0.6, 0.7}, {1.0, 0.7}, {1.0, -1.0}})
        mesh.positions.emplace_back(halfSide * x, 0.0, halfSide * z);
}

/// Rings of triangles about the origin: each is as large as it is far away.
Mesh gradedGround(double nearest, double halfSide, std::uint32_t material) {
    Mesh mesh;
    mesh.material = material;
    addRing(mesh, nearest);
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (double reached = nearest; reached < halfSide;) {
        reached = std::min(kGrowth * reached, halfSide);
        const auto outer = static_cast<std::uint32_t>(mesh.positions.size());
        const std::uint32_t inner = outer - 4;
        addRing(mesh, reached);
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t next = (i + 1) % 4;
            mesh.triangles.push_back({outer + i, outer + next, inner + next});
            mesh.triangles.push_back({outer + i, inner + next, inner + i});
        }
    }
    return mesh;
}

/// Two rise through the ground at the landscape's borders.
void addMountains(SceneBuilder& builder, double halfSide, std::uint32_t material) {
    for (const auto& [x, z] : {std::pair(0.8, -0.5), {-0.5, 0.5}})
        builder.mesh(blockMesh(material),
                     translation(Vec3d(x, 0.15, z) * halfSide) * scaling(Vec3d(0.1, 0.2, 0.1) * halfSide));
}

/// A Cornell box of half size `detail` under a dim sky, among mountains; the ground is left to the caller.
SceneBuilder boxInLandscape(double detail, double halfSide) {
    SceneBuilder builder;
    builder.scene = scaled(cornellBox(), detail);
    builder.scene.environment.radiance = {0.3, 0.4, 0.5};
    addMountains(builder, halfSide, builder.material(Vec3d(0.6), Vec3d(0.0), Faces::front));
    return builder;
}

/// Every light is sampled: chosen by power, the sky of a large scene would leave nothing to a small lamp.
RenderTrial underAllLights(const SceneBuilder& builder) {
    RenderTrial trial;
    trial.scene = builder.scene;
    trial.settings = stressSettings(24, 8);
    trial.settings.lightChoice = LightChoice::all;
    return trial;
}

/// Up to the largest landscape the detail stays 1, then it shrinks.
RenderTrial nested(double ratio) {
    const double halfSide = std::min(ratio, kLargest);
    const double detail = halfSide / ratio;
    SceneBuilder builder = boxInLandscape(detail, halfSide);
    const std::uint32_t ground = builder.material({0.5, 0.4, 0.3}, Vec3d(0.0), Faces::front);
    builder.mesh(gradedGround(kNearest * detail, halfSide, ground), translation({0.0, kFloor * detail, 0.0}));
    return underAllLights(builder);
}

/// The scene of meshes, and its camera, in another pose.
SceneBuilder posed(SceneBuilder builder, const Mat4d& pose) {
    for (Instance& instance : builder.scene.instances) instance.worldFromObject = pose * instance.worldFromObject;
    for (Camera& camera : builder.scene.cameras) {
        camera.position = placed(pose, camera.position);
        camera.worldFromCamera = Mat3d(pose) * camera.worldFromCamera;
    }
    return builder;
}

/// Askew, as rounding spares the heights of a ground in a plane of coordinates.
RenderTrial onOnePlain(double ratio) {
    SceneBuilder builder = boxInLandscape(1.0, ratio);
    Mesh plain;
    plain.material = builder.material({0.5, 0.4, 0.3}, Vec3d(0.0), Faces::front);
    addRing(plain, ratio);
    plain.triangles = {{0, 1, 2}, {0, 2, 3}};
    builder.mesh(plain, translation({0.0, kFloor, 0.0}));
    return underAllLights(posed(std::move(builder), askew()));
}

/// A lamp of half a millimetre lights a block on a floor; behind them are ground, mountains and a dim sky.
RenderTrial lampAndMountains(double halfSide) {
    constexpr double kLamp = 5e-4;
    SceneBuilder builder;
    builder.scene.environment.radiance = {0.3, 0.4, 0.5};
    const std::uint32_t grey = builder.material(Vec3d(0.6), Vec3d(0.0), Faces::front);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(2.0 / (kLamp * kLamp)), Faces::both);
    addMountains(builder, halfSide, grey);
    builder.mesh(gradedGround(2.0, halfSide, grey));
    builder.mesh(blockMesh(grey), translation({-0.3, 0.35, 0.0}) * scaling(Vec3d(0.3)));
    Mesh square{"", {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {}, {{0, 1, 2}, {0, 2, 3}}, lamp};
    builder.mesh(square, translation({0.4, 1.9, 0.3}) * scaling(Vec3d(kLamp)));
    builder.camera({-1.2, 0.9, 1.5}, {0.6, 0.45, -0.6}, 0.9);
    return underAllLights(builder);
}

/// The camera stands in the landscape as well: nothing tells it from one that looks about.
RenderTrial farDetail(double sizes) {
    const double distance = 2.0 * sizes;
    const double halfSide = 4.0 * std::max(distance, 2.0);
    SceneBuilder builder = boxInLandscape(1.0, halfSide);
    const std::uint32_t ground = builder.material({0.5, 0.4, 0.3}, Vec3d(0.0), Faces::front);
    builder.mesh(gradedGround(kNearest, halfSide, ground), translation({0.0, kFloor, 0.0}));
    builder.scene.cameras.clear();
    builder.camera(glm::normalize(Vec3d(0.1, 0.07, 1.0)) * distance, Vec3d(0.0), 2.0 * std::atan(1.1 / distance));
    return underAllLights(builder);
}

PlannedSweep nestedSweep(Extent extent) {
    const StressSweep about{
        .name = "near detail",
        .title = "A Cornell box before the camera in a landscape; detail down to 1e-6 in a scene of 1e6",
        .axisTitle = "size of the scene over that of the box",
        .limit =
            "Device space begins at the camera, so that what is near keeps 24 bits of its own distance whatever lies "
            "behind it, and ground whose triangles grow with their distance does too. The end is that of exponents: "
            "a distance is the quotient of cubes of the detail's size, which are no normal numbers below 2^-42 = 2e-13 "
            "of the scene, and lose digits from 1e-12 on."};
    return {about, thinned(stepsBy({2, 12, 2}, nested), extent)};
}

PlannedSweep plainSweep(Extent extent) {
    const StressSweep about{
        .name = "one plain",
        .title = "The same box on a ground of two triangles, askew",
        .axisTitle = "size of the triangles over that of the box",
        .limit =
            "Corners of a triangle of size L are known to u L, u = 2^-24, points between them to 7 u L, and rays leave "
            "from "
            "that far above: 4 % of the box at L = 1e5. The distance to the triangle errs by some u L as well: beyond "
            "1e6 it is met before or behind all that is in the box.",
        .promisedTo = 1e4};
    return {about, extent == Extent::quick ? stepsBy({1, 3}, onOnePlain) : stepsBy({1, 7}, onOnePlain)};
}

PlannedSweep lampSweep(Extent extent) {
    const StressSweep about{
        .name = "lamp and mountains",
        .title = "A lamp of 1 mm, a block of 60 cm and mountains from 10 m to 1000 km away",
        .axisTitle = "distance of the mountains, m",
        .limit =
            "None here: about the camera lamp and block keep 24 bits of their distance, and densities are ratios of "
            "areas and squared distances, 1e-19 and 1e-12 at the end, that single precision holds to 1e-38."};
    return {about, thinned(stepsBy({1, 6}, lampAndMountains), extent)};
}

PlannedSweep farSweep(Extent extent) {
    const StressSweep about{
        .name = "far detail",
        .title = "The same box at a distance from a camera that stands in the landscape too",
        .axisTitle = "distance of the box in its sizes",
        .limit =
            "Device space begins at the camera, so corners, rays and the points where they are met are known to u = "
            "2^-24 of the distance D, and rays leave from 7 u D off the surface: 0.04 % of the box's size at D = 1e3, "
            "0.4 % at 1e4.",
        .promisedTo = 1e3};
    return {about, extent == Extent::quick ? stepsBy({1, 3}, farDetail) : stepsBy({0, 6}, farDetail)};
}

} // namespace

std::vector<PlannedSweep> mixedScaleSweeps(Extent extent) {
    return {nestedSweep(extent), plainSweep(extent), lampSweep(extent), farSweep(extent)};
}

} // namespace isolux
