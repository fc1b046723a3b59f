// Closed meshes that no ray gets out of: rays aimed at edges and corners, and white rooms in a white world.
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include "core/philox.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

/// Where Embree's own test puts its spheres, of radius 2.
const Vec3d kEmbree(148376.0, 1234.0, -223423.0);
constexpr double kRadius = 2.0;

/// A closed mesh, and the cube inside it that rays start in.
struct Vessel {
    Mesh mesh;
    Mat4d worldFromObject{1.0};
    double halfSide = 0.0;
};

using Corners = std::array<Vec3d, 3>;

std::vector<Corners> cornersOf(const Vessel& vessel) {
    std::vector<Corners> all;
    all.reserve(vessel.mesh.triangles.size());
    for (const auto& [a, b, c] : vessel.mesh.triangles) {
        Corners corners;
        std::size_t i = 0;
        for (const std::uint32_t vertex : {a, b, c})
            corners[i++] = transformPoint(vessel.worldFromObject, vessel.mesh.positions[vertex]);
        all.push_back(corners);
    }
    return all;
}

/// In (-1, 1), one of 1024 numbers: differences from corners that are short binary numbers, too, stay exact.
double coarse(std::uint32_t word) { return (static_cast<double>(word >> 22) - 511.5) / 512.0; }

/// At corners and along edges in turn. A function of its number alone, as rays are asked for in pieces.
AimedRay aimedAt(const std::vector<Corners>& triangles, const Vessel& vessel, std::uint64_t number) {
    const auto low = static_cast<std::uint32_t>(number), high = static_cast<std::uint32_t>(number >> 32);
    const PhiloxBlock a = philox4x32({low, high, 0, 0}, {42, 0}), b = philox4x32({low, high, 1, 0}, {42, 0});
    const Corners& corners = triangles[a[3] % triangles.size()];
    const std::size_t corner = b[0] % 3;
    const double along = number % 2 == 0 ? 0.0 : unitReal<double>(b[1]);
    const Vec3d local = vessel.halfSide * Vec3d(coarse(a[0]), coarse(a[1]), coarse(a[2]));
    const Vec3d origin = placed(vessel.worldFromObject, local);
    return {origin, corners[corner] + along * (corners[(corner + 1) % 3] - corners[corner]) - origin};
}

RayTrial raysIn(const Vessel& vessel, std::uint64_t count) {
    RayTrial trial;
    SceneBuilder builder;
    builder.mesh(vessel.mesh, vessel.worldFromObject);
    trial.scene = builder.scene;
    trial.count = count;
    trial.make = [vessel, triangles = cornersOf(vessel)](std::uint64_t first, std::size_t number) {
        std::vector<AimedRay> rays;
        rays.reserve(number);
        for (std::uint64_t i = first; i < first + number; ++i) rays.push_back(aimedAt(triangles, vessel, i));
        return rays;
    };
    return trial;
}

std::uint64_t raysOf(Extent extent) { return extent == Extent::quick ? 100'000 : 1'000'000; }

Vessel sphereAt(double radii) {
    const Vec3d offset = kEmbree * (kRadius * radii / glm::length(kEmbree));
    return {icosphere(3, 2.0f), translation(offset), 0.4 * kRadius};
}

Vessel sphereOf(int levels) { return {icosphere(levels, 1.0f), askew(), 0.4}; }

/// A cube cut across x, at 0 and at powers of two on both sides of it: slivers up to the aspect, without end.
Mesh slicedRoom(double aspect) {
    std::vector<double> cuts{0.0};
    for (double x = 1.0; 2.0 * x >= 2.0 / aspect; x *= 0.5) {
        cuts.push_back(x);
        cuts.push_back(-x);
    }
    std::ranges::sort(cuts);
    Mesh mesh;
    for (const double x : cuts)
        for (const auto& [y, z] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) mesh.positions.emplace_back(x, y, z);
    const auto last = static_cast<std::uint32_t>(mesh.positions.size()) - 4;
    for (std::uint32_t ring = 0; ring < last; ring += 4)
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t a = ring + i, b = ring + (i + 1) % 4;
            mesh.triangles.push_back({a, b, b + 4});
            mesh.triangles.push_back({a, b + 4, a + 4});
        }
    mesh.triangles.insert(mesh.triangles.end(),
                          {{0, 2, 1}, {0, 3, 2}, {last, last + 1, last + 2}, {last, last + 2, last + 3}});
    return mesh;
}

