// Turns primitives of glTF meshes into meshes of the scene, each once, however many nodes place it.
#pragma once

#include "load/accessor.h"
#include "scene/scene.h"

namespace isolux {

class MeshBuilder {
public:
    MeshBuilder(const Asset& asset, LoadContext& context, Scene& scene)
        : asset_(asset), context_(context), scene_(scene), built_(asset.model.meshes.size()) {}

    /// The scene's meshes for the primitives of a glTF mesh that can be rendered, built at the first call.
    [[nodiscard]] const std::vector<std::uint32_t>& meshesOf(std::size_t gltfMesh);

    /// The scene's material for an index of the file; the default material for -1.
    [[nodiscard]] std::uint32_t materialFor(int gltfMaterial);

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
    void fillVertices(Mesh& mesh, const Source& source, std::span<const std::uint32_t> vertices);
    void fill(std::vector<Vec3f>& target, int accessor, std::span<const std::uint32_t> vertices) const;
    void warnIfUndeclared(const Source& source);
    void charge(const Source& source);
    [[nodiscard]] std::uint64_t bytesToBuild(const Source& source) const;
    [[nodiscard]] const tinygltf::Accessor& sequenceOf(const Source& source) const;
    [[nodiscard]] const tinygltf::Accessor& accessorAt(int index) const {
        return asset_.model.accessors[static_cast<std::size_t>(index)];
    }

    const Asset& asset_;
    LoadContext& context_;
    Scene& scene_;
    std::vector<std::optional<std::vector<std::uint32_t>>> built_;
    std::optional<std::uint32_t> defaultMaterial_;
    std::uint64_t bytesBuilt_ = 0;
    std::uint64_t bytesClaimed_ = 0; ///< of these, what no bufferView stands behind
};

} // namespace isolux
