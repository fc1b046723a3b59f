#include "pack/packed_attributes.h"

#include "shared/scene_records.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace isolux {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

double largestEntry(const Mat3d& m) {
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) largest = std::max(largest, maxComponent(glm::abs(m[column])));
    return largest;
}

/// The inverse transpose up to a factor: the cofactors of the upper 3x3 matrix, finite for singular matrices too. One
/// factor for the whole instance keeps the vertex normals' lengths in proportion, as interpolation needs; it is chosen
/// so that no length is lost to float's range.
Mat3d normalMatrix(const Mat4d& m) {
    const Mat3d linear(m);
    const double size = largestEntry(linear);
    if (size == 0.0) return Mat3d(0.0);
    const Mat3d scaled = linear / size;
    const Mat3d cofactors(glm::cross(scaled[1], scaled[2]), glm::cross(scaled[2], scaled[0]),
                          glm::cross(scaled[0], scaled[1]));
    const double cofactorSize = largestEntry(cofactors);
    return cofactorSize == 0.0 ? cofactors : cofactors / cofactorSize;
}

/// One placement of a mesh: what its records are computed from.
struct Placement {
    const Mesh& mesh;
    Mat3d normalFromObject;
    Mat3d tangentFromObject; ///< up to a factor
    bool mirrored;
};

Placement place(const Scene& scene, const Instance& instance) {
    const Mat3d linear(instance.worldFromObject);
    const double size = largestEntry(linear);
    return {scene.meshes[instance.mesh], normalMatrix(instance.worldFromObject), size == 0.0 ? linear : linear / size,
            glm::determinant(linear) < 0.0};
}

glm::vec4 word(const Vec3f& xyz, float w) { return {xyz, w}; }

shared::NormalRecord normals(const Placement& placement, const Triangle& triangle) {
    if (placement.mesh.normals.empty()) return {};
    const auto at = [&](int corner) {
        return word(Vec3f(placement.normalFromObject * Vec3d(placement.mesh.normals[triangle[corner]])), 0.0f);
    };
    return {at(0), at(1), at(2)};
}

/// A mirrored instance turns the bitangent round.
shared::TangentRecord tangents(const Placement& placement, const Triangle& triangle) {
    if (placement.mesh.tangents.empty()) return {};
    const auto at = [&](int corner) {
        const glm::vec4& tangent = placement.mesh.tangents[triangle[corner]];
        return word(Vec3f(placement.tangentFromObject * Vec3d(tangent)), placement.mirrored ? -tangent.w : tangent.w);
    };
    return {at(0), at(1), at(2)};
}

shared::ColorRecord colors(const Placement& placement, const Triangle& triangle) {
    const auto& of = placement.mesh.colors;
    if (of.empty()) return {glm::vec4(1.0f), glm::vec4(1.0f), glm::vec4(1.0f)};
    return {of[triangle[0]], of[triangle[1]], of[triangle[2]]};
}

shared::UvRecord uvs(const Placement& placement, const Triangle& triangle, std::uint32_t set) {
    if (set >= placement.mesh.uvs.size() || placement.mesh.uvs[set].empty()) return {};
    const auto& of = placement.mesh.uvs[set];
    return {glm::vec4(of[triangle[0]], of[triangle[1]]), glm::vec4(of[triangle[2]], 0.0f, 0.0f)};
}

class AttributePacker {
public:
    AttributePacker(const Scene& scene, const AttributeNeeds& needs, std::span<const std::uint32_t> order)
        : scene_(scene), needs_(needs), indexOfId_(order.size()) {
        for (std::uint32_t i = 0; i < order.size(); ++i) indexOfId_[order[i]] = i;
        const auto count = static_cast<std::uint32_t>(order.size());
        std::uint32_t next = 0;
        const auto section = [&](bool needed, std::uint32_t words) {
            const std::uint32_t first = next;
            if (needed) next += count * words;
            return first;
        };
        packed_.offsets.x = section(needs.normals, shared::kNormalWords);
        packed_.offsets.y = section(needs.tangents, shared::kTangentWords);
        packed_.offsets.z = section(needs.colors, shared::kColorWords);
        packed_.offsets.w = next;
        for (std::size_t i = 0; i < needs.uvSets.size(); ++i) (void)section(true, shared::kUvWords);
        packed_.words.resize(next, glm::vec4(0.0f));
    }

    PackedAttributes pack() {
        for (const Instance& instance : scene_.instances) {
            const Placement placement = place(scene_, instance);
            for (Triangle triangle : placement.mesh.triangles) {
                // As the positions are turned round, so that they run counter-clockwise in the world.
                if (placement.mirrored) std::swap(triangle[1], triangle[2]);
                add(placement, triangle);
                ++id_;
            }
        }
        return std::move(packed_);
    }

private:
    void add(const Placement& placement, const Triangle& triangle) {
        if (needs_.normals) put(packed_.offsets.x, normals(placement, triangle));
        if (needs_.tangents) put(packed_.offsets.y, tangents(placement, triangle));
        if (needs_.colors) put(packed_.offsets.z, colors(placement, triangle));
        std::uint32_t section = packed_.offsets.w;
        for (const std::uint32_t set : needs_.uvSets) {
            put(section, uvs(placement, triangle, set));
            section += static_cast<std::uint32_t>(indexOfId_.size()) * shared::kUvWords;
        }
    }

    template <typename Record> void put(std::uint32_t section, const Record& record) {
        constexpr std::size_t kWords = sizeof(Record) / sizeof(glm::vec4);
        std::memcpy(&packed_.words[section + indexOfId_[id_] * kWords], &record, sizeof(Record));
    }

    const Scene& scene_;
    const AttributeNeeds& needs_;
    std::vector<std::uint32_t> indexOfId_;
    PackedAttributes packed_;
    std::uint32_t id_ = 0;
};

} // namespace

PackedAttributes packAttributes(const Scene& scene, const AttributeNeeds& needs, std::span<const std::uint32_t> order) {
    return AttributePacker(scene, needs, order).pack();
}

} // namespace isolux