/// What scatters without end in a closed white room finds nothing; every ray that gets out brings 1.
RenderTrial whiteRoom(Mesh mesh, const Mat4d& worldFromObject, const Vec3d& eye, const Vec3d& target) {
    SceneBuilder builder;
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.mesh(std::move(mesh), worldFromObject);
    builder.camera(placed(worldFromObject, eye), placed(worldFromObject, target), 1.5);
    RenderTrial trial;
    trial.scene = builder.scene;
    trial.settings = scatteringAlone(8);
    trial.probe = Probe{0.0, 1.0, Symptom::leak};
    return trial;
}

RenderTrial roomAt(double sizes) {
    const Mat4d pose = translation(glm::normalize(kEmbree) * (2.0 * sizes)) * askew();
    return whiteRoom(roomMesh(0), pose, {0.3, -0.2, 0.6}, {-0.4, 0.1, -0.5});
}

RenderTrial slot(double height) {
    return whiteRoom(roomMesh(0), askew() * scaling({1.0, height, 1.0}), {0.3, 0.0, 0.2}, {-0.4, 0.1, -0.5});
}

/// Two walls that meet at an angle, a third one across and two ends.
RenderTrial wedge(double angle) {
    const auto rise = static_cast<float>(2.0 * std::tan(0.5 * angle));
    Mesh mesh;
    for (const float z : {-1.0f, 1.0f})
        for (const Vec3f& corner : {Vec3f(-1, 0, z), Vec3f(1, -rise, z), Vec3f(1, rise, z)})
            mesh.positions.push_back(corner);
    mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {0, 3, 5}, {0, 5, 2}, {1, 2, 5}, {1, 5, 4}};
    return whiteRoom(std::move(mesh), askew(), {0.8, 0.0, 0.1}, {-1.0, 0.0, 0.0});
}

PlannedSweep sphereSweep(Extent extent) {
    const double embree = glm::length(kEmbree) / kRadius;
    const std::vector<double> all{1.0, 1e2, 1e4, embree, 1e6, 1e8}, few{1.0, embree, 1e8};
    std::vector<PlannedStep> steps;
    for (const double radii : extent == Extent::quick ? few : all)
        steps.push_back({radii, fmt::format("{:g}", radii),
                         trialOf([radii, extent] { return raysIn(sphereAt(radii), raysOf(extent)); })});
    const StressSweep about{
        .name = "sphere",
        .title = "Rays from inside a sphere of 1280 triangles and radius 2 at its edges and corners; 1.341e5 radii "
                 "away it is "
                 "Embree's at (148376, 1234, -223423), whose test lets 2e-5 of them fail",
        .axisTitle = "distance from the origin in radii",
        .limit =
            "None: a corner that triangles share gives all of them the same rounded numbers, and the difference of two "
            "rounded products is exactly negated for the neighbour across an edge. A closed mesh stays closed, also "
            "after its corners are rounded; in single precision without a move none is left beyond 2^24 radii."};
    return {about, std::move(steps)};
}

PlannedSweep finenessSweep(Extent extent) {
    std::vector<PlannedStep> steps;
    for (const int levels : {0, 1, 2, 3, 4, 5, 6}) {
        const double triangles = 20.0 * std::exp2(2 * levels);
        steps.push_back({triangles, fmt::format("{:g}", triangles),
                         trialOf([levels, extent] { return raysIn(sphereOf(levels), raysOf(extent)); })});
    }
    const StressSweep about{
        .name = "fineness",
        .title = "Rays from inside spheres of ever more triangles at edges and corners",
        .axisTitle = "triangles",
        .limit = "None, as for the sphere. Boxes are rounded outwards when they are quantised, and met by "
                 "every ray that meets what is inside: by 16 u of the scene, u = 2^-24, on every side."};
    return {about, thinned(std::move(steps), extent)};
}

