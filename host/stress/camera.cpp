// Cameras: fields of view from hardly any to nearly half of everything, images of every shape, places in, near and on
// surfaces, planes that must not clip. What they look at emits, so that nothing but the view can be wrong.
#include "load/gltf.h"
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace isolux {
namespace {

/// A camera at a point of a pose, looking along the pose's -z.
Camera cameraIn(const Mat4d& pose, const Vec3d& position, double yfov) {
    Camera camera;
    camera.position = placed(pose, position);
    camera.worldFromCamera = Mat3d(pose);
    camera.yfov = yfov;
    return camera;
}

/// A lamp of radiance 4 in the plane z = 0 of a pose.
SceneBuilder lampOf(const Mat4d& pose, double halfWidth, double halfHeight) {
    SceneBuilder builder;
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(4.0), Faces::front);
    builder.mesh(squareMesh(lamp), pose * scaling({halfWidth, halfHeight, 1.0}));
    return builder;
}

/// Something black behind it, which makes the scene larger.
void addGround(SceneBuilder& builder, const Mat4d& pose, double halfSize) {
    const std::uint32_t black = builder.material(Vec3d(0.0), Vec3d(0.0), Faces::front);
    builder.mesh(squareMesh(black), pose * translation({0.0, 0.0, -0.1}) * scaling(Vec3d(halfSize)));
}

double radians(double degrees) { return degrees / 180.0 * kPi; }

/// A lamp seen straight on fills half of the image's width and height: its edges run between pixels.
RenderTrial lampFillingView(double degrees) {
    const double halfAngle = 0.5 * radians(degrees);
    SceneBuilder builder = lampOf(askew(), 0.5, 0.5);
    builder.scene.cameras = {cameraIn(askew(), {0.0, 0.0, 1.0 / std::tan(halfAngle)}, 2.0 * halfAngle)};
    return expecting(1.0, builder.scene, scatteringAlone(0));
}

RenderTrial lampAtDistanceOne(double degrees) {
    const double halfAngle = 0.5 * radians(degrees);
    const double lampHalf = 0.5 * std::tan(halfAngle);
    SceneBuilder builder = lampOf(askew(), lampHalf, lampHalf);
    addGround(builder, askew(), 1.0);
    builder.scene.cameras = {cameraIn(askew(), {0.0, 0.0, 1.0}, 2.0 * halfAngle)};
    return expecting(1.0, builder.scene, scatteringAlone(0));
}

struct Shape {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
};

/// The longer side sees a right angle. Along one pixel the lamp's edges are met by chance.
RenderTrial lampInImageOf(const Shape& shape) {
    const double aspect = static_cast<double>(shape.width) / static_cast<double>(shape.height);
    const double halfHeight = 1.0 / std::max(aspect, 1.0);
    SceneBuilder builder = lampOf(askew(), 0.5 * aspect * halfHeight, 0.5 * halfHeight);
    builder.scene.cameras = {cameraIn(askew(), {0.0, 0.0, 1.0}, 2.0 * std::atan(halfHeight))};
    RenderSettings settings = scatteringAlone(0);
    settings.width = shape.width;
    settings.height = shape.height;
    settings.sampleCount = 32768 / (shape.width * shape.height);
    return expecting(1.0, builder.scene, settings);
}

PlannedStep shapeStep(const Shape& shape) {
    return {static_cast<double>(shape.width) / static_cast<double>(shape.height),
            fmt::format("{} x {}", shape.width, shape.height), trialOf([shape] { return lampInImageOf(shape); })};
}

RenderTrial lampInParallel(double halfHeight) {
    SceneBuilder builder = lampOf(Mat4d(1.0), 0.5 * halfHeight, 0.5 * halfHeight);
    const double scene = std::max(1.0, 1.2 * halfHeight);
    addGround(builder, scaling(Vec3d(scene)), 1.0);
    parallelCamera(builder, {0.0, 0.0, scene}, Vec3d(0.0), halfHeight);
    return expecting(1.0, builder.scene, scatteringAlone(0));
}

constexpr std::uint32_t kFurnaceDepth = 20;

/// Radiance in a furnace of albedo 1/2 that emits 1, after so many bounces.
double furnaceRadiance() { return 2.0 - std::exp2(-static_cast<double>(kFurnaceDepth)); }

Scene furnaceRoom(const Mat4d& pose) {
    SceneBuilder builder;
    builder.mesh(roomMesh(builder.material(Vec3d(0.5), Vec3d(1.0), Faces::front)), pose);
    return builder.scene;
}

/// A camera ray that begins beyond the wall meets its dark back, or nothing.
RenderTrial besideWall(double distance) {
    Scene scene = furnaceRoom(askew());
    scene.cameras = {cameraIn(askew() * Mat4d(Mat3d({0, -1, 0}, {0, 0, 1}, {-1, 0, 0})), {0, 0, 0}, 1.0)};
    scene.cameras[0].position = placed(askew(), {0.1, 0.2, distance - 1.0});
    RenderTrial trial = expecting(furnaceRadiance(), scene, scatteringAlone(kFurnaceDepth));
    constexpr double kWallIsKnown = 5e-7; // nearer, rounding may take the wall to the camera's other side
    if (distance > kWallIsKnown) trial.probe = Probe{furnaceRadiance(), furnaceRadiance(), Symptom::leak};
    return trial;
}

/// In a furnace, in places with coordinates of 0 and 1 alone: no rounding takes them off the walls.
RenderTrial insideRoomAt(const Vec3d& position) {
    SceneBuilder builder;
    builder.scene = furnaceRoom(Mat4d(1.0));
    constexpr double kNarrow = 0.8; // enough for all rays from a corner to lead inwards
    builder.camera(position, position == Vec3d(0.0) ? Vec3d(0.0, 0.0, -1.0) : Vec3d(0.0), kNarrow);
    RenderTrial trial = expecting(furnaceRadiance(), builder.scene, scatteringAlone(kFurnaceDepth));
    trial.probe = Probe{furnaceRadiance(), furnaceRadiance(), Symptom::leak};
    return trial;
}

/// In glass a sky of 1 is as bright as the square of the index, in every direction from which it is not totally
/// reflected.
RenderTrial insideGlass() {
    constexpr double kIndex = 1.5;
    SceneBuilder builder;
    Material& glass = builder.scene.materials[0];
    glass.transmission = 1.0;
    glass.roughness = 0.0;
    glass.ior = kIndex;
    glass.thickness = 1.0; // above 0: a solid
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.scene.spheres = {{"", Vec3d(0.0), 1.0, 0}};
    builder.camera({0.3, 0.2, 0.1}, Vec3d(1.0, 0.0, 0.5), 1.0);
    RenderTrial trial = expecting(kIndex * kIndex, builder.scene, scatteringAlone(64));
    trial.probe = Probe{kIndex * kIndex, kIndex * kIndex, Symptom::leak};
    return trial;
}

/// An emitting sphere that fills the image, beyond one plane or before the other.
RenderTrial sphereBeyondPlanes(double distance) {
    const std::string text = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"materials":[{{"emissiveFactor":[1,1,1]}}],)"
        R"("cameras":[{{"type":"perspective","perspective":{{"yfov":0.2,"znear":0.1,"zfar":10}}}}],)"
        R"("nodes":[{{"camera":0}},{{"translation":[0,0,{}],"extras":{{"sphere":{{"radius":{},"material":0}}}}}}],)"
        R"("scenes":[{{"nodes":[0,1]}}]}})",
        -distance, 0.5 * distance);
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    RenderTrial trial = expecting(1.0, loadSceneFromBytes(bytes, "planes.gltf"), scatteringAlone(0));
    trial.probe = Probe{1.0, 1.0, Symptom::leak};
    return trial;
}

