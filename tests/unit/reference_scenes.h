// Scenes and random numbers for the tests of the CPU reference.
#pragma once

#include "reference/intersect.h"
#include "reference/reference.h"
#include "reference/sampling.h"
#include "stress/shapes.h"

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