PlannedSweep sliceSweep(Extent extent) {
    std::vector<PlannedStep> steps;
    for (const double aspect : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8}) {
        const auto make = [aspect, extent] { return raysIn({slicedRoom(aspect), askew(), 0.9}, raysOf(extent)); };
        steps.push_back({aspect, fmt::format("{:g}", aspect), trialOf(make)});
    }
    const StressSweep about{
        .name = "slices",
        .title = "Rays from inside a cube in slices, askew, at the edges and corners of slivers",
        .axisTitle = "length over width of the narrowest",
        .limit =
            "Up to an aspect of 1/u = 2^24: beyond, the corners of slivers round to the same points or change sides. "
            "They do so for all triangles that share them, and still 4 of 1e6 rays aimed at corners get through.",
        .promisedTo = 1e7};
    return {about, thinned(std::move(steps), extent)};
}

/// The largest takes minutes, and the double reference much longer.
PlannedSweep manySweep(Extent extent) {
    std::vector<PlannedStep> steps;
    for (const std::uint64_t count : {100'000ull, 1'000'000ull, 10'000'000ull, 100'000'000ull}) {
        if (extent == Extent::quick && count > 100'000) break;
        const auto make = [count] {
            RayTrial trial = raysIn(sphereOf(3), count);
            if (count > 10'000'000) trial.renderers = Renderers::deviceAlone;
            return trial;
        };
        steps.push_back({static_cast<double>(count), fmt::format("{:g}", static_cast<double>(count)), trialOf(make)});
    }
    const StressSweep about{.name = "many",
                            .title = "Ever more rays from inside a sphere of 1280 triangles at edges and corners",
                            .axisTitle = "rays",
                            .limit = "None: what holds by construction holds for any number."};
    return {about, std::move(steps)};
}

PlannedSweep roomSweep(Extent extent) {
    const StressSweep about{
        .name = "room",
        .title = "A closed white room in a white world: light that gets in is counted",
        .axisTitle = "distance from the origin in sizes of the room",
        .limit =
            "None on the device. Rays leave from points pushed off walls by the bound of their rounding, and a point "
            "that is "
            "nearer to an edge than that is pushed along the other wall, if the angle is right. Without the move the "
            "bound grows with the distance."};
    return {about, thinned(stepsBy({0, 8}, roomAt), extent)};
}

PlannedSweep slotSweep(Extent extent) {
    const StressSweep about{.name = "slot",
                            .title = "The same, flat and askew",
                            .axisTitle = "height over width",
                            .limit = "Rays leave from a point pushed off a wall by up to 7 u of the sum of its "
                                     "coordinates, u = 2^-24, about the "
                                     "camera: 7e-7 of the width. A wall that is nearer than that is behind them.",
                            .promisedFrom = 1e-5};
    return {about, extent == Extent::quick ? stepsBy({0, -4, -2}, slot) : stepsBy({0, -7, -1}, slot)};
}

PlannedSweep wedgeSweep(Extent extent) {
    const StressSweep about{.name = "wedge",
                            .title = "The same with a sharp edge, askew",
                            .axisTitle = "angle at the edge, rad",
                            .limit = "Points are kept twice their error from edges, u = 2^-24 of the coordinates and "
                                     "some, or they would lie beyond the "
                                     "other wall. At a sharper edge than some 1e-4 rad the push off one wall leads "
                                     "through the other even there.",
                            .promisedFrom = 1e-4};
    return {about, stepsBy({0, extent == Extent::quick ? -2 : -4, -1}, wedge)};
}

} // namespace

std::vector<PlannedSweep> watertightSweeps(Extent extent) {
    return {sphereSweep(extent), finenessSweep(extent), sliceSweep(extent), manySweep(extent),
            roomSweep(extent),   slotSweep(extent),     wedgeSweep(extent)};
}

} // namespace isolux
