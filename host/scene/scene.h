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

enum class Projection { perspective, orthographic };

/// A camera looking along -z of its own frame, +y up, as glTF has it. Near and far planes do not clip.
struct Camera {
    std::string name;
    Projection projection = Projection::perspective;
    Vec3d position{0.0};
    Mat3d worldFromCamera{1.0};        ///< columns right, up, backward: orthonormal
    double yfov = 0.7;                 ///< perspective: full vertical field of view in radians
    double ymag = 1.0;                 ///< orthographic: half the height of what is seen, a length in the world
    std::optional<double> aspectRatio; ///< width / height the file asks for; the image's own decides
};

enum class PunctualKind { point, spot, directional };

/// A light without extent (KHR_lights_punctual). Its range, a hint to rasterisers, is not part of it.
struct PunctualLight {
    std::string name;
    PunctualKind kind = PunctualKind::point;
    Vec3d position{0.0};                ///< point and spot
    Vec3d direction{0.0, 0.0, -1.0};    ///< unit: where the light travels to; spot and directional
    Vec3d intensity{1.0};               ///< point and spot: W/sr; directional: W/m^2 on a surface that faces it
    double cosInner = 1.0;              ///< spot: of the angle up to which it shines in full
    double cosOuter = 0.70710678118655; ///< spot: of the angle from which on it is dark; less than cosInner
};

/// The share of a spot's intensity at the cosine of an angle to its axis: t^2 with t from 0 at the outer cone to 1 at
/// the inner one, linear in the cosine (KHR_lights_punctual, "Inner and outer cone angles").
template <typename Real> [[nodiscard]] Real spotAttenuation(const PunctualLight& light, Real cosine) {
    const Real outer = static_cast<Real>(light.cosOuter);
    const Real t = (cosine - outer) / (static_cast<Real>(light.cosInner) - outer);
    const Real clamped = std::clamp(t, Real(0), Real(1));
    return clamped * clamped;
}

enum class EnvironmentExtent { sphere, upperHalf };

/// Constant radiance from infinitely far away; the camera sees it.
struct Environment {
    Vec3d radiance{0.0};                                  ///< W/(sr m^2); zero: there is none
    EnvironmentExtent extent = EnvironmentExtent::sphere; ///< upperHalf: from directions with y > 0 alone

    [[nodiscard]] bool emits() const { return maxComponent(radiance) > 0.0; }
    [[nodiscard]] double solidAngle() const { return (extent == EnvironmentExtent::sphere ? 4.0 : 2.0) * kPi; }
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
    std::vector<PunctualLight> punctualLights;
    Environment environment;
    std::vector<std::string> warnings; ///< what the file asks for and is not supported, by name
    std::string contentHash;           ///< hexadecimal hash of the file and everything it refers to
};

/// Number of primitives: the triangles of every instance in order, then the spheres. A primitive's index in this
/// order is its id everywhere (lights, hits, signatures).
[[nodiscard]] std::size_t primitiveCount(const Scene& scene);

/// World-space bounds of all vertices and spheres; empty if there are none.
[[nodiscard]] Box3d worldBounds(const Scene& scene);

/// Half the diagonal of the world bounds: how large a disc lights from afar illuminate. Zero if there is nothing.
[[nodiscard]] double worldRadius(const Scene& scene);

/// A camera that sees the whole scene from the front, slightly from above; for files that bring none.
[[nodiscard]] Camera frameScene(const Scene& scene);

/// Checks what both renderers rely on (indices in range, finite numbers, albedo in [0, 1], a size between 1e-30 and
/// 1e30); throws Error naming the offender. A loader calls it last.
void validate(const Scene& scene);

} // namespace isolux
