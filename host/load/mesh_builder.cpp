#include "load/mesh_builder.h"

#include "load/context.h"
#include "load/topology.h"
#include "load/verify.h"
#include "scene/tangents.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace isolux {
namespace {

constexpr std::string_view kLeftOut = "left out";

int attributeOf(const tinygltf::Primitive& primitive, const std::string& name) {
    const auto attribute = primitive.attributes.find(name);
    return attribute == primitive.attributes.end() ? -1 : attribute->second;
}

std::string uvAttribute(std::uint32_t set) { return fmt::format("TEXCOORD_{}", set); }

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

void MeshBuilder::build(std::size_t gltfMesh) {
    const tinygltf::Mesh& source = asset_.model.meshes[gltfMesh];
    const std::string name = source.name.empty() ? fmt::format("mesh {}", gltfMesh) : source.name;
    std::vector<std::uint32_t>& meshes = built_[gltfMesh].emplace();
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
        const Source primitive{source.primitives[i], fmt::format("/meshes/{}/primitives/{}", gltfMesh, i)};
        if (!isSupported(primitive)) continue;
        Mesh mesh = buildMesh(primitive);
        mesh.name = source.primitives.size() == 1 ? name : fmt::format("{}[{}]", name, i);
        meshes.push_back(static_cast<std::uint32_t>(meshes_.size()));
        meshes_.push_back(std::move(mesh));
    }
}

/// Whether a primitive's accessor holds anything: one without data is all zeros, which is no surface and no direction.
bool MeshBuilder::isUsable(int accessor, const Source& source, std::string_view consequence) {
    if (hasData(accessorAt(accessor))) return true;
    context_.warn(source.pointer, fmt::format("it uses an accessor without data, all zeros; {}", consequence));
    return false;
}

bool MeshBuilder::isSupported(const Source& source) {
    if (!isTriangleMode(source.primitive.mode)) return false; // warned of at verification
    const int position = attributeOf(source.primitive, "POSITION");
    if (position < 0) {
        context_.warn(source.pointer, "it has no POSITION; left out");
        return false;
    }
    if (!isUsable(position, source, kLeftOut)) return false;
    const int indices = attributeOf(source.primitive, kIndicesAttribute);
    return indices < 0 || isUsable(indices, source, kLeftOut);
}

Mesh MeshBuilder::buildMesh(const Source& source) {
    const std::size_t vertexCount = accessorAt(attributeOf(source.primitive, "POSITION")).count;
    if (vertexCount > 0xFFFFFFFFu)
        context_.fail(source.pointer, fmt::format("{} vertices are more than 2^32 - 1", vertexCount));
    Mesh mesh;
    mesh.material = materialOf(source);
    const VertexAccessors accessors = accessorsOf(source, mesh.material);
    charge(source, accessors);
    std::vector<std::uint32_t> indices = readIndices(source, vertexCount);
    const std::vector<std::uint32_t> vertices = verticesUsed(indices, vertexCount);
    renumber(indices, vertices);
    VertexReader(asset_, context_, source.pointer).read(accessors, vertices, mesh);
    mesh.triangles = assembleTriangles(source.primitive.mode, indices);
    completeTangents(mesh);
    return mesh;
}

/// The primitive's material; without the maps for which it has no coordinates, as was warned of at verification.
std::uint32_t MeshBuilder::materialOf(const Source& source) {
    const std::uint32_t material = materials_.indexOf(source.primitive.material);
    std::vector<std::uint32_t> missing;
    for (const std::uint32_t set : materials_.at(material).uvSets)
        if (attributeOf(source.primitive, uvAttribute(set)) < 0) missing.push_back(set);
    return materials_.indexWithout(material, missing);
}

bool MeshBuilder::hasNormalMap(std::uint32_t material) const {
    return materials_.at(material).material.map(MapSlot::normal).present();
}

/// What of a primitive's attributes is kept: colours always, coordinates that a map uses, and tangents for a normal
/// map. Without normals a mesh is flat, whatever its tangents (glTF 2.0, 3.7.2.1).
VertexAccessors MeshBuilder::accessorsOf(const Source& source, std::uint32_t material) {
    const auto find = [&](const std::string& name) { return attributeOf(source.primitive, name); };
    VertexAccessors accessors{find("POSITION"), find("NORMAL"), -1, find("COLOR_0")};
    if (accessors.normal >= 0 && !isUsable(accessors.normal, source, "shaded flat")) accessors.normal = -1;
    if (accessors.normal >= 0 && hasNormalMap(material)) accessors.tangent = find("TANGENT");
    for (const std::uint32_t set : materials_.at(material).uvSets) accessors.uvs.push_back(find(uvAttribute(set)));
    return accessors;
}

