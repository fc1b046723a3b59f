#include "accel/bvh.h"

#include "accel/bvh_split.h"

#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>

namespace isolux {
namespace {

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
        const NodePrimitives primitives{boxes_, std::span(order_).subspan(begin, end - begin)};
        const NodeBounds bounds = boundsOf(primitives);
        SparseNode& node = sparse_[slot];
        node = {bounds.boxes, begin, end, split(primitives, bounds, depth)};
        if (node.leftCount == 0) return;
        const std::uint32_t middle = begin + node.leftCount;
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

    /// How many primitives go to the left child; 0 for a leaf.
    [[nodiscard]] std::uint32_t split(const NodePrimitives& node, const NodeBounds& bounds, std::uint32_t depth) const {
        const auto count = static_cast<std::uint32_t>(node.order.size());
        const bool leafAllowed = count <= options_.maxLeafSize;
        const bool divideLeaves = options_.split == SplitMethod::surfaceArea;
        if (count == 1 || (leafAllowed && !divideLeaves)) return 0;
        const std::uint32_t levelsToHalve = static_cast<std::uint32_t>(std::bit_width(count - 1));
        const bool mustHalve = depth + 1 + levelsToHalve >= depthLimit_;
        const std::uint32_t left = mustHalve ? 0 : splitByMethod(node, bounds);
        return left > 0 || leafAllowed ? left : splitInHalves(node, bounds);
    }

    [[nodiscard]] std::uint32_t splitByMethod(const NodePrimitives& node, const NodeBounds& bounds) const {
        switch (options_.split) {
        case SplitMethod::surfaceArea: return splitBySurfaceArea(node, bounds, options_);
        case SplitMethod::mean: return splitAtMean(node);
        }
        return 0;
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
