#include "accel/bvh.h"
#include "accel/wide_bvh.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <bit>
#include <random>

namespace isolux {
namespace {

std::vector<Box3f> randomBoxes(std::size_t count, float size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> position(-1.0f, 1.0f);
    std::uniform_real_distribution<float> extent(0.0f, size);
    std::vector<Box3f> boxes(count);
    for (Box3f& box : boxes) {
        const Vec3f corner(position(random), position(random), position(random));
        box.extend(corner);
        box.extend(corner + Vec3f(extent(random), extent(random), extent(random)));
    }
    return boxes;
}

bool contains(const Box3f& outer, const Box3f& inner) {
    return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
           glm::all(glm::greaterThanEqual(outer.upper, inner.upper));
}

/// Every primitive in exactly one leaf, every box around what is below it, sizes and depth within their limits.
void expectValid(const Bvh& bvh, const std::vector<Box3f>& boxes, const BvhOptions& options) {
    std::vector<int> seen(boxes.size(), 0);
    std::vector<std::uint32_t> depth(bvh.nodes.size(), 0);
    depth[0] = 1;
    std::uint32_t deepest = 0;
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        const Bvh::Node& node = bvh.nodes[i];
        ASSERT_GT(depth[i], 0u) << "node " << i << " has no parent before it";
        deepest = std::max(deepest, depth[i]);
        if (node.isLeaf()) {
            EXPECT_LE(node.count, options.maxLeafSize);
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
                ++seen[bvh.primitives[k]];
                EXPECT_TRUE(contains(node.bounds, boxes[bvh.primitives[k]]));
            }
        } else {
            for (const std::uint32_t child : {node.first, node.first + 1}) {
                EXPECT_TRUE(contains(node.bounds, bvh.nodes[child].bounds));
                depth[child] = depth[i] + 1;
            }
        }
    }
    EXPECT_EQ(deepest, bvh.depth);
    EXPECT_LE(bvh.depth, std::max(options.maxDepth, 2 + static_cast<std::uint32_t>(std::bit_width(boxes.size()))));
    for (const int count : seen) EXPECT_EQ(count, 1);
}

/// Every quantised child box, decoded as a device does, contains the primitives below it.
void expectValid(const WideBvh& wide, const std::vector<Box3f>& boxes) {
    std::vector<int> seen(boxes.size(), 0);
    std::vector<Box3f> below(wide.nodes.size());
    for (std::size_t i = wide.nodes.size(); i-- > 0;)
        for (int c = 0; c < WideNode::kWidth; ++c) {
            const WideChild child = wide.nodes[i].children[static_cast<std::size_t>(c)];
            if (child.isEmpty()) continue;
            Box3f content;
            if (child.isLeaf()) {
                for (std::uint32_t k = child.first(); k < child.first() + child.count(); ++k) {
                    content.extend(boxes[wide.primitives[k]]);
                    ++seen[wide.primitives[k]];
                }
            } else {
                ASSERT_GT(child.node(), i);
                content = below[child.node()];
            }
            EXPECT_TRUE(contains(wide.nodes[i].childBounds(c), content)) << "node " << i << " child " << c;
            below[i].extend(content);
        }
    for (const int count : seen) EXPECT_EQ(count, 1);
}

/// The most entries that a depth-first walk which visits everything holds.
std::size_t fullWalkStack(const WideBvh& wide) {
    std::vector<WideChild> stack{WideChild::inner(0)};
    std::size_t most = 1;
    while (!stack.empty()) {
        const WideChild item = stack.back();
        stack.pop_back();
        if (item.isLeaf()) continue;
        for (const WideChild child : wide.nodes[item.node()].children)
            if (!child.isEmpty()) stack.push_back(child);
        most = std::max(most, stack.size());
    }
    return most;
}

class BvhCases : public ::testing::TestWithParam<std::vector<Box3f>> {};

TEST_P(BvhCases, BinaryAndWideTreesAreValid) {
    for (const SplitMethod split : {SplitMethod::surfaceArea, SplitMethod::mean})
        for (const std::uint32_t maxLeafSize : {1u, 4u, 8u}) {
            const BvhOptions options{split, maxLeafSize};
            const Bvh bvh = buildBvh(GetParam(), options);
            expectValid(bvh, GetParam(), options);
            const WideBvh wide = buildWideBvh(bvh);
            expectValid(wide, GetParam());
            EXPECT_LE(fullWalkStack(wide), wide.stackBound);
        }
}

/// n boxes, each twice as far out and twice as large as the one before: SAH peels them off one by one.
std::vector<Box3f> chain(int count) {
    std::vector<Box3f> boxes(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const float size = std::ldexp(1.0f, i - count / 2);
        boxes[static_cast<std::size_t>(i)].extend(Vec3f(size));
        boxes[static_cast<std::size_t>(i)].extend(Vec3f(1.25f * size));
    }
    return boxes;
}

std::vector<Box3f> repeated(std::size_t count, const Vec3f& lower, const Vec3f& upper) {
    Box3f box;
    box.extend(lower);
    box.extend(upper);
    return std::vector<Box3f>(count, box);
}

