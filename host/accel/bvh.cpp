#include "accel/bvh.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <array>
#include <bit>
#include <cassert>
#include <numeric>

namespace isolux {
namespace {

constexpr std::uint32_t kMaxBins = 32;
constexpr std::uint32_t kParallelThreshold = 4096; // primitives below which a task costs more than it gains

struct Bin {
    Box3f bounds;
    std::uint32_t count = 0;
};
using Bins = std::array<std::array<Bin, kMaxBins>, 3>;

/// Bounds of a node's boxes and of their centres. Minimum and maximum are exact, so any order gives the same bits.
struct NodeBounds {
    Box3f boxes;
    Box3f centers;
};

struct Split {
    int axis = -1; ///< -1: none found
    std::uint32_t bin = 0;
    float cost = std::numeric_limits<float>::infinity();
};

class Builder {
public:
    Builder(std::span<const Box3f> boxes, const BvhOptions& options) : boxes_(boxes), options_(options) {
        assert(options.binCount >= 2 && options.binCount <= kMaxBins && options.maxLeafSize >= 1);
        const auto count = static_cast<std::uint32_t>(boxes.size());
        const std::uint32_t balancedDepth = 2 + static_cast<std::uint32_t>(std::bit_width(count));
        depthLimit_ = std::max(options.maxDepth, balancedDepth);
        order_.resize(count);
        std::iota(order_.begin(), order_.end(), 0u);
        // A subtree over n primitives has at most 2n - 1 nodes, so every subtree knows its own range of slots in
        // advance and the layout cannot depend on which thread was first.
        sparse_.resize(2 * std::size_t{count});
    }

    Bvh build() {
        buildSubtree(0, 0, static_cast<std::uint32_t>(order_.size()), 1);
        return compact();
    }

private:
    /// A node while building: children are slot + 1 and slot + 2 * leftCount, where leftCount is the split position.
    struct SparseNode {
        Box3f bounds;
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
        std::uint32_t leftCount = 0; ///< 0: leaf
    };

    void buildSubtree(std::size_t slot, std::uint32_t begin, std::uint32_t end, std::uint32_t depth) {
        const NodeBounds bounds = computeBounds(begin, end);
        SparseNode& node = sparse_[slot];
        node = {bounds.boxes, begin, end, 0};
        const std::uint32_t middle = chooseMiddle(bounds, begin, end, depth);
        if (middle == begin) return;
        node.leftCount = middle - begin;
        const std::size_t left = slot + 1;
        const std::size_t right = slot + 2 * std::size_t{node.leftCount};
        const auto buildLeft = [&] { buildSubtree(left, begin, middle, depth + 1); };
        const auto buildRight = [&] { buildSubtree(right, middle, end, depth + 1); };
        if (end - begin > kParallelThreshold) {
            tbb::parallel_invoke(buildLeft, buildRight);
        } else {
            buildLeft();
            buildRight();
        }
    }

    NodeBounds computeBounds(std::uint32_t begin, std::uint32_t end) const {
        const auto accumulate = [&](const tbb::blocked_range<std::uint32_t>& range, NodeBounds bounds) {
            for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
                bounds.boxes.extend(boxes_[order_[i]]);
                bounds.centers.extend(boxes_[order_[i]].center());
            }
            return bounds;
        };
        const auto join = [](NodeBounds a, const NodeBounds& b) {
            a.boxes.extend(b.boxes);
            a.centers.extend(b.centers);
            return a;
        };
        const tbb::blocked_range<std::uint32_t> range(begin, end, kParallelThreshold);
        if (end - begin <= kParallelThreshold) return accumulate(range, {});
        return tbb::parallel_reduce(range, NodeBounds{}, accumulate, join);
    }

    /// Where to split [begin, end), which is partitioned accordingly; `begin` for a leaf.
    std::uint32_t chooseMiddle(const NodeBounds& bounds, std::uint32_t begin, std::uint32_t end, std::uint32_t depth) {
        const std::uint32_t count = end - begin;
        if (count == 1) return begin;
        const std::uint32_t levelsToHalve = static_cast<std::uint32_t>(std::bit_width(count - 1));
        const bool mustHalve = depth + 1 + levelsToHalve >= depthLimit_;
        const Split split = mustHalve ? Split{} : findSplit(bounds, begin, end);
        const float leafCost = static_cast<float>(count);
        const bool leafAllowed = count <= options_.maxLeafSize;
        if (split.axis < 0) return leafAllowed ? begin : halve(bounds, begin, end);
        if (leafAllowed && split.cost >= leafCost) return begin;
        const auto middle = std::partition(order_.begin() + begin, order_.begin() + end, [&](std::uint32_t primitive) {
            return binOf(boxes_[primitive].center(), bounds.centers, split.axis) <= split.bin;
        });
        return static_cast<std::uint32_t>(middle - order_.begin());
    }

    std::uint32_t binOf(const Vec3f& center, const Box3f& centers, int axis) const {
        const float extent = centers.upper[axis] - centers.lower[axis];
        const float position = (center[axis] - centers.lower[axis]) / extent * static_cast<float>(options_.binCount);
        return std::min(static_cast<std::uint32_t>(position), options_.binCount - 1);
    }

