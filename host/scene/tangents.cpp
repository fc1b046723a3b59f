#include "scene/tangents.h"

#include <array>
#include <bit>
#include <numeric>

namespace isolux {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

/// A triangle's corner: 3 * triangle + 0, 1 or 2.
using Corner = std::uint32_t;
Corner nextCorner(Corner corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
Corner previousCorner(Corner corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

/// Orientations keep triangles apart whose texture is mirrored. Those without area in the texture join either side.
enum class Orientation : std::uint8_t { preserving, mirroring, any };

/// Where the texture's u grows on a triangle, and which way round its coordinates run.
struct Face {
    Vec3d tangent{0.0};
    Orientation orientation = Orientation::any;
    bool degenerate = false; ///< two of its corners are at one place
};

Vec3d unitOrZero(const Vec3d& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : Vec3d(0.0);
}

Vec3d projected(const Vec3d& v, const Vec3d& normal) { return unitOrZero(v - normal * glm::dot(normal, v)); }

/// Numbers each of `keys` by the first that equals it.
std::vector<std::uint32_t> firstEquals(const std::vector<std::array<std::uint32_t, 8>>& keys) {
    std::vector<std::uint32_t> order(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
    std::vector<std::uint32_t> first(keys.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool repeats = i > 0 && keys[order[i]] == keys[order[i - 1]];
        first[order[i]] = repeats ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// An edge of a triangle, from a corner to the next; `low` and `high` are the welded vertices at its ends.
struct Edge {
    std::uint32_t low;
    std::uint32_t high;
    Corner corner;
    bool upwards; ///< runs from low to high
};

class TangentGenerator {
public:
    TangentGenerator(const Mesh& mesh, std::uint32_t uvSet) : mesh_(mesh), uvs_(mesh.uvs[uvSet]) {}

    /// The tangent of every corner.
    std::vector<glm::vec4> generate() {
        weldCorners();
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) faces_.push_back(measure(3 * i));
        joinEdges();
        groupCorners();
        const std::vector<glm::vec4> ofGroups = averageGroups();
        std::vector<glm::vec4> tangents(welded_.size(), glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
        for (Corner corner = 0; corner < tangents.size(); ++corner)
            if (groups_[corner] != kNone) tangents[corner] = ofGroups[groups_[corner]];
        lendToDegenerate(tangents);
        return tangents;
    }

private:
    [[nodiscard]] std::uint32_t vertex(Corner corner) const { return mesh_.triangles[corner / 3][corner % 3]; }
    [[nodiscard]] Vec3d position(Corner corner) const { return Vec3d(mesh_.positions[vertex(corner)]); }

    [[nodiscard]] Vec3d normal(Corner corner) const {
        if (!mesh_.normals.empty()) return unitOrZero(Vec3d(mesh_.normals[vertex(corner)]));
        const Corner first = corner - corner % 3;
        const Vec3d p0 = position(first);
        return unitOrZero(glm::cross(position(first + 1) - p0, position(first + 2) - p0));
    }

    /// Corners alike in position, normal and coordinates are one vertex, however the file indexes them.
    void weldCorners() {
        std::vector<std::array<std::uint32_t, 8>> keys(3 * mesh_.triangles.size());
        for (Corner corner = 0; corner < keys.size(); ++corner) {
            const Vec3f p = mesh_.positions[vertex(corner)];
            const Vec3f n = mesh_.normals.empty() ? Vec3f(normal(corner)) : mesh_.normals[vertex(corner)];
            const Vec2<float> uv = uvs_[vertex(corner)];
            const std::array<float, 8> numbers{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
            // Bits are ordered even where numbers are none; adding 0 makes -0 and 0 alike.
            for (int i = 0; i < 8; ++i) keys[corner][i] = std::bit_cast<std::uint32_t>(numbers[i] + 0.0f);
        }
        welded_ = firstEquals(keys);
    }

    [[nodiscard]] Face measure(Corner corner) const {
        const Vec3d e1 = position(corner + 1) - position(corner);
        const Vec3d e2 = position(corner + 2) - position(corner);
        Face face;
        face.degenerate = e1 == Vec3d(0.0) || e2 == Vec3d(0.0) || e1 == e2;
        const Vec2d origin(uvs_[vertex(corner)]);
        const Vec2d d1 = Vec2d(uvs_[vertex(corner + 1)]) - origin;
        const Vec2d d2 = Vec2d(uvs_[vertex(corner + 2)]) - origin;
        const double area = d1.x * d2.y - d2.x * d1.y;
        // The gradient of u on the triangle; coordinates that are no numbers have none.
        face.tangent = unitOrZero((e1 * d2.y - e2 * d1.y) * (area < 0.0 ? -1.0 : 1.0));
        if (std::abs(area) > 0.0 && glm::length(face.tangent) > 0.0)
            face.orientation = area > 0.0 ? Orientation::preserving : Orientation::mirroring;
        return face;
    }

    [[nodiscard]] std::vector<Edge> sortedEdges() const {
        std::vector<Edge> edges;
        edges.reserve(welded_.size());
        for (Corner corner = 0; corner < welded_.size(); ++corner) {
            if (faces_[corner / 3].degenerate) continue;
            const std::uint32_t from = welded_[corner];
            const std::uint32_t to = welded_[nextCorner(corner)];
            edges.push_back({std::min(from, to), std::max(from, to), corner, from < to});
        }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            if (a.low != b.low) return a.low < b.low;
            return a.high != b.high ? a.high < b.high : a.corner < b.corner;
        });
        return edges;
    }

    /// Each edge joins two triangles that run along it in opposite ways; of many, the earliest that wait.
    void joinEdges() {
        across_.assign(welded_.size(), kNone);
        const std::vector<Edge> edges = sortedEdges();
        for (std::size_t begin = 0, waiting = 0, i = 0; i < edges.size(); ++i) {
            if (edges[i].low != edges[begin].low || edges[i].high != edges[begin].high) begin = waiting = i;
            while (waiting < i && across_[edges[waiting].corner] != kNone) ++waiting;
            if (waiting == i || edges[waiting].upwards == edges[i].upwards) continue;
            across_[edges[waiting].corner] = edges[i].corner;
            across_[edges[i].corner] = edges[waiting].corner;
        }
    }

    /// Groups the corners about each vertex that edges connect and whose triangles have the same orientation.
    void groupCorners() {
        groups_.assign(welded_.size(), kNone);
        for (const Face& face : faces_) followed_.push_back(face.orientation);
        for (Corner corner = 0; corner < welded_.size(); ++corner) {
            const Face& face = faces_[corner / 3];
            if (face.degenerate || face.orientation == Orientation::any || groups_[corner] != kNone) continue;
            fillGroup(corner, face.orientation);
        }
    }

    void fillGroup(Corner start, Orientation orientation) {
        const auto group = static_cast<std::uint32_t>(orientations_.size());
        orientations_.push_back(orientation);
        pending_.assign(1, start);
        while (!pending_.empty()) {
            const Corner corner = pending_.back();
            pending_.pop_back();
            if (!mayJoin(corner, orientation)) continue;
            groups_[corner] = group;
            // A neighbour runs along the edge in the opposite way: across the edge that arrives at the vertex its
            // corner is where it leaves, across the one that leaves the next.
            const Corner arriving = across_[previousCorner(corner)];
            const Corner leaving = across_[corner];
            if (arriving != kNone) pending_.push_back(arriving);
            if (leaving != kNone) pending_.push_back(nextCorner(leaving));
        }
    }

    /// A triangle without area in the texture follows the first group that reaches it, in all its corners.
    bool mayJoin(Corner corner, Orientation orientation) {
        if (groups_[corner] != kNone) return false;
        Orientation& followed = followed_[corner / 3];
        if (followed == Orientation::any) followed = orientation;
        return followed == orientation;
    }

    /// Mean of the group's tangents in the plane of the normal, by the angles of the triangles at the vertex.
    [[nodiscard]] std::vector<glm::vec4> averageGroups() const {
        std::vector<Vec3d> sums(orientations_.size(), Vec3d(0.0));
        for (Corner corner = 0; corner < groups_.size(); ++corner)
            if (groups_[corner] != kNone) sums[groups_[corner]] += weightedTangent(corner);
        std::vector<glm::vec4> tangents;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            // v grows downwards in the image: where the coordinates run as the triangle does, the bitangent that
            // points up is the opposite of cross(normal, tangent).
            const float sign = orientations_[i] == Orientation::preserving ? -1.0f : 1.0f;
            tangents.emplace_back(Vec3f(unitOrZero(sums[i])), sign);
        }
        return tangents;
    }

    [[nodiscard]] Vec3d weightedTangent(Corner corner) const {
        const Vec3d n = normal(corner);
        const Vec3d back = projected(position(previousCorner(corner)) - position(corner), n);
        const Vec3d ahead = projected(position(nextCorner(corner)) - position(corner), n);
        const double angle = std::acos(std::clamp(glm::dot(back, ahead), -1.0, 1.0));
        return angle * projected(faces_[corner / 3].tangent, n);
    }

    /// Triangles with two corners at one place take part in nothing; they look like what is around them.
    void lendToDegenerate(std::vector<glm::vec4>& tangents) const {
        std::vector<Corner> lender(welded_.size(), kNone);
        for (Corner corner = 0; corner < welded_.size(); ++corner)
            if (!faces_[corner / 3].degenerate && lender[welded_[corner]] == kNone) lender[welded_[corner]] = corner;
        for (Corner corner = 0; corner < welded_.size(); ++corner)
            if (faces_[corner / 3].degenerate && lender[welded_[corner]] != kNone)
                tangents[corner] = tangents[lender[welded_[corner]]];
    }

    const Mesh& mesh_;
    const std::vector<Vec2<float>>& uvs_;
    std::vector<std::uint32_t> welded_; ///< corner -> the first corner that is the same vertex
    std::vector<Face> faces_;
    std::vector<Orientation> followed_;     ///< by face: its orientation, or that of the group which it follows
    std::vector<Corner> across_;            ///< corner -> the corner from which its edge runs back in the neighbour
    std::vector<std::uint32_t> groups_;     ///< corner -> group
    std::vector<Orientation> orientations_; ///< of the groups
    std::vector<Corner> pending_;           ///< of fillGroup; kept for its memory
};

/// Copies vertices whose corners need different tangents, and puts the tangents in.
class VertexSplitter {
public:
    explicit VertexSplitter(Mesh& mesh) : mesh_(mesh), next_(mesh.positions.size(), kUnused) {
        mesh_.tangents.assign(mesh_.positions.size(), glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
    }

    void split(const std::vector<glm::vec4>& tangents) {
        for (Corner corner = 0; corner < tangents.size(); ++corner) {
            std::uint32_t& vertex = mesh_.triangles[corner / 3][corner % 3];
            vertex = withTangent(vertex, tangents[corner]);
        }
    }

private:
    static constexpr std::uint32_t kUnused = kNone - 1; ///< no corner has come for the vertex yet

    /// The vertex itself, or its copy with this tangent.
    std::uint32_t withTangent(std::uint32_t vertex, const glm::vec4& tangent) {
        if (next_[vertex] == kUnused) {
            mesh_.tangents[vertex] = tangent;
            next_[vertex] = kNone;
            return vertex;
        }
        while (mesh_.tangents[vertex] != tangent) {
            if (next_[vertex] == kNone) {
                const std::uint32_t made = copy(vertex, tangent);
                next_[vertex] = made;
                return made;
            }
            vertex = next_[vertex];
        }
        return vertex;
    }

    std::uint32_t copy(std::uint32_t vertex, const glm::vec4& tangent) {
        const auto made = static_cast<std::uint32_t>(mesh_.positions.size());
        const auto repeat = [vertex](auto& attribute) {
            if (!attribute.empty()) attribute.push_back(attribute[vertex]);
        };
        repeat(mesh_.positions);
        repeat(mesh_.normals);
        for (auto& uvs : mesh_.uvs) repeat(uvs);
        repeat(mesh_.colors);
        mesh_.tangents.push_back(tangent);
        next_.push_back(kNone);
        return made;
    }

    Mesh& mesh_;
    std::vector<std::uint32_t> next_; ///< vertex -> its next copy
};

} // namespace

void generateTangents(Mesh& mesh, std::uint32_t uvSet) {
    const std::vector<glm::vec4> tangents = TangentGenerator(mesh, uvSet).generate();
    VertexSplitter(mesh).split(tangents);
}

} // namespace isolux
