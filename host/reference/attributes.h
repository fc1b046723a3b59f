// What a mesh stores at its vertices, interpolated to a point: texture coordinates, colours, tangents; and the maps of
// its material, read there.
#pragma once

#include "reference/texture.h"
#include "reference/world.h"

#include <cstdint>

namespace isolux {

/// A tangent in the world as interpolated, of any length, and the sign of the bitangent.
template <typename Real> struct Tangent {
    Vec3<Real> direction{0}; ///< zero where there is none
    Real sign = 1;
};

/// Keeps references.
template <typename Real> class Attributes {
public:
    Attributes(const Scene& scene, const World<Real>& world) : scene_(scene), world_(world) {}

    [[nodiscard]] const Material& materialAt(const Place<Real>& place) const {
        return scene_.materials[world_.materialOf(place.primitive)];
    }

    /// The material's map of a slot at a point; ones if it has none.
    [[nodiscard]] Vec4<Real> map(const Place<Real>& place, MapSlot slot) const {
        const TextureMap& map = materialAt(place).map(slot);
        if (!map.present()) return Vec4<Real>(1);
        const Texture& texture = scene_.textures[map.texture];
        const Encoding encoding = isSrgb(slot) ? Encoding::srgb : Encoding::linear;
        const Vec2<Real> uv = glm::mat<2, 2, Real>(map.uvFromMesh) * coordinates(place, map.uvSet);
        return TextureReader<Real>(texture, scene_.images[texture.image], encoding).at(uv + Vec2<Real>(map.offset));
    }

    /// Of the vertices; ones if the mesh has none.
    [[nodiscard]] Vec4<Real> color(const Place<Real>& place) const {
        if (!world_.isTriangle(place.primitive)) return Vec4<Real>(1);
        const Mesh& mesh = meshOf(place.primitive);
        return mesh.colors.empty() ? Vec4<Real>(1) : interpolate<Vec4<Real>>(place, mesh.colors);
    }

    [[nodiscard]] Tangent<Real> tangent(const Place<Real>& place) const {
        if (!world_.isTriangle(place.primitive)) return {};
        const WorldTriangle<Real>& triangle = world_.triangles[place.primitive];
        const Mesh& mesh = meshOf(place.primitive);
        if (mesh.tangents.empty()) return {};
        const auto local = Vec3<Real>(interpolate<Vec4<Real>>(place, mesh.tangents));
        const WorldInstance<Real>& instance = world_.instances[triangle.object];
        return {instance.linear * local,
                instance.handedness * static_cast<Real>(mesh.tangents[triangle.vertices[0]].w)};
    }

private:
    [[nodiscard]] const Mesh& meshOf(std::uint32_t primitive) const {
        return scene_.meshes[scene_.instances[world_.triangles[primitive].object].mesh];
    }

    [[nodiscard]] Vec2<Real> coordinates(const Place<Real>& place, std::uint32_t set) const {
        if (!world_.isTriangle(place.primitive)) return Vec2<Real>(0);
        return interpolate<Vec2<Real>>(place, meshOf(place.primitive).uvs[set]);
    }

    template <typename Value, typename Stored>
    [[nodiscard]] Value interpolate(const Place<Real>& place, const std::vector<Stored>& values) const {
        const auto& vertices = world_.triangles[place.primitive].vertices;
        return place.barycentric[0] * Value(values[vertices[0]]) + place.barycentric[1] * Value(values[vertices[1]]) +
               place.barycentric[2] * Value(values[vertices[2]]);
    }

    const Scene& scene_;
    const World<Real>& world_;
};

} // namespace isolux