std::vector<PlannedSweep> fieldOfViewSweeps(Extent extent) {
    const StressSweep filling{
        .name = "field of view",
        .title = "A lamp that fills half of the view, from as far or near as that takes",
        .axisTitle = "degrees",
        .limit =
            "From afar rays start close before the scene, on a plane that was found in double: directions, rounded to "
            "u = 2^-24, need to be no better than positions. From nearby and wide, the lamp's edges are met at a slope "
            "of 0.5/tan(fov/2): heights rounded to u put them off by 2 u tan(fov/2), 1e-4 at 179.9 degrees."};
    const StressSweep detail{
        .name = "detail",
        .title = "A lamp that fills half of the view in the middle of a scene of size 1, from a distance of 1",
        .axisTitle = "degrees",
        .limit = "A direction's components are rounded to u/2, u = 2^-24, and again as it is normalised: the lamp's "
                 "edges lie off by up to some u/(fov/2), 0.1 % at 0.007 degrees.",
        .promisedFrom = 0.01};
    return {
        {filling, thinned(stepsAt({1e-4, 1e-3, 1e-2, 0.1, 1, 30, 90, 150, 170, 179, 179.9}, lampFillingView), extent)},
        {detail, thinned(stepsAt({60, 10, 1, 0.1, 0.01, 1e-3, 1e-4}, lampAtDistanceOne), extent)}};
}

