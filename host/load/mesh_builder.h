// Turns primitives of glTF meshes into meshes of the scene, each once, however many nodes place it.
#pragma once

#include "load/material_builder.h"
#include "load/vertices.h"

namespace isolux {

class MeshBuilder {
public:
    MeshBuilder(const Asset& asset, MaterialBuilder& materials, LoadContext& context, std::vector<Mesh>& meshes)
        : asset_(asset), materials_(materials), context_(context), meshes_(meshes), built_(asset.model.meshes.size()) {}

    /// The scene's meshes for the primitives of a glTF mesh that can be rendered, built at the first call.
    [[nodiscard]] const std::vector<std::uint32_t>& meshesOf(std::size_t gltfMesh);

private:
    /// A primitive, and the pointer that names it.
    struct Source {
        const tinygltf::Primitive& primitive;
        std::string pointer;
    };

    void build(std::size_t gltfMesh);
    [[nodiscard]] bool isSupported(const Source& source);
    [[nodiscard]] bool isUsable(int accessor, const Source& source, std::string_view consequence);
    [[nodiscard]] Mesh buildMesh(const Source& source);
    [[nodiscard]] std::vector<std::uint32_t> readIndices(const Source& source, std::size_t vertexCount);
    [[nodiscard]] std::uint32_t materialOf(const Source& source);
    [[nodiscard]] bool hasNormalMap(std::uint32_t material) const;
    [[nodiscard]] VertexAccessors accessorsOf(const Source& source, std::uint32_t material);
    void completeTangents(Mesh& mesh) const;
    void charge(const Source& source, const VertexAccessors& accessors);
    [[nodiscard]] std::uint64_t bytesToBuild(const Source& source, const VertexAccessors& accessors) const;
    [[nodiscard]] const tinygltf::Accessor& sequenceOf(const Source& source) const;
    [[nodiscard]] const tinygltf::Accessor& accessorAt(int index) const {
        return asset_.model.accessors[static_cast<std::size_t>(index)];
    }

    const Asset& asset_;
    MaterialBuilder& materials_;
    LoadContext& context_;
    std::vector<Mesh>& meshes_;
    std::vector<std::optional<std::vector<std::uint32_t>>> built_;
    std::uint64_t bytesBuilt_ = 0;
    std::uint64_t bytesClaimed_ = 0; ///< of these, what no bufferView stands behind
};

} // namespace isolux
