// Scenes and random numbers for the tests of the CPU reference.
#pragma once

#include "reference/intersect.h"
#include "reference/reference.h"
#include "reference/sampling.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace isolux::test {

using RealTypes = ::testing::Types<float, double>;

/// Seeded random numbers.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    Vec3d inCube(double halfSize) {
        const double x = between(-halfSize, halfSize), y = between(-halfSize, halfSize);
        return {x, y, between(-halfSize, halfSize)};
    }
    Vec3d direction() {
        const double u = unit();
        return sampleSphere(u, unit());
    }
    std::size_t index(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

private:
    std::mt19937_64 engine_;
};

template <typename Real> Ray<Real> rayFrom(const Vec3d& origin, const Vec3d& target) {
    const Vec3<Real> start(origin);
    return {start, glm::normalize(Vec3<Real>(target) - start)};
}

inline Mat4d translation(const Vec3d& offset) {
    Mat4d matrix(1.0);
    matrix[3] = glm::dvec4(offset, 1.0);
    return matrix;
}

inline Mat4d scaling(const Vec3d& factors) {
    Mat4d matrix(1.0);
    for (int axis = 0; axis < 3; ++axis) matrix[axis][axis] = factors[axis];
    return matrix;
}

/// Which sides of a surface emit.
enum class Faces { front, both };

/// A scene under construction: each mesh gets its own instance.
struct SceneBuilder {
    Scene scene;

    SceneBuilder() { scene.materials.resize(1); }
    std::uint32_t material(const Vec3d& baseColor, const Vec3d& emission, Faces emitting) {
        scene.materials.push_back({"", baseColor, emission, emitting == Faces::both});
        return static_cast<std::uint32_t>(scene.materials.size() - 1);
    }
    void mesh(Mesh mesh, const Mat4d& worldFromObject = Mat4d(1.0)) {
        scene.instances.push_back({"", static_cast<std::uint32_t>(scene.meshes.size()), worldFromObject});
        scene.meshes.push_back(std::move(mesh));
    }
    void camera(const Vec3d& position, const Vec3d& target, double yfov) {
        const Frame<double> frame = frameAbout(glm::normalize(position - target));
        Camera camera;
        camera.position = position;
        camera.worldFromCamera = Mat3d(frame.t, frame.s, frame.n);
        camera.yfov = yfov;
        scene.cameras.push_back(camera);
    }
};

inline Mesh triangleMesh(const Vec3f& a, const Vec3f& b, const Vec3f& c, std::uint32_t material = 0) {
    return {"", {a, b, c}, {}, {{0, 1, 2}}, material};
}

/// The square [-1, 1]^2 at z = 0, front up.
inline Mesh squareMesh(std::uint32_t material) {
    return {"", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}, material};
}

inline Mesh icosahedron() {
    const float g = (1.0f + std::sqrt(5.0f)) / 2.0f;
    Mesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return mesh;
}

/// Each triangle into four, the new vertices shared by both neighbours.
inline Mesh subdivided(const Mesh& mesh) {
    Mesh finer;
    finer.positions = mesh.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, added] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(finer.positions.size()));
        if (added) finer.positions.push_back((finer.positions[a] + finer.positions[b]) * 0.5f);
        return entry->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const std::array<std::uint32_t, 3>& triangle :
             {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
            finer.triangles.push_back(triangle);
    }
    return finer;
}

inline Mesh icosphere(int levels, float radius) {
    Mesh mesh = icosahedron();
    for (int level = 0; level < levels; ++level) mesh = subdivided(mesh);
    for (Vec3f& position : mesh.positions) position = glm::normalize(position) * radius;
    return mesh;
}

/// Triangles of all sizes, spheres among them.
inline Scene randomSoup(std::uint64_t seed) {
    Random random(seed);
    SceneBuilder builder;
    Mesh mesh;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const Vec3d center = random.inCube(2.0);
        const double size = std::pow(10.0, random.between(-3.0, 0.3));
        for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(Vec3f(center + random.inCube(size)));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    mesh.triangles.push_back(mesh.triangles[7]); // twins: equal distances
    builder.mesh(mesh, translation({10.0, -3.0, 0.1}));
    for (int i = 0; i < 40; ++i)
        builder.scene.spheres.push_back(
            {"", random.inCube(2.0) + Vec3d(10.0, -3.0, 0.1), std::pow(10.0, random.between(-3.0, 0.0)), 0});
    return builder.scene;
}

/// A floor, a lamp above it, a mirrored wedge and two spheres, one of which emits.
inline Scene smallRoom() {
    SceneBuilder builder;
    const std::uint32_t lamp = builder.material({0.1, 0.1, 0.1}, {5.0, 4.0, 3.0}, Faces::front);
    const std::uint32_t glow = builder.material({0.3, 0.3, 0.9}, {0.0, 1.0, 2.0}, Faces::front);
    builder.material({0.8, 0.3, 0.2}, Vec3d(0.0), Faces::front);
    builder.mesh(squareMesh(0), scaling({4.0, 4.0, 1.0}));
    builder.mesh(squareMesh(lamp), translation({0.0, 0.0, 3.0}) * scaling({0.5, 0.5, -1.0}));
    builder.mesh(triangleMesh({-1, 0, 0}, {1, 0, 0}, {0, 0.5, 2}, 3), scaling({-1.0, 1.0, 1.0}));
    builder.scene.spheres = {{"", {1.0, -1.0, 0.6}, 0.5, 3}, {"", {-1.2, -1.0, 1.0}, 0.25, glow}};
    builder.camera({0.5, -6.0, 2.5}, {0.0, 0.0, 0.8}, 0.6);
    return builder.scene;
}

inline RenderSettings smallSettings(std::uint32_t samples) {
    RenderSettings settings;
    settings.width = 24;
    settings.height = 17;
    settings.seed = 0x123456789ABCDEFull;
    settings.sampleCount = samples;
    return settings;
}

/// The film, without progress.
inline Film render(const Scene& scene, const RenderSettings& settings, const ReferenceOptions& options = {}) {
    return renderReference(scene, settings, options, {});
}

/// Midpoints of an n x n grid over the unit square.
template <typename Visit> void forEachGridPoint(int n, Visit visit) {
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) visit((i + 0.5) / n, (j + 0.5) / n);
}

} // namespace isolux::test
