// The vertices of a primitive, with the attributes that its material needs.
#pragma once

#include "load/accessor.h"
#include "scene/scene.h"

namespace isolux {

/// The accessors that vertices come from; -1 for what there is not, or nothing needs.
struct VertexAccessors {
    int position = -1;
    int normal = -1;
    int tangent = -1;
    int color = -1;
    std::vector<int> uvs{}; ///< one a set that the material's maps use

    /// Of one vertex in a Mesh.
    [[nodiscard]] std::uint64_t bytesPerVertex() const;
};

class VertexReader {
public:
    VertexReader(const Asset& asset, LoadContext& context, std::string_view pointer)
        : asset_(asset), context_(context), pointer_(pointer) {}

    /// Fills a mesh's attributes for the given vertices. Numbers must be finite; colours beyond [0, 1], and normals and
    /// tangents that are not unit, or without a sign, are put right, with a warning.
    void read(const VertexAccessors& accessors, std::span<const std::uint32_t> vertices, Mesh& mesh) const;

private:
    template <int N>
    [[nodiscard]] std::vector<glm::vec<N, float>> gather(int accessor, std::span<const std::uint32_t> vertices) const;
    [[nodiscard]] std::vector<glm::vec4> readColors(int accessor, std::span<const std::uint32_t> vertices) const;
    [[nodiscard]] std::vector<Vec3f> readNormals(int accessor, std::span<const std::uint32_t> vertices) const;
    [[nodiscard]] std::vector<glm::vec4> readTangents(int accessor, std::span<const std::uint32_t> vertices) const;

    const Asset& asset_;
    LoadContext& context_;
    std::string_view pointer_;
};

/// Gives every triangle vertices of its own, with its geometric normal; zero where it has no area. Tangents need
/// normals, and a mesh without them is flat (glTF 2.0, 3.7.2.1).
void makeFlat(Mesh& mesh);

} // namespace isolux
