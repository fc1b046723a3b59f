#include "load/mesh_builder.h"

#include "load/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace isolux {
namespace {

constexpr std::string_view kLeftOut = "left out";

int attributeOf(const tinygltf::Primitive& primitive, const char* name) {
    const auto attribute = primitive.attributes.find(name);
    return attribute == primitive.attributes.end() ? -1 : attribute->second;
}

/// The vertices that `indices` use, in ascending order, if there are fewer indices than vertices: primitives often
/// share one large vertex buffer, and a copy of it for each would not fit. Otherwise all vertices.
std::vector<std::uint32_t> verticesUsed(const std::vector<std::uint32_t>& indices, std::size_t vertexCount) {
    std::vector<std::uint32_t> used;
    if (indices.size() < vertexCount) {
        used = indices;
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
    } else {
        used.resize(vertexCount);
        std::iota(used.begin(), used.end(), 0u);
    }
    return used;
}

/// Rewrites indices into the file's vertices as indices into `used`.
void renumber(std::vector<std::uint32_t>& indices, const std::vector<std::uint32_t>& used) {
    const bool isIdentity = used.empty() || used.back() == used.size() - 1;
    if (isIdentity) return;
    for (std::uint32_t& index : indices)
        index = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), index) - used.begin());
}

} // namespace

const std::vector<std::uint32_t>& MeshBuilder::meshesOf(std::size_t gltfMesh) {
    if (!built_[gltfMesh]) build(gltfMesh);
    return *built_[gltfMesh];
}

std::uint32_t MeshBuilder::materialFor(int gltfMaterial) {
    if (gltfMaterial >= 0) return static_cast<std::uint32_t>(gltfMaterial);
    if (!defaultMaterial_) {
        defaultMaterial_ = static_cast<std::uint32_t>(scene_.materials.size());
        scene_.materials.emplace_back().name = "default";
    }
    return *defaultMaterial_;
}

void MeshBuilder::build(std::size_t gltfMesh) {
    const tinygltf::Mesh& source = asset_.model.meshes[gltfMesh];
    const std::string name = source.name.empty() ? fmt::format("mesh {}", gltfMesh) : source.name;
    std::vector<std::uint32_t>& meshes = built_[gltfMesh].emplace();
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
        const Source primitive{source.primitives[i], fmt::format("/meshes/{}/primitives/{}", gltfMesh, i)};
        if (!isSupported(primitive)) continue;
        Mesh mesh = buildMesh(primitive);
        mesh.name = source.primitives.size() == 1 ? name : fmt::format("{}[{}]", name, i);
        meshes.push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
        scene_.meshes.push_back(std::move(mesh));
    }
}

/// Whether an accessor can be read as it is: stored, complete, and in single precision where it is a vector.
bool MeshBuilder::isUsable(int accessor, const Source& source, std::string_view consequence) {
    const tinygltf::Accessor& entry = asset_.model.accessors[static_cast<std::size_t>(accessor)];
    if (entry.sparse.isSparse) {
        context_.warn(source.pointer, fmt::format("sparse accessors are not supported; {}", consequence));
        return false;
    }
    if (entry.bufferView < 0) {
        context_.warn(source.pointer, fmt::format("it uses an accessor without a bufferView; {}", consequence));
        return false;
    }
    if (entry.type == TINYGLTF_TYPE_VEC3 && entry.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
        context_.warn(source.pointer, fmt::format("quantised vertices are not supported; {}", consequence));
        return false;
    }
    return true;
}

bool MeshBuilder::isSupported(const Source& source) {
    if (source.primitive.mode != TINYGLTF_MODE_TRIANGLES) return false; // warned of at verification
    const int position = attributeOf(source.primitive, "POSITION");
    if (position < 0) {
        context_.warn(source.pointer, "it has no POSITION; left out");
        return false;
    }
    if (!isUsable(position, source, kLeftOut)) return false;
    return source.primitive.indices < 0 || isUsable(source.primitive.indices, source, kLeftOut);
}

Mesh MeshBuilder::buildMesh(const Source& source) {
    const std::size_t position = static_cast<std::size_t>(attributeOf(source.primitive, "POSITION"));
    const std::size_t vertexCount = asset_.model.accessors[position].count;
    if (vertexCount > 0xFFFFFFFFu)
        context_.fail(source.pointer, fmt::format("{} vertices are more than 2^32 - 1", vertexCount));
    std::vector<std::uint32_t> indices = readIndices(source, vertexCount);
    const std::vector<std::uint32_t> vertices = verticesUsed(indices, vertexCount);
    renumber(indices, vertices);
    Mesh mesh;
    mesh.material = materialFor(source.primitive.material);
    fillVertices(mesh, source, vertices);
    mesh.triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); i += 3)
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return mesh;
}

std::vector<std::uint32_t> MeshBuilder::readIndices(const Source& source, std::size_t vertexCount) {
    std::optional<AccessorView> view;
    if (source.primitive.indices >= 0) view.emplace(asset_, static_cast<std::size_t>(source.primitive.indices));
    const std::size_t count = view ? view->count() : vertexCount;
    if (count % 3 != 0)
        context_.warn(source.pointer, "its indices are no multiple of three; the last ones are ignored");
    charge(count);
    std::vector<std::uint32_t> indices(count - count % 3);
    if (!view) std::iota(indices.begin(), indices.end(), 0u);
    for (std::size_t i = 0; view && i < indices.size(); ++i) {
        indices[i] = view->readIndex(i);
        if (indices[i] >= vertexCount)
            context_.fail(
                fmt::format("/accessors/{}", source.primitive.indices),
                fmt::format("element {} is {}, but the primitive has only {} vertices", i, indices[i], vertexCount));
    }
    return indices;
}

void MeshBuilder::fillVertices(Mesh& mesh, const Source& source, std::span<const std::uint32_t> vertices) {
    const auto fill = [&](std::vector<Vec3f>& target, int accessor) {
        const AccessorView view(asset_, static_cast<std::size_t>(accessor));
        target.reserve(vertices.size());
        for (const std::uint32_t vertex : vertices) {
            const Vec3f value = target.emplace_back(view.readVec3(vertex));
            if (!isFinite(value))
                context_.fail(fmt::format("/accessors/{}", accessor),
                              fmt::format("element {} is not finite ({}, {}, {})", vertex, value.x, value.y, value.z));
        }
    };
    fill(mesh.positions, attributeOf(source.primitive, "POSITION"));
    const int normal = attributeOf(source.primitive, "NORMAL");
    if (normal >= 0 && isUsable(normal, source, "shaded flat")) fill(mesh.normals, normal);
}

/// Many primitives may refer to the same data, so that a small file could ask for any amount of memory.
void MeshBuilder::charge(std::size_t indices) {
    // Meshes that differ in material alone share data too, so a large factor is no proof of malice.
    constexpr std::uint64_t kAlwaysAllowed = std::uint64_t{1} << 30;
    constexpr std::uint64_t kLargestFactor = 64;
    bytesBuilt_ += std::uint64_t{indices} * (sizeof(std::uint32_t) + 2 * sizeof(Vec3f));
    if (bytesBuilt_ > kAlwaysAllowed && bytesBuilt_ / kLargestFactor > asset_.buffers.totalBytes)
        context_.fail("/meshes",
                      fmt::format("the meshes expand to over {} times the size of the buffers; refer to the same "
                                  "mesh from several nodes instead of repeating its primitives",
                                  kLargestFactor));
}

} // namespace isolux
