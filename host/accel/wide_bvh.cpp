#include "accel/wide_bvh.h"

#include <cassert>
#include <cmath>

namespace isolux {
namespace {

constexpr int kMinExponent = -126; // 2^e and every q * 2^e stay normal floats
constexpr int kMaxExponent = 119;  // 255 * 2^e stays finite

/// Up to four descendants of a binary node: the inner one of largest area is opened until the slots are full.
std::vector<std::uint32_t> gatherChildren(const Bvh& bvh, std::uint32_t root) {
    const Bvh::Node& node = bvh.nodes[root];
    if (node.isLeaf()) return {root};
    std::vector<std::uint32_t> children{node.first, node.first + 1};
    while (children.size() < WideNode::kWidth) {
        auto widest = children.end();
        for (auto it = children.begin(); it != children.end(); ++it) {
            if (bvh.nodes[*it].isLeaf()) continue;
            if (widest == children.end() || bvh.nodes[*it].bounds.halfArea() > bvh.nodes[*widest].bounds.halfArea())
                widest = it;
        }
        if (widest == children.end()) break;
        const std::uint32_t opened = bvh.nodes[*widest].first;
        *widest = opened;
        children.push_back(opened + 1);
    }
    return children;
}

float decode(float origin, std::uint8_t q, int exponent) {
    return origin + std::ldexp(static_cast<float>(q), exponent);
}

/// Largest q whose decoded value is at most `bound`, with a unit in the last place to spare; 0 is exact.
std::uint8_t quantizeLower(float origin, int exponent, float bound) {
    double q = std::floor(std::ldexp(static_cast<double>(bound) - origin, -exponent));
    q = std::min(q, 255.0);
    while (q > 0.0) {
        const float decoded = decode(origin, static_cast<std::uint8_t>(q), exponent);
        if (std::nextafter(decoded, std::numeric_limits<float>::infinity()) <= bound) break;
        q -= 1.0;
    }
    return static_cast<std::uint8_t>(std::max(q, 0.0));
}

/// Smallest q whose decoded value is at least `bound`, with a unit to spare; more than 255 if there is none.
int quantizeUpper(float origin, int exponent, float bound) {
    double q = std::ceil(std::ldexp(static_cast<double>(bound) - origin, -exponent));
    q = std::max(q, 0.0);
    while (q <= 255.0) {
        const float decoded = decode(origin, static_cast<std::uint8_t>(q), exponent);
        if (std::nextafter(decoded, -std::numeric_limits<float>::infinity()) >= bound) break;
        q += 1.0;
    }
    return q > 255.0 ? 256 : static_cast<int>(q);
}

/// The finest exponent whose 255 steps cover [origin, upper].
int chooseExponent(float origin, float upper) {
    // Steps finer than the coordinates' own would decode to the same numbers.
    const double resolution = std::ldexp(std::max(std::abs(origin), std::abs(upper)), -24);
    const double extent = std::max(static_cast<double>(upper) - origin, resolution);
    int exponent = extent > 0.0 ? std::ilogb(extent / 255.0) : kMinExponent;
    exponent = std::max(exponent, kMinExponent);
    while (exponent < kMaxExponent && quantizeUpper(origin, exponent, upper) > 255) ++exponent;
    return exponent;
}

void quantizeChildren(WideNode& wide, const Bvh& bvh, const std::vector<std::uint32_t>& children) {
    Box3f bounds;
    for (const std::uint32_t child : children) bounds.extend(bvh.nodes[child].bounds);
    wide.origin = bounds.lower;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const int exponent = chooseExponent(wide.origin[axis], bounds.upper[axis]);
        wide.exponent[a] = static_cast<std::int8_t>(exponent);
        for (std::size_t i = 0; i < children.size(); ++i) {
            const Box3f& box = bvh.nodes[children[i]].bounds;
            wide.lower[a][i] = quantizeLower(wide.origin[axis], exponent, box.lower[axis]);
            wide.upper[a][i] = static_cast<std::uint8_t>(quantizeUpper(wide.origin[axis], exponent, box.upper[axis]));
        }
    }
}

/// Entries a depth-first walk may hold: a node's children wait while one of them is walked.
std::uint32_t computeStackBound(const WideBvh& wide) {
    std::vector<std::uint32_t> need(wide.nodes.size(), 1);
    for (std::size_t i = wide.nodes.size(); i-- > 0;) {
        std::uint32_t childCount = 0;
        std::uint32_t deepest = 1;
        for (const WideChild child : wide.nodes[i].children) {
            if (child.isEmpty()) continue;
            ++childCount;
            if (!child.isLeaf()) deepest = std::max(deepest, need[child.node()]);
        }
        need[i] = childCount - 1 + deepest;
    }
    return need.empty() ? 1 : need.front();
}

} // namespace

WideChild WideChild::inner(std::uint32_t node) {
    assert((node & kLeafBit) == 0);
    return WideChild(node);
}

WideChild WideChild::leaf(std::uint32_t first, std::uint32_t count) {
    assert(count >= 1 && count <= kMaxCount && first < kMaxFirst);
    return WideChild(kLeafBit | ((count - 1) << kCountShift) | first);
}

Box3f WideNode::childBounds(int child) const {
    Box3f box;
    const auto c = static_cast<std::size_t>(child);
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        box.lower[axis] = decode(origin[axis], lower[a][c], exponent[a]);
        box.upper[axis] = decode(origin[axis], upper[a][c], exponent[a]);
    }
    return box;
}

WideBvh buildWideBvh(const Bvh& bvh) {
    WideBvh wide;
    wide.primitives = bvh.primitives;
    if (bvh.nodes.empty()) return wide;
    struct Task {
        std::uint32_t binary;
        std::uint32_t node;
    };
    wide.nodes.resize(1);
    std::vector<Task> tasks{{0, 0}};
    while (!tasks.empty()) {
        const Task task = tasks.back();
        tasks.pop_back();
        const std::vector<std::uint32_t> children = gatherChildren(bvh, task.binary);
        WideNode node;
        quantizeChildren(node, bvh, children);
        for (std::size_t i = 0; i < children.size(); ++i) {
            const Bvh::Node& child = bvh.nodes[children[i]];
            if (child.isLeaf()) {
                node.children[i] = WideChild::leaf(child.first, child.count);
                continue;
            }
            const auto slot = static_cast<std::uint32_t>(wide.nodes.size());
            node.children[i] = WideChild::inner(slot);
            wide.nodes.emplace_back();
            tasks.push_back({children[i], slot});
        }
        wide.nodes[task.node] = node;
    }
    wide.stackBound = computeStackBound(wide);
    return wide;
}

} // namespace isolux
