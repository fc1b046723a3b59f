// A binary bounding volume hierarchy over boxes. It knows neither triangles nor Vulkan: boxes in, a flat tree out.
#pragma once

#include "core/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

struct Bvh {
    struct Node {
        Box3f bounds;
        std::uint32_t first =
            0; ///< leaf: first entry in `primitives`; inner: first of two neighbouring children in `nodes`
        std::uint32_t count = 0; ///< leaf: number of primitives; inner: 0

        [[nodiscard]] bool isLeaf() const { return count > 0; }
    };
    std::vector<Node> nodes;               ///< nodes[0] is the root; none if there are no primitives
    std::vector<std::uint32_t> primitives; ///< indices of the boxes, leaf by leaf
    std::uint32_t depth = 0;               ///< nodes on the longest path from the root, the root counted
};

/// How a node's primitives are divided. `surfaceArea`: where the surface area heuristic expects the least work. `mean`:
/// at the mean of the boxes' centres, on the axis on which that divides them most evenly, until a leaf is small enough.
enum class SplitMethod { surfaceArea, mean };

struct BvhOptions {
    SplitMethod split = SplitMethod::surfaceArea;
    std::uint32_t maxLeafSize = 4;
    std::uint32_t binCount = 16; ///< of the surface area heuristic
    /// No path from the root is longer than this: near it, nodes are halved by count instead. At least
    /// 2 + log2 of the number of primitives is always allowed.
    std::uint32_t maxDepth = 48;
};

/// Builds in parallel; the result does not depend on the number of threads. The surface area heuristic is evaluated in
/// bins (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies"). Boxes must be finite and not
/// empty.
[[nodiscard]] Bvh buildBvh(std::span<const Box3f> boxes, const BvhOptions& options = {});

struct BvhStatistics {
    std::size_t nodeCount = 0;
    std::size_t leafCount = 0;
    std::uint32_t depth = 0;
    double sahCost = 0.0; ///< expected cost of a random ray through the root: 1 a node visit, 1 a primitive test
    double meanLeafSize = 0.0;
};

[[nodiscard]] BvhStatistics statistics(const Bvh& bvh);

} // namespace isolux