INSTANTIATE_TEST_SUITE_P(Boxes, BvhCases,
                         ::testing::Values(randomBoxes(1, 0.1f, 1), randomBoxes(2, 0.1f, 2), randomBoxes(5, 0.1f, 3),
                                           randomBoxes(1000, 0.05f, 4), randomBoxes(50'000, 0.02f, 5),
                                           randomBoxes(3000, 2.0f, 6), chain(200),
                                           repeated(20'000, Vec3f(0.25f), Vec3f(0.5f)), // all centres equal
                                           repeated(3000, Vec3f(0.1f), Vec3f(0.1f)),    // points
                                           repeated(3000, Vec3f(0.0f, -1.0f, 0.0f), Vec3f(1.0f, -1.0f, 1.0f)), // flat
                                           repeated(9, Vec3f(-1e30f), Vec3f(1e30f)),
                                           repeated(9, Vec3f(1e-38f), Vec3f(3e-38f))));

void expectSame(const Bvh& a, const Bvh& b) {
    EXPECT_EQ(a.primitives, b.primitives);
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t i = 0; i < b.nodes.size(); ++i) {
        EXPECT_EQ(a.nodes[i].first, b.nodes[i].first);
        EXPECT_EQ(a.nodes[i].count, b.nodes[i].count);
        EXPECT_EQ(a.nodes[i].bounds.lower, b.nodes[i].bounds.lower);
        EXPECT_EQ(a.nodes[i].bounds.upper, b.nodes[i].bounds.upper);
    }
}

TEST(Bvh, DoesNotDependOnTheNumberOfThreads) {
    const std::vector<Box3f> boxes = randomBoxes(30'000, 0.05f, 7);
    for (const SplitMethod split : {SplitMethod::surfaceArea, SplitMethod::mean}) {
        const Bvh parallel = buildBvh(boxes, {split});
        const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
        expectSame(parallel, buildBvh(boxes, {split}));
    }
}

/// Boxes that are points at these places.
std::vector<Box3f> pointsAt(const std::vector<Vec3f>& places) {
    std::vector<Box3f> boxes(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) boxes[i].extend(places[i]);
    return boxes;
}

/// x: one of eight below the mean; y: four; z: all equal.
TEST(Bvh, MeanSplitTakesTheMostBalancedAxis) {
    const std::vector<Box3f> boxes = pointsAt({{-9, 0, 1},
                                               {2, 0, 1},
                                               {2, 0, 1},
                                               {2, 0, 1}, //
                                               {2, 1, 1},
                                               {2, 1, 1},
                                               {2, 1, 1},
                                               {2, 2, 1}});
    const Bvh bvh = buildBvh(boxes, {SplitMethod::mean, 4});
    ASSERT_EQ(bvh.nodes.size(), 3u);
    EXPECT_EQ(bvh.nodes[1].count, 4u);
    EXPECT_EQ(bvh.nodes[1].bounds.upper.y, 0.0f);
    EXPECT_EQ(bvh.nodes[2].count, 4u);
    EXPECT_EQ(bvh.nodes[2].bounds.lower.y, 1.0f);
}

/// On a line the mean of the rest is what divides every node.
TEST(Bvh, MeanSplitDividesAtTheMeanUntilLeavesAreSmall) {
    const std::vector<Box3f> boxes = pointsAt({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {100, 0, 0}});
    const Bvh bvh = buildBvh(boxes, {SplitMethod::mean, 2}); // means 21.2 and 1.5
    ASSERT_EQ(bvh.nodes.size(), 5u);
    EXPECT_EQ(bvh.primitives, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(bvh.nodes[1].first, 3u) << "the first four are an inner node";
    EXPECT_EQ(bvh.nodes[2].count, 1u);
    EXPECT_EQ(bvh.nodes[3].count, 2u);
    EXPECT_EQ(bvh.nodes[4].count, 2u);
}

/// The cost of a random ray is what the surface area heuristic is about.
TEST(Bvh, SurfaceAreaHeuristicCostsLessThanTheMean) {
    for (const float size : {0.02f, 0.5f, 2.0f}) {
        std::vector<Box3f> boxes = randomBoxes(10'000, size, 9);
        const std::vector<Box3f> small = randomBoxes(10'000, 0.001f, 10); // sizes that differ
        boxes.insert(boxes.end(), small.begin(), small.end());
        EXPECT_LT(statistics(buildBvh(boxes)).sahCost, statistics(buildBvh(boxes, {SplitMethod::mean})).sahCost)
            << size;
    }
}

TEST(Bvh, CostsFarLessThanAList) {
    const std::vector<Box3f> boxes = randomBoxes(10'000, 0.02f, 8);
    const BvhStatistics figures = statistics(buildBvh(boxes));
    EXPECT_EQ(figures.nodeCount, 2 * figures.leafCount - 1);
    EXPECT_LT(figures.sahCost, 200.0);
}

TEST(Bvh, NothingToBuild) {
    EXPECT_TRUE(buildBvh({}).nodes.empty());
    EXPECT_TRUE(buildWideBvh(buildBvh({})).nodes.empty());
    EXPECT_EQ(statistics(buildBvh({})).nodeCount, 0u);
}

TEST(WideChild, PacksAndUnpacks) {
    for (const std::uint32_t count : {1u, 4u, 8u})
        for (const std::uint32_t first : {0u, 1u, 123'456'789u, WideChild::kMaxFirst - 1}) {
            const WideChild child = WideChild::leaf(first, count);
            EXPECT_TRUE(child.isLeaf());
            EXPECT_FALSE(child.isEmpty());
            EXPECT_EQ(child.first(), first);
            EXPECT_EQ(child.count(), count);
        }
    EXPECT_FALSE(WideChild::inner(7).isLeaf());
    EXPECT_EQ(WideChild::inner(7).node(), 7u);
    EXPECT_FALSE(WideChild::empty().isLeaf());
}

} // namespace
} // namespace isolux