PlannedSweep shapeSweep(Extent extent) {
    const StressSweep about{.name = "shape",
                            .title = "Images of one pixel, of one row and of one column",
                            .axisTitle = "width/height",
                            .limit = "None: whole pixels are counted as integers, and a place within one is added to "
                                     "them at the middle of the image, where floats are finest."};
    return {about, thinned({shapeStep({1, 16384}), shapeStep({1, 128}), shapeStep({1, 1}), shapeStep({128, 1}),
                            shapeStep({16384, 1})},
                           extent)};
}

PlannedSweep parallelSweep(Extent extent) {
    const StressSweep about{
        .name = "parallel",
        .title = "A parallel view of any size at the middle of a scene of size 1 or larger",
        .axisTitle = "half the height of the view",
        .limit = "None where the view's middle is the scene's, about which floats are finest. Elsewhere edges lie off "
                 "by u/2 of their distance from there, u = 2^-24: 0.1 % of a view of 6e-5."};
    return {about, thinned(stepsBy({-6, 6, 2}, lampInParallel), extent)};
}

std::vector<PlannedSweep> placeSweeps(Extent extent) {
    const StressSweep wall{
        .name = "wall",
        .title = "A camera in a room that stands askew, close to a wall",
        .axisTitle = "distance to the wall over half the room's size",
        .limit = "The camera is the origin, but the wall's corners are rounded to u/2 of their distances from it, u = "
                 "2^-24: its plane lies off by up to 2e-7, and nearer than that the camera may be beyond it.",
        .promisedFrom = 1e-6};
    const StressSweep places{
        .name = "places",
        .title = "A camera in solids and exactly on their surfaces",
        .axisTitle = "1 in glass, 2 in a room, 3 on its wall, 4 its edge, 5 its corner",
        .axis = StressAxis::linear,
        .limit = "None: a surface at a distance of exactly 0 is not met, and these distances are exact."};
    std::vector<PlannedStep> steps{{1, "in a glass sphere", trialOf([] { return insideGlass(); })}};
    const auto addRoom = [&](const char* label, const Vec3d& position) {
        steps.push_back(
            {static_cast<double>(steps.size() + 1), label, trialOf([=] { return insideRoomAt(position); })});
    };
    addRoom("in a room", {0.0, 0.0, 0.0});
    addRoom("on a wall", {0.0, 0.0, 1.0});
    addRoom("on an edge", {1.0, 0.0, 1.0});
    addRoom("in a corner", {1.0, 1.0, 1.0});
    std::vector<PlannedStep> distances = stepsBy({0, -6, -2}, besideWall);
    for (PlannedStep& step : stepsBy({-7, -8, -1}, besideWall)) distances.push_back(std::move(step));
    if (extent == Extent::quick) distances = stepsBy({0, -4, -2}, besideWall);
    return {{wall, std::move(distances)}, {places, thinned(std::move(steps), extent)}};
}

PlannedSweep planesSweep(Extent extent) {
    const StressSweep about{.name = "planes",
                            .title = "A sphere at any distance, the file's near plane at 0.1 and its far one at 10",
                            .axisTitle = "distance",
                            .limit = "None: neither plane clips."};
    return {about, thinned(stepsBy({-6, 6, 2}, sphereBeyondPlanes), extent)};
}

} // namespace

std::vector<PlannedSweep> cameraSweeps(Extent extent) {
    std::vector<PlannedSweep> sweeps = fieldOfViewSweeps(extent);
    sweeps.push_back(shapeSweep(extent));
    sweeps.push_back(parallelSweep(extent));
    for (PlannedSweep& sweep : placeSweeps(extent)) sweeps.push_back(std::move(sweep));
    sweeps.push_back(planesSweep(extent));
    return sweeps;
}

} // namespace isolux
