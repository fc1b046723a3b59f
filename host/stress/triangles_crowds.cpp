// Triangles in crowds: overlapping in one plane, copied, without area, a million at one spot, all about one middle.
#include "stress/triangles_parts.h"

#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace isolux {
namespace {

double unit(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11) * 0x1p-53; }

Vec3d inCube(std::mt19937_64& engine, double halfSide) {
    const double x = unit(engine), y = unit(engine);
    return halfSide * (2.0 * Vec3d(x, y, unit(engine)) - 1.0);
}

/// Overlapping squares in one plane. It may be any, so all their corners are rounded.
RenderTrial patches(int count) {
    std::mt19937_64 engine(1);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * kPi * unit(engine), half = 0.1 + 0.4 * unit(engine);
        const Vec3d center = Vec3d(1.0, 0.0, 1.0) * inCube(engine, 0.7);
        const Vec3d across = half * Vec3d(std::cos(angle), 0.0, std::sin(angle));
        const Vec3d along(-across.z, 0.0, across.x);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3d& corner : {across + along, across - along, -across - along, along - across})
            mesh.positions.emplace_back(center + corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    return convexAndWhite(std::move(mesh), askew());
}

/// The same image as another scene's, to the last bit.
RenderTrial sameAs(const Scene& plain, Scene scene, const RenderSettings& settings) {
    RenderTrial trial;
    trial.scene = std::move(scene);
    trial.settings = settings;
    trial.sameBitsAs = std::make_shared<const Scene>(plain);
    return trial;
}

/// A Cornell box with a mesh more in the air.
Scene boxWith(Mesh mesh) {
    SceneBuilder builder;
    builder.scene = cornellBox();
    mesh.material = builder.material({0.3, 0.4, 0.5}, Vec3d(0.0), Faces::front);
    builder.mesh(std::move(mesh), translation({0.25, 0.25, 0.25}));
    return builder.scene;
}

/// Points, lines there and back, and lines with a corner exactly in their middle: short binary numbers lie on them.
RenderTrial withoutArea(int count) {
    std::mt19937_64 engine(2);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3d a = glm::round(inCube(engine, 200.0)) / 512.0, way = glm::round(inCube(engine, 20.0)) / 512.0;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const Vec3d b = i % 3 == 0 ? a : a + way;
        for (const Vec3d& corner : {a, i % 3 == 2 ? a + 2.0 * way : b, b}) mesh.positions.emplace_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return sameAs(cornellBox(), boxWith(std::move(mesh)), stressSettings(24, 16));
}

/// Walls and blocks so many times, the lamp once.
RenderTrial copies(int count) {
    const Scene plain = cornellBox();
    Scene scene = plain;
    for (int copy = 1; copy < count; ++copy)
        for (const Instance& instance : plain.instances)
            if (!plain.materials[plain.meshes[instance.mesh].material].emits()) scene.instances.push_back(instance);
    return sameAs(plain, std::move(scene), stressSettings(16, 8));
}

Mesh oneTriangle(int count) {
    Mesh mesh = triangleMesh({-0.05f, -0.04f, 0.02f}, {0.05f, -0.03f, -0.03f}, {0.01f, 0.05f, 0.04f});
    mesh.triangles.assign(static_cast<std::size_t>(count), mesh.triangles.front());
    return mesh;
}

/// Few of the image's rays meet them, but those that do have to ask all.
RenderTrial identical(int count) {
    return sameAs(boxWith(oneTriangle(1)), boxWith(oneTriangle(count)), stressSettings(16, 4));
}

/// Every box has the same middle: two corners lie opposite each other, and the third nearer than they on every axis.
RenderTrial concentric(int count) {
    std::mt19937_64 engine(3);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3d corner = inCube(engine, 0.5) * std::exp2(-6.0 * unit(engine));
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3d& position : {corner, -corner, corner * inCube(engine, 1.0)})
            mesh.positions.emplace_back(position);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    RenderTrial trial;
    trial.scene = boxWith(std::move(mesh));
    trial.settings = stressSettings(24, 8);
    return trial;
}

PlannedSweep coplanarSweep(Extent extent) {
    const StressSweep about{
        .name = "coplanar",
        .title = "White squares that overlap in one plane, askew: rays that meet one again are counted",
        .axisTitle = "squares",
        .limit =
            "None while the squares are about as large: one whose corners lie in the plane of the triangle that a ray "
            "leaves, "
            "to within both triangles' rounding, is not met. The plane of a small one, known to u of the scene at its "
            "corners, says less about large ones."};
    return sweepByCount(
        about, extent == Extent::quick ? std::vector{2, 10, 100} : std::vector{2, 10, 30, 100, 300, 1000}, patches);
}

PlannedSweep copySweep(Extent extent) {
    const StressSweep about{.name = "copies",
                            .title =
                                "Walls and blocks of a Cornell box placed many times at the same spot: the same bits",
                            .axisTitle = "copies",
                            .limit = "None: of hits at equal distances the first in the scene counts, and no ray that "
                                     "leaves a triangle meets another "
                                     "with its corners."};
    return sweepByCount(about, extent == Extent::quick ? std::vector{2, 8, 32} : std::vector{2, 4, 8, 16, 32, 64},
                        copies);
}

PlannedSweep withoutAreaSweep(Extent extent) {
    const StressSweep about{
        .name = "no area",
        .title = "Points and lines in a Cornell box: the same bits as without them",
        .axisTitle = "triangles without area",
        .limit =
            "None if a triangle without area is never met. Tested like any other it might be: seen along a ray its "
            "corners are "
            "rounded to u = 2^-24 of their distance and need no longer lie in a line, so that of 3e4 lines 0.05 long "
            "one ray in 2e4 would meet one."};
    return sweepByCount(
        about, extent == Extent::quick ? std::vector{10, 1000, 100'000} : std::vector{10, 100, 1000, 10'000, 100'000},
        withoutArea);
}

PlannedSweep identicalSweep(Extent extent) {
    const StressSweep about{.name = "identical",
                            .title = "One triangle many times in the air of a Cornell box: the same bits as once",
                            .axisTitle = "triangles",
                            .limit = "Time alone: boxes that are all the same cannot be divided by place, so nodes are "
                                     "halved by number, the depth "
                                     "stays at log2 n, and a ray that enters the box asks all n."};
    return sweepByCount(about,
                        extent == Extent::quick ? std::vector{100, 1000, 10'000}
                                                : std::vector{100, 1000, 10'000, 100'000, 1'000'000},
                        identical);
}

PlannedSweep concentricSweep(Extent extent) {
    const StressSweep about{.name = "concentric",
                            .title =
                                "Triangles of sizes from 1 to 1/64 whose boxes have the same middle, in a Cornell box",
                            .axisTitle = "triangles",
                            .limit = "Time again; and of n triangles that cross each other, rounding names another one "
                                     "where rays come within some u = "
                                     "2^-24 of an edge: n u of the rays, which then see it in another light."};
    return sweepByCount(
        about, extent == Extent::quick ? std::vector{10, 100, 1000} : std::vector{10, 100, 1000, 10'000}, concentric);
}

} // namespace

std::vector<PlannedSweep> crowdSweeps(Extent extent) {
    return {coplanarSweep(extent), copySweep(extent), withoutAreaSweep(extent), identicalSweep(extent),
            concentricSweep(extent)};
}

} // namespace isolux
