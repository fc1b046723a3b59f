// A scene as plain data, in object space and double transforms. Both renderers read this and nothing else.
#pragma once

#include "core/math.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// A Lambertian surface that may emit. Colours are linear Rec. 709.
struct Material {
    std::string name;
    Vec3d baseColor{1.0};     ///< diffuse albedo, in [0, 1]
    Vec3d emission{0.0};      ///< emitted radiance, W/(sr m^2), from the front face (and the back face if doubleSided)
    bool doubleSided = false; ///< the back face emits too; scattering is two-sided always

    [[nodiscard]] bool emits() const { return maxComponent(emission) > 0.0; }
};

/// Triangles in object space, counter-clockwise seen from the front.
struct Mesh {
    std::string name;
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals; ///< one per position, or empty: then the mesh is shaded flat
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::uint32_t material = 0;
};

/// One placement of a mesh in the world.
struct Instance {
    std::string name;
    std::uint32_t mesh = 0;
    Mat4d worldFromObject{1.0};
};

/// An exact sphere in world space.
struct Sphere {
    std::string name;
    Vec3d center{0.0};
    double radius = 1.0;
    std::uint32_t material = 0;
};

/// A pinhole camera looking along -z of its own frame, +y up, as glTF has it. Near and far planes do not clip.
struct Camera {
    std::string name;
    Vec3d position{0.0};
    Mat3d worldFromCamera{1.0};        ///< columns right, up, backward: orthonormal
    double yfov = 0.7;                 ///< full vertical field of view in radians
    std::optional<double> aspectRatio; ///< width / height the file asks for; the image's own decides
};

/// A vertex in the world, in double: float could not hold it far from the origin.
[[nodiscard]] inline Vec3d transformPoint(const Mat4d& worldFromObject, const Vec3f& point) {
    return Vec3d(worldFromObject * glm::dvec4(Vec3d(point), 1.0));
}

struct Scene {
    std::string name;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Sphere> spheres;
    std::vector<Camera> cameras;
    std::vector<std::string> warnings; ///< what the file asks for and is not supported, by name
    std::string contentHash;           ///< hexadecimal hash of the file and everything it refers to
};

/// Number of primitives: the triangles of every instance in order, then the spheres. A primitive's index in this
/// order is its id everywhere (lights, hits, signatures).
[[nodiscard]] std::size_t primitiveCount(const Scene& scene);

/// World-space bounds of all vertices and spheres; empty if there are none.
[[nodiscard]] Box3d worldBounds(const Scene& scene);

/// A camera that sees the whole scene from the front, slightly from above; for files that bring none.
[[nodiscard]] Camera frameScene(const Scene& scene);

/// Checks what both renderers rely on (indices in range, finite numbers, albedo in [0, 1], a size between 1e-30 and
/// 1e30); throws Error naming the offender. A loader calls it last.
void validate(const Scene& scene);

} // namespace isolux
