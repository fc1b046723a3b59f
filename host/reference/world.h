// The scene flattened to primitives in world space: computed in double, kept in the precision of the render.
#pragma once

#include "core/math.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace isolux {

template <typename Real> struct WorldTriangle {
    std::array<Vec3<Real>, 3> positions;
    std::array<Vec3<Real>, 3> normals{}; ///< of the vertices, in the world, of any common length; zero: shaded flat
    Vec3<Real> ng{0};                    ///< unit, on the front side; zero where the triangle has no area: never hit
    Real area = 0;
    std::uint32_t material = 0;
    std::uint32_t object = 0;                ///< the instance it belongs to
    std::array<std::uint32_t, 3> vertices{}; ///< of its mesh, in the order of the positions
};

/// What directions in an instance's mesh become in the world.
template <typename Real> struct WorldInstance {
    Mat3<Real> linear{1};
    Real handedness = 1; ///< -1: mirrored
};

template <typename Real> struct WorldSphere {
    Vec3<Real> center;
    Real radius = 1;
    std::uint32_t material = 0;
    std::uint32_t object = 0; ///< counted after all instances
};

/// A point of a primitive.
template <typename Real> struct Place {
    std::uint32_t primitive = 0;
    Vec3<Real> barycentric{0}; ///< of a triangle
};

/// A primitive id is an index into `triangles`, or `triangles.size()` plus an index into `spheres`.
template <typename Real> struct World {
    std::vector<WorldTriangle<Real>> triangles;
    std::vector<WorldSphere<Real>> spheres;
    std::vector<WorldInstance<Real>> instances;
    std::vector<Box3f> boxes; ///< one per primitive, rounded outward

    [[nodiscard]] bool isTriangle(std::uint32_t primitive) const { return primitive < triangles.size(); }
    [[nodiscard]] const WorldSphere<Real>& sphere(std::uint32_t primitive) const {
        return spheres[primitive - triangles.size()];
    }
    [[nodiscard]] std::uint32_t materialOf(std::uint32_t primitive) const {
        return isTriangle(primitive) ? triangles[primitive].material : sphere(primitive).material;
    }
    [[nodiscard]] std::uint32_t objectOf(std::uint32_t primitive) const {
        return isTriangle(primitive) ? triangles[primitive].object : sphere(primitive).object;
    }
    [[nodiscard]] std::uint32_t primitiveCount() const { return static_cast<std::uint32_t>(boxes.size()); }
};

/// Places every instance and sphere; the order is that of primitive ids. Instantiated for float and double.
template <typename Real> [[nodiscard]] World<Real> flatten(const Scene& scene);

} // namespace isolux
