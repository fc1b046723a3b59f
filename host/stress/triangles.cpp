// Triangles that tests of rays are afraid of: slivers, plates and coats of no thickness, walls of bricks.
#include "stress/triangles_parts.h"

#include "stress/families.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

constexpr int kStrips = 64;

/// [-1, 1]^2 in x and z, its front up, cut across x: into strips 2/aspect wide in the middle, wider ones to the
/// borders.
Mesh strips(double aspect, std::uint32_t material) {
    const int count = std::min(kStrips, static_cast<int>(aspect));
    std::vector<double> cuts;
    for (int i = 0; i <= count; ++i) cuts.push_back((2.0 * i - count) / aspect);
    while (cuts.back() < 1.0) {
        const double next = std::min(2.0 * cuts.back(), 1.0);
        cuts.push_back(next);
        cuts.insert(cuts.begin(), -next);
    }
    Mesh mesh;
    mesh.material = material;
    for (const double x : cuts)
        for (const double z : {-1.0, 1.0}) mesh.positions.emplace_back(x, 0.0, z);
    for (std::uint32_t a = 0; a + 3 < mesh.positions.size(); a += 2) {
        mesh.triangles.push_back({a, a + 1, a + 3});
        mesh.triangles.push_back({a, a + 3, a + 2});
    }
    return mesh;
}

/// Nothing but the strips fills the image.
RenderTrial sliversIn(const Mat4d& pose, double aspect) {
    constexpr double kDistance = 3.0;
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Vec3d(0.7), Vec3d(0.0), Faces::front);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(5.0), Faces::both);
    builder.mesh(strips(aspect, grey), pose);
    builder.mesh(strips(1.0, lamp), pose * translation({0.4, 1.5, 0.0}) * scaling(Vec3d(0.5)));
    const double halfWindow = 0.4 * std::min(kStrips / aspect, 1.0);
    builder.camera(placed(pose, kDistance * glm::normalize(Vec3d(-0.5, 1.0, 0.8))), placed(pose, Vec3d(0.0)),
                   2.0 * std::atan(halfWindow / kDistance));
    RenderTrial trial;
    trial.scene = builder.scene;
    trial.settings = directLight();
    return trial;
}

RenderTrial plate(double thickness) { return convexAndWhite(blockMesh(0), askew() * scaling({1.0, thickness, 1.0})); }

/// [-1, 1]^2 at z = 0: every second row is shifted by half a brick, so that corners meet the middles of edges.
Mesh brickWall(int rows) {
    Mesh mesh;
    const auto cut = [rows](double column) { return std::clamp(2.0 * column / rows - 1.0, -1.0, 1.0); };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column <= rows; ++column) {
            const double start = column - 0.5 * (row % 2), left = cut(start), right = cut(start + 1.0);
            if (left == right) continue;
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const double y : {cut(row), cut(row + 1)})
                for (const double x : {left, right}) mesh.positions.emplace_back(x, y, 0.0);
            mesh.triangles.push_back({first, first + 1, first + 3});
            mesh.triangles.push_back({first, first + 3, first + 2});
        }
    return mesh;
}

/// A closed room with a lamp in a world that is as bright.
RenderTrial brickRoom(int rows) {
    SceneBuilder builder;
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.scene.materials[0].baseColor = Vec3d(0.6);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(10.0), Faces::both);
    const Vec3d x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0);
    for (const auto& [quarters, axis] : {std::pair(0, x), {1, x}, {2, x}, {3, x}, {1, y}, {3, y}})
        builder.mesh(brickWall(rows),
                     askew() * glm::rotate(Mat4d(1.0), 0.5 * kPi * quarters, axis) * translation({0.0, 0.0, -1.0}));
    builder.mesh(strips(1.0, lamp), askew() * translation({0.0, 0.8, 0.0}) * scaling(Vec3d(0.3)));
    builder.camera(placed(askew(), {0.7, 0.5, 0.9}), placed(askew(), {-0.3, -0.5, -0.6}), 1.2);
    RenderTrial trial;
    trial.scene = builder.scene;
    trial.settings = stressSettings(16, 16);
    return trial;
}

/// A lamp in a coat that lets no light out, over a floor.
RenderTrial coatedLamp(double gap) {
    constexpr double kRadius = 0.5;
    SceneBuilder builder;
    Mesh lamp = icosphere(2, 1.0f);
    lamp.material = builder.material(Vec3d(0.0), Vec3d(1.0), Faces::front);
    builder.mesh(strips(1.0, 0), askew() * translation({0.0, -0.8, 0.0}) * scaling(Vec3d(2.0)));
    builder.mesh(lamp, askew() * scaling(Vec3d(kRadius)));
    builder.mesh(icosphere(2, 1.0f), askew() * scaling(Vec3d(kRadius * (1.0 + gap))));
    builder.camera(placed(askew(), {0.0, 1.0, 3.0}), placed(askew(), {0.0, -0.4, 0.0}), 0.8);
    RenderTrial trial;
    trial.scene = builder.scene;
    trial.settings = directLight();
    trial.probe = Probe{0.0, 1e-6, Symptom::leak}; // any light at all
    return trial;
}

