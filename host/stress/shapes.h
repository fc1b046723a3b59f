// Meshes and scenes that stress tests are made of.
#pragma once

#include "scene/render_settings.h"
#include "scene/scene.h"

#include <cstdint>

namespace isolux {

[[nodiscard]] Mat4d translation(const Vec3d& offset);
[[nodiscard]] Mat4d scaling(const Vec3d& factors);

/// Which sides of a surface emit.
enum class Faces { front, both };

/// A scene under construction: each mesh gets its own instance. Material 0 is there: white and Lambertian.
struct SceneBuilder {
    Scene scene;

    SceneBuilder() { scene.materials.resize(1); }
    /// Lambertian.
    std::uint32_t material(const Vec3d& baseColor, const Vec3d& emission, Faces emitting);
    std::uint32_t material(const Material& material);
    void mesh(Mesh mesh, const Mat4d& worldFromObject = Mat4d(1.0));
    /// In perspective; `yfov` in radians.
    void camera(const Vec3d& position, const Vec3d& target, double yfov);
};

[[nodiscard]] Mesh triangleMesh(const Vec3f& a, const Vec3f& b, const Vec3f& c, std::uint32_t material = 0);
/// The square [-1, 1]^2 at z = 0, front up.
[[nodiscard]] Mesh squareMesh(std::uint32_t material);
/// The cube [-1, 1]^3, fronts inwards: 12 triangles, 8 shared vertices.
[[nodiscard]] Mesh roomMesh(std::uint32_t material);
/// The same with fronts outwards.
[[nodiscard]] Mesh blockMesh(std::uint32_t material);
[[nodiscard]] Mesh icosahedron();
/// Each triangle into four, the new vertices shared by both neighbours.
[[nodiscard]] Mesh subdivided(const Mesh& mesh);
/// 20 * 4^levels triangles, fronts outwards, flat.
[[nodiscard]] Mesh icosphere(int levels, float radius);

/// The size of a sweep's images: few pixels and many samples or the other way round.
[[nodiscard]] RenderSettings stressSettings(std::uint32_t size, std::uint32_t samples);

/// A Cornell box of edge 2 about the origin: coloured walls, a lamp in the ceiling, two blocks; from z = 4.9.
[[nodiscard]] Scene cornellBox();

/// The scene with all lengths times `factor`; intensities of punctual lights grow so that surfaces look the same.
[[nodiscard]] Scene scaled(Scene scene, double factor);

} // namespace isolux
