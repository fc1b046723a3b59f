// The emission of textured surfaces and environment maps on the average: what light powers are made of.
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace isolux {

/// Mean emission of surfaces, their maps counted in, by deterministic lookups of nearest texels: as many as texels are
/// covered, at least 16 and at most 1024 a triangle. Where many triangles have a map that varies the maximum is less,
/// so that all lookups together are at most 2^24, or 16 a triangle.
class MeanEmission {
public:
    /// Keeps a reference to the scene.
    explicit MeanEmission(const Scene& scene);

    /// Over a triangle of a mesh, W/(sr m^2). What lights it only between two lookups is not seen.
    [[nodiscard]] Vec3d ofTriangle(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) const;
    /// Of a material on a sphere, whose coordinates are (0, 0).
    [[nodiscard]] Vec3d ofSphere(std::uint32_t material) const;

private:
    /// A material's emission with a map that is constant multiplied in, and whether it has one that is not.
    struct Surface {
        Vec3d emission{0.0};
        bool varies = false;
    };

    [[nodiscard]] Vec3d meanOfMap(const TextureMap& map, const std::array<Vec2d, 3>& uvs) const;

    const Scene& scene_;
    std::vector<Surface> surfaces_; ///< by material
    std::uint64_t mostLookups_ = 0; ///< a triangle
};

/// Flux through one unit of area that faces it from everywhere, as luminance: the integral over all directions of the
/// radiance. That of a map is the sum of its texels times their cells' solid angles, before interpolation blurs them.
[[nodiscard]] double environmentFlux(const Environment& environment);

} // namespace isolux