PlannedSweep levelSliverSweep(Extent extent) {
    const StressSweep about{
        .name = "slivers",
        .title = "Strips across the middle of a floor that fill the image",
        .axisTitle = "length over width",
        .limit =
            "None here: about the middle of the scene corners keep 24 bits of their distance from it, and the normal "
            "of a "
            "floor in a plane of coordinates is exact. Edges are tested by the signs of products that are the same in "
            "both neighbours, so that no width lets rays through."};
    return {about, thinned(stepsBy({0, 8}, [](double aspect) { return sliversIn(Mat4d(1.0), aspect); }), extent)};
}

PlannedSweep askewSliverSweep(Extent extent) {
    const TrialAt trialAt = [](double aspect) { return sliversIn(askew(), aspect); };
    const StressSweep about{.name = "slivers askew",
                            .title = "The same on a floor that is turned",
                            .axisTitle = "length over width",
                            .limit = "A corner is rounded by up to u/2 = 2^-25 of the scene in each coordinate, which "
                                     "tilts a sliver of an aspect A "
                                     "by some u A/2: 3 mrad at 1e5, of either sign, so that the mean over slivers "
                                     "holds somewhat longer. At 1/u = "
                                     "1.7e7 the width itself is rounded away.",
                            .promisedTo = 1e4};
    return {about, extent == Extent::quick ? stepsBy({0, 5, 2}, trialAt) : stepsBy({0, 8}, trialAt)};
}

PlannedSweep plateSweep(Extent extent) {
    const StressSweep about{.name = "plates",
                            .title = "A white plate in a white world, askew: rays that meet it again are counted",
                            .axisTitle = "thickness over size",
                            .limit = "None: a ray leaves from outside the bound of its point's rounding, 7 u, u = "
                                     "2^-24, on the side that it came "
                                     "to. Below that it does not matter which face was met."};
    return {about, thinned(stepsBy({0, -8, -1}, plate), extent)};
}

PlannedSweep brickSweep(Extent extent) {
    const StressSweep about{
        .name = "T-junctions",
        .title = "A closed room of bricks whose corners meet the middles of edges, askew",
        .axisTitle = "rows of bricks a wall",
        .limit = "Such walls are not watertight, whatever the test: where an edge passes a corner of three it misses "
                 "its rounding, "
                 "some u/2 = 2^-25 of the room. With n rows gaps are some n u of a wall, 4e-6 of all rays at 64."};
    return sweepByCount(about, extent == Extent::quick ? std::vector{2, 8, 32} : std::vector{2, 4, 8, 16, 32, 64},
                        brickRoom);
}

PlannedSweep shellSweep(Extent extent) {
    const StressSweep about{
        .name = "shells",
        .title = "A lamp in a coat, askew: light that gets out is counted",
        .axisTitle = "gap over the lamp's radius",
        .limit = "A shadow ray ends short of the lamp's point by that point's rounding, up to 7 u of its coordinates, "
                 "u = 2^-24, "
                 "and a coat that is nearer than that lets it pass: below some 1e-6. Nearest hits err by about u.",
        .promisedFrom = 1e-5};
    return {about, extent == Extent::quick ? stepsBy({-1, -5, -2}, coatedLamp) : stepsBy({-1, -7, -1}, coatedLamp)};
}

} // namespace

RenderTrial convexAndWhite(Mesh mesh, const Mat4d& worldFromObject) {
    SceneBuilder builder;
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.mesh(std::move(mesh), worldFromObject);
    builder.camera({1.6, 1.3, 1.9}, Vec3d(0.0), 0.8);
    RenderTrial trial = expecting(1.0, builder.scene, scatteringAlone(1));
    trial.probe = Probe{1.0, 1.0, Symptom::selfHit};
    return trial;
}

PlannedSweep sweepByCount(const StressSweep& about, const std::vector<int>& counts, RenderTrial (*trialOfCount)(int)) {
    std::vector<PlannedStep> steps;
    steps.reserve(counts.size());
    for (const int count : counts)
        steps.push_back({static_cast<double>(count), fmt::format("{}", count),
                         trialOf([trialOfCount, count] { return trialOfCount(count); })});
    return {about, std::move(steps)};
}

std::vector<PlannedSweep> triangleSweeps(Extent extent) {
    std::vector<PlannedSweep> sweeps{levelSliverSweep(extent), askewSliverSweep(extent), plateSweep(extent),
                                     brickSweep(extent), shellSweep(extent)};
    for (PlannedSweep& sweep : crowdSweeps(extent)) sweeps.push_back(std::move(sweep));
    return sweeps;
}

} // namespace isolux