/// A normal map needs tangents, and these need normals.
void MeshBuilder::completeTangents(Mesh& mesh) const {
    if (!hasNormalMap(mesh.material) || !mesh.tangents.empty()) return;
    if (mesh.normals.empty()) makeFlat(mesh);
    generateTangents(mesh, materials_.at(mesh.material).material.map(MapSlot::normal).uvSet);
}

/// The accessor that says how many indices a primitive has: that of its indices, or of its vertices in order.
const tinygltf::Accessor& MeshBuilder::sequenceOf(const Source& source) const {
    const int indices = attributeOf(source.primitive, kIndicesAttribute);
    return accessorAt(indices >= 0 ? indices : attributeOf(source.primitive, "POSITION"));
}

/// The indices that make triangles, in order; without an accessor of indices the vertices follow each other.
std::vector<std::uint32_t> MeshBuilder::readIndices(const Source& source, std::size_t vertexCount) {
    const int mode = source.primitive.mode;
    const std::size_t count = sequenceOf(source).count;
    std::vector<std::uint32_t> indices(usedIndices(mode, count));
    if (indices.empty())
        context_.warn(source.pointer, "fewer than three indices make no triangle; left out");
    else if (indices.size() < count)
        context_.warn(source.pointer, "its indices are no multiple of three; the last ones are ignored");
    const int accessor = attributeOf(source.primitive, kIndicesAttribute);
    if (accessor < 0) {
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    const AccessorView view(asset_, static_cast<std::size_t>(accessor), context_);
    const auto fail = [&](std::size_t i, std::string_view reason) {
        context_.fail(fmt::format("/accessors/{}", accessor),
                      fmt::format("element {} is {}, {}", i, indices[i], reason));
    };
    const std::uint32_t restart = view.restartIndex();
    for (std::size_t i = 0; i < indices.size(); ++i) {
        indices[i] = view.readIndex(i);
        if (indices[i] == restart) fail(i, "which restarts primitives elsewhere and is no index in glTF");
        if (indices[i] >= vertexCount) fail(i, fmt::format("but the primitive has only {} vertices", vertexCount));
    }
    return indices;
}

/// Many primitives may refer to the same data, and an accessor without a bufferView to none at all, so that a small
/// file could ask for any amount of memory and time. What a primitive takes is known before any of it is allocated.
void MeshBuilder::charge(const Source& source, const VertexAccessors& accessors) {
    // Meshes that differ in material alone share data too, so a large factor is no proof of malice.
    constexpr std::uint64_t kClaimsAllowed = std::uint64_t{1} << 20;
    constexpr std::uint64_t kLargestFactor = 64;
    const auto exceeds = [&](std::uint64_t bytes, std::uint64_t allowed) {
        return bytes > allowed && bytes / kLargestFactor > asset_.buffers.totalBytes;
    };
    const tinygltf::Accessor& sequence = sequenceOf(source);
    const std::uint64_t bytes = bytesToBuild(source, accessors);
    bytesBuilt_ += bytes;
    if (sequence.bufferView < 0) bytesClaimed_ += bytes;
    if (exceeds(bytesClaimed_, kClaimsAllowed))
        context_.fail(source.pointer, fmt::format("its {} elements without a bufferView come to over {} times the "
                                                  "size of the buffers; store them in one",
                                                  sequence.count, kLargestFactor));
    if (exceeds(bytesBuilt_, context_.limits().meshBytes))
        context_.fail("/meshes",
                      fmt::format("the meshes expand to over {} times the size of the buffers; refer to the same "
                                  "mesh from several nodes instead of repeating its primitives",
                                  kLargestFactor));
}

/// Indices, vertices, triangles, the indices of sparse accessors that are checked on the way, and the corners of
/// triangles into which tangents may split the vertices.
std::uint64_t MeshBuilder::bytesToBuild(const Source& source, const VertexAccessors& accessors) const {
    const std::uint64_t indices = sequenceOf(source).count;
    const std::uint64_t triangles = mostTriangles(source.primitive.mode, indices);
    std::uint64_t bytes = indices * (sizeof(std::uint32_t) + accessors.bytesPerVertex());
    bytes += triangles * sizeof(Mesh::triangles[0]);
    if (accessors.tangent < 0 && hasNormalMap(materials_.indexOf(source.primitive.material)))
        bytes += 3 * triangles * (accessors.bytesPerVertex() + sizeof(Vec3f) + sizeof(glm::vec4));
    for (const auto& [name, accessor] : source.primitive.attributes)
        if (const auto& sparse = accessorAt(accessor).sparse; sparse.isSparse)
            bytes += static_cast<std::uint64_t>(sparse.count) * sizeof(std::uint32_t);
    return bytes;
}

} // namespace isolux