    Bins fillBins(const NodeBounds& bounds, std::uint32_t begin, std::uint32_t end) const {
        const auto accumulate = [&](const tbb::blocked_range<std::uint32_t>& range, Bins bins) {
            for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
                const Box3f& box = boxes_[order_[i]];
                const Vec3f center = box.center();
                for (int axis = 0; axis < 3; ++axis) {
                    if (!splittable(bounds.centers, axis)) continue;
                    Bin& bin = bins[static_cast<std::size_t>(axis)][binOf(center, bounds.centers, axis)];
                    bin.bounds.extend(box);
                    ++bin.count;
                }
            }
            return bins;
        };
        const auto join = [](Bins a, const Bins& b) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (std::size_t i = 0; i < kMaxBins; ++i) {
                    a[axis][i].bounds.extend(b[axis][i].bounds);
                    a[axis][i].count += b[axis][i].count;
                }
            return a;
        };
        const tbb::blocked_range<std::uint32_t> range(begin, end, kParallelThreshold);
        if (end - begin <= kParallelThreshold) return accumulate(range, {});
        return tbb::parallel_reduce(range, Bins{}, accumulate, join);
    }

    /// Bins need an extent whose reciprocal is finite.
    static bool splittable(const Box3f& centers, int axis) {
        return centers.upper[axis] - centers.lower[axis] > std::numeric_limits<float>::min();
    }

    Split findSplit(const NodeBounds& bounds, std::uint32_t begin, std::uint32_t end) const {
        const Bins bins = fillBins(bounds, begin, end);
        Split best;
        const float parentArea = bounds.boxes.halfArea();
        for (int axis = 0; axis < 3; ++axis)
            if (splittable(bounds.centers, axis)) sweep(bins[static_cast<std::size_t>(axis)], axis, best);
        // A flat or point-like node has no area to compare by: any split is as good as another.
        if (best.axis >= 0) best.cost = parentArea > 0.0f ? 1.0f + best.cost / parentArea : 1.0f;
        return best;
    }

    /// Cost (area times count, both sides) of splitting after each bin; keeps the least over all axes.
    void sweep(const std::array<Bin, kMaxBins>& bins, int axis, Split& best) const {
        std::array<float, kMaxBins> rightCost{};
        Bin right;
        for (std::uint32_t i = options_.binCount - 1; i > 0; --i) {
            right.bounds.extend(bins[i].bounds);
            right.count += bins[i].count;
            rightCost[i] = right.count == 0 ? std::numeric_limits<float>::infinity()
                                            : right.bounds.halfArea() * static_cast<float>(right.count);
        }
        Bin left;
        for (std::uint32_t i = 0; i + 1 < options_.binCount; ++i) {
            left.bounds.extend(bins[i].bounds);
            left.count += bins[i].count;
            if (left.count == 0) continue;
            const float cost = left.bounds.halfArea() * static_cast<float>(left.count) + rightCost[i + 1];
            if (cost < best.cost) best = {axis, i, cost};
        }
    }

    /// Two equal halves along the longest axis of the centres: always possible, even if all centres are equal.
    std::uint32_t halve(const NodeBounds& bounds, std::uint32_t begin, std::uint32_t end) {
        const Vec3f extent = bounds.centers.extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const float centerA = boxes_[a].center()[axis];
                             const float centerB = boxes_[b].center()[axis];
                             return centerA != centerB ? centerA < centerB : a < b;
                         });
        return middle;
    }

    /// Copies the used slots to neighbouring pairs, in depth-first order.
    Bvh compact() {
        Bvh bvh;
        bvh.primitives = std::move(order_);
        bvh.nodes.reserve(sparse_.size());
        bvh.nodes.resize(1);
        struct Task {
            std::size_t slot;
            std::uint32_t node;
            std::uint32_t depth;
        };
        std::vector<Task> tasks{{0, 0, 1}};
        while (!tasks.empty()) {
            const Task task = tasks.back();
            tasks.pop_back();
            const SparseNode& sparse = sparse_[task.slot];
            bvh.depth = std::max(bvh.depth, task.depth);
            if (sparse.leftCount == 0) {
                bvh.nodes[task.node] = {sparse.bounds, sparse.begin, sparse.end - sparse.begin};
                continue;
            }
            const auto children = static_cast<std::uint32_t>(bvh.nodes.size());
            bvh.nodes[task.node] = {sparse.bounds, children, 0};
            bvh.nodes.resize(bvh.nodes.size() + 2);
            tasks.push_back({task.slot + 2 * std::size_t{sparse.leftCount}, children + 1, task.depth + 1});
            tasks.push_back({task.slot + 1, children, task.depth + 1});
        }
        bvh.nodes.shrink_to_fit();
        return bvh;
    }

    std::span<const Box3f> boxes_;
    BvhOptions options_;
    std::uint32_t depthLimit_ = 0;
    std::vector<std::uint32_t> order_;
    std::vector<SparseNode> sparse_;
};

} // namespace

Bvh buildBvh(std::span<const Box3f> boxes, const BvhOptions& options) {
    if (boxes.empty()) return {};
    return Builder(boxes, options).build();
}

BvhStatistics statistics(const Bvh& bvh) {
    BvhStatistics result;
    result.nodeCount = bvh.nodes.size();
    result.depth = bvh.depth;
    if (bvh.nodes.empty()) return result;
    const double rootArea = bvh.nodes.front().bounds.halfArea();
    for (const Bvh::Node& node : bvh.nodes) {
        const double weight = rootArea > 0.0 ? node.bounds.halfArea() / rootArea : 1.0;
        result.sahCost += weight * (node.isLeaf() ? node.count : 1.0);
        if (node.isLeaf()) ++result.leafCount;
    }
    result.meanLeafSize = static_cast<double>(bvh.primitives.size()) / static_cast<double>(result.leafCount);
    return result;
}

} // namespace isolux
