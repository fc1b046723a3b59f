#include "pack/coincident.h"

#include "pack/flat_triangle.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <optional>
#include <vector>

namespace isolux {
namespace {

constexpr std::uint32_t kLeafSize = 4; ///< triangles a leaf

/// A triangle's place on the Z curve (Morton 1966).
struct Placed {
    std::uint64_t code;
    std::uint32_t index;

    friend bool operator<(const Placed& a, const Placed& b) {
        return a.code != b.code ? a.code < b.code : a.index < b.index;
    }
};

/// Two zero bits before each of the lower 21.
std::uint64_t spread(std::uint64_t bits) {
    bits = (bits | bits << 32) & 0x1F00000000FFFFull;
    bits = (bits | bits << 16) & 0x1F0000FF0000FFull;
    bits = (bits | bits << 8) & 0x100F00F00F00F00Full;
    bits = (bits | bits << 4) & 0x10C30C30C30C30C3ull;
    return (bits | bits << 2) & 0x1249249249249249ull;
}

/// Of a point of device space.
std::uint64_t mortonCode(const Vec3f& point) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float cell = std::clamp((point[axis] + 1.0f) * 0x1p20f, 0.0f, 0x1p21f - 1.0f);
        code |= spread(static_cast<std::uint64_t>(cell)) << axis;
    }
    return code;
}

bool overlap(const Box3f& a, const Box3f& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

struct Pair { ///< nodes of one level, a <= b
    std::uint32_t a;
    std::uint32_t b;
};

/// Triangles in the order of the Z curve under a complete binary tree of boxes, and the pairs of them that touch.
class Search {
public:
    explicit Search(std::span<const TriangleCorners> triangles) {
        const std::vector<Placed> order = arrange(triangles);
        flat_.resize(order.size());
        indices_.resize(order.size());
        boxes_.resize(order.size());
        tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) {
            indices_[i] = order[i].index;
            flat_[i] = flatten(triangles[indices_[i]]);
            boxes_[i] = flat_[i].box();
        });
        buildTree();
    }

    /// The result of the first part of the search that has one, whichever thread was first.
    [[nodiscard]] CoincidentTriangles run() const {
        const std::vector<Pair> parts = divide();
        std::vector<CoincidentTriangles> results(parts.size());
        std::atomic<std::size_t> end = parts.size(); // what comes later cannot be the first
        tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
            if (i >= end) return;
            results[i] = searchPart(parts[i]);
            if (results[i].outcome == Coincidence::none) return;
            std::size_t previous = end;
            while (i < previous && !end.compare_exchange_weak(previous, i)) {
            }
        });
        return end < parts.size() ? results[end] : CoincidentTriangles{};
    }

private:
    static std::vector<Placed> arrange(std::span<const TriangleCorners> triangles) {
        std::vector<Placed> order;
        order.reserve(triangles.size());
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            const TriangleCorners& t = triangles[i];
            if (hasArea(t)) order.push_back({mortonCode((t[0] + t[1] + t[2]) * (1.0f / 3.0f)), i});
        }
        tbb::parallel_sort(order.begin(), order.end());
        return order;
    }

    /// Node n has the children 2n and 2n + 1; those from `leaves_` on are leaves, the last of them empty.
    void buildTree() {
        const std::size_t used = (flat_.size() + kLeafSize - 1) / kLeafSize;
        leaves_ = static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(used, 1)));
        nodes_.resize(2 * std::size_t{leaves_});
        for (std::size_t i = 0; i < boxes_.size(); ++i) nodes_[leaves_ + i / kLeafSize].extend(boxes_[i]);
        for (std::uint32_t node = leaves_ - 1; node > 0; --node) {
            nodes_[node] = nodes_[2 * node];
            nodes_[node].extend(nodes_[2 * node + 1]);
        }
    }

    /// Pairs of nodes under which all pairs of triangles are that touch: parts that threads may share.
    [[nodiscard]] std::vector<Pair> divide() const {
        constexpr std::size_t kParts = 64;
        std::vector<Pair> parts{{1, 1}};
        while (!parts.empty() && parts.size() < kParts && parts.front().a < leaves_) {
            std::vector<Pair> smaller;
            for (const Pair& pair : parts) descend(pair, smaller);
            parts = std::move(smaller);
        }
        return parts;
    }

    [[nodiscard]] CoincidentTriangles searchPart(const Pair& part) const {
        std::vector<Pair> pairs{part};
        for (std::uint64_t budget = kVisits * (leaves_ + 64); !pairs.empty(); --budget) {
            if (budget == 0) return {Coincidence::unknown};
            const Pair pair = pairs.back();
            pairs.pop_back();
            if (pair.a < leaves_) {
                descend(pair, pairs);
            } else if (const auto found = compare(pair)) {
                return {Coincidence::found, *found};
            }
        }
        return {};
    }

    void descend(const Pair& pair, std::vector<Pair>& pairs) const {
        for (const std::uint32_t a : {2 * pair.a, 2 * pair.a + 1})
            for (const std::uint32_t b : {2 * pair.b, 2 * pair.b + 1})
                if (a <= b && overlap(nodes_[a], nodes_[b])) pairs.push_back({a, b});
    }

    struct Range {
        std::size_t first;
        std::size_t end;
    };

    [[nodiscard]] Range trianglesOf(std::uint32_t leaf) const {
        const std::size_t first = std::size_t{leaf - leaves_} * kLeafSize;
        return {first, std::min(first + kLeafSize, boxes_.size())};
    }

    /// Two triangles at the same spot that are in two leaves, or in one.
    [[nodiscard]] std::optional<std::array<std::uint32_t, 2>> compare(const Pair& pair) const {
        const Range a = trianglesOf(pair.a);
        const Range b = trianglesOf(pair.b);
        for (std::size_t i = a.first; i < a.end; ++i) {
            if (!overlap(boxes_[i], nodes_[pair.b])) continue;
            for (std::size_t j = std::max(b.first, i + 1); j < b.end; ++j)
                if (overlap(boxes_[i], boxes_[j]) && coincide(flat_[i], flat_[j]))
                    return std::array{std::min(indices_[i], indices_[j]), std::max(indices_[i], indices_[j])};
        }
        return std::nullopt;
    }

    /// Pairs of nodes that are looked at in a part, for each leaf, before the search gives up. A closed surface has
    /// less than 1; more than a few are only there where large triangles lie across many others.
    static constexpr std::uint64_t kVisits = 8;

    std::vector<FlatTriangle> flat_;
    std::vector<std::uint32_t> indices_; ///< of the caller's
    std::vector<Box3f> boxes_;
    std::vector<Box3f> nodes_;
    std::uint32_t leaves_ = 1;
};

} // namespace

CoincidentTriangles findCoincident(std::span<const TriangleCorners> triangles) { return Search(triangles).run(); }

} // namespace isolux
