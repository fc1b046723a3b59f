// How the primitives of a BVH's node are divided in two. Nothing here depends on the number of threads.
#pragma once

#include "accel/bvh.h"

#include <cstdint>
#include <span>

namespace isolux {

inline constexpr std::uint32_t kMaxBins = 32;
inline constexpr std::uint32_t kParallelThreshold = 4096; ///< primitives below which a task costs more than it gains

/// Bounds of a node's boxes and of their centres. Minimum and maximum are exact, so any order gives the same bits.
struct NodeBounds {
    Box3f boxes;
    Box3f centers;
};

/// A node's primitives while the tree is built.
struct NodePrimitives {
    std::span<const Box3f> boxes;   ///< of all primitives
    std::span<std::uint32_t> order; ///< the node's: indices into `boxes`
};

[[nodiscard]] NodeBounds boundsOf(const NodePrimitives& node);

/// These reorder the primitives and return how many of them, the first ones, go to the left child.

/// By the least expected cost; 0 if a leaf is allowed and costs no more, or where bins cannot tell the centres apart.
[[nodiscard]] std::uint32_t splitBySurfaceArea(const NodePrimitives& node, const NodeBounds& bounds,
                                               const BvhOptions& options);
/// At the mean of the centres, on the axis that has the most on its emptier side; 0 if that is none on each.
[[nodiscard]] std::uint32_t splitAtMean(const NodePrimitives& node);
/// Two equal halves along the longest axis of the centres: always possible, even if all centres are equal.
[[nodiscard]] std::uint32_t splitInHalves(const NodePrimitives& node, const NodeBounds& bounds);

} // namespace isolux
