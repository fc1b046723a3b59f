#include "accel/bvh_split.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>

namespace isolux {
namespace {

struct Bin {
    Box3f bounds;
    std::uint32_t count = 0;
};
using Bins = std::array<std::array<Bin, kMaxBins>, 3>;

struct BinSplit {
    int axis = -1; ///< -1: none found
    std::uint32_t bin = 0;
    float cost = std::numeric_limits<float>::infinity();
};

/// `take(result, primitive)` for each of a node's primitives. Large nodes are cut at places that depend on their size
/// alone, and their parts joined in one order, so that sums round alike whatever the number of threads.
template <typename Result, typename Take, typename Join>
Result gather(const NodePrimitives& node, const Take& take, const Join& join) {
    const auto accumulate = [&](const tbb::blocked_range<std::size_t>& range, Result result) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) take(result, node.boxes[node.order[i]]);
        return result;
    };
    const tbb::blocked_range<std::size_t> range(0, node.order.size(), kParallelThreshold);
    if (node.order.size() <= kParallelThreshold) return accumulate(range, {});
    return tbb::parallel_deterministic_reduce(range, Result{}, accumulate, join);
}

/// Bins need an extent whose reciprocal is finite.
bool splittable(const Box3f& centers, int axis) {
    return centers.upper[axis] - centers.lower[axis] > std::numeric_limits<float>::min();
}

std::uint32_t binOf(float center, const Box3f& centers, int axis, std::uint32_t binCount) {
    const float extent = centers.upper[axis] - centers.lower[axis];
    const float position = (center - centers.lower[axis]) / extent * static_cast<float>(binCount);
    return std::min(static_cast<std::uint32_t>(position), binCount - 1);
}

Bins fillBins(const NodePrimitives& node, const NodeBounds& bounds, std::uint32_t binCount) {
    const auto take = [&](Bins& bins, const Box3f& box) {
        const Vec3f center = box.center();
        for (int axis = 0; axis < 3; ++axis) {
            if (!splittable(bounds.centers, axis)) continue;
            Bin& bin = bins[static_cast<std::size_t>(axis)][binOf(center[axis], bounds.centers, axis, binCount)];
            bin.bounds.extend(box);
            ++bin.count;
        }
    };
    const auto join = [](Bins a, const Bins& b) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t i = 0; i < kMaxBins; ++i) {
                a[axis][i].bounds.extend(b[axis][i].bounds);
                a[axis][i].count += b[axis][i].count;
            }
        return a;
    };
    return gather<Bins>(node, take, join);
}

/// Cost (area times count, both sides) of splitting after each bin; keeps the least over all axes.
void sweep(std::span<const Bin> bins, int axis, BinSplit& best) {
    std::array<float, kMaxBins> rightCost{};
    Bin right;
    for (std::size_t i = bins.size() - 1; i > 0; --i) {
        right.bounds.extend(bins[i].bounds);
        right.count += bins[i].count;
        rightCost[i] = right.count == 0 ? std::numeric_limits<float>::infinity()
                                        : right.bounds.halfArea() * static_cast<float>(right.count);
    }
    Bin left;
    for (std::size_t i = 0; i + 1 < bins.size(); ++i) {
        left.bounds.extend(bins[i].bounds);
        left.count += bins[i].count;
        if (left.count == 0) continue;
        const float cost = left.bounds.halfArea() * static_cast<float>(left.count) + rightCost[i + 1];
        if (cost < best.cost) best = {axis, static_cast<std::uint32_t>(i), cost};
    }
}

BinSplit findSplit(const NodePrimitives& node, const NodeBounds& bounds, std::uint32_t binCount) {
    const Bins bins = fillBins(node, bounds, binCount);
    BinSplit best;
    const float parentArea = bounds.boxes.halfArea();
    for (int axis = 0; axis < 3; ++axis)
        if (splittable(bounds.centers, axis))
            sweep(std::span(bins[static_cast<std::size_t>(axis)]).first(binCount), axis, best);
    // A flat or point-like node has no area to compare by: any split is as good as another.
    if (best.axis >= 0) best.cost = parentArea > 0.0f ? 1.0f + best.cost / parentArea : 1.0f;
    return best;
}

/// Moves the primitives whose boxes `goesLeft` to the front; how many they are.
template <typename Predicate> std::uint32_t divide(const NodePrimitives& node, const Predicate& goesLeft) {
    const auto middle =
        std::partition(node.order.begin(), node.order.end(), [&](std::uint32_t i) { return goesLeft(node.boxes[i]); });
    return static_cast<std::uint32_t>(middle - node.order.begin());
}

} // namespace

NodeBounds boundsOf(const NodePrimitives& node) {
    const auto take = [](NodeBounds& bounds, const Box3f& box) {
        bounds.boxes.extend(box);
        bounds.centers.extend(box.center());
    };
    const auto join = [](NodeBounds a, const NodeBounds& b) {
        a.boxes.extend(b.boxes);
        a.centers.extend(b.centers);
        return a;
    };
    return gather<NodeBounds>(node, take, join);
}

std::uint32_t splitBySurfaceArea(const NodePrimitives& node, const NodeBounds& bounds, const BvhOptions& options) {
    const BinSplit split = findSplit(node, bounds, options.binCount);
    const std::size_t count = node.order.size();
    if (split.axis < 0 || (count <= options.maxLeafSize && split.cost >= static_cast<float>(count))) return 0;
    return divide(node, [&](const Box3f& box) {
        return binOf(box.center()[split.axis], bounds.centers, split.axis, options.binCount) <= split.bin;
    });
}

std::uint32_t splitAtMean(const NodePrimitives& node) {
    using Counts = glm::vec<3, std::uint32_t>;
    const Vec3d sum = gather<Vec3d>(
        node, [](Vec3d& total, const Box3f& box) { total += Vec3d(box.center()); }, std::plus<>());
    const Vec3d mean = sum / static_cast<double>(node.order.size());
    const auto below = gather<Counts>(
        node, [&](Counts& total, const Box3f& box) { total += Counts(glm::lessThan(Vec3d(box.center()), mean)); },
        std::plus<>());
    const Counts emptier = glm::min(below, Counts(static_cast<std::uint32_t>(node.order.size())) - below);
    const int axis = emptier.x >= emptier.y && emptier.x >= emptier.z ? 0 : emptier.y >= emptier.z ? 1 : 2;
    if (emptier[axis] == 0) return 0;
    return divide(node, [&](const Box3f& box) { return static_cast<double>(box.center()[axis]) < mean[axis]; });
}

std::uint32_t splitInHalves(const NodePrimitives& node, const NodeBounds& bounds) {
    const Vec3f extent = bounds.centers.extent();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t middle = node.order.size() / 2;
    std::nth_element(node.order.begin(), node.order.begin() + static_cast<std::ptrdiff_t>(middle), node.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float centerA = node.boxes[a].center()[axis];
                         const float centerB = node.boxes[b].center()[axis];
                         return centerA != centerB ? centerA < centerB : a < b;
                     });
    return static_cast<std::uint32_t>(middle);
}

} // namespace isolux
