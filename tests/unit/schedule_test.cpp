#include "render/schedule.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

void expectCovers(const Tile& region, std::uint32_t maxLanes) {
    std::vector<int> covered(region.pixelCount(), 0);
    for (const std::uint32_t pixel : orderPixels(region, maxLanes)) {
        const std::uint32_t x = pixelX(pixel) - region.x;
        const std::uint32_t y = pixelY(pixel) - region.y;
        ASSERT_TRUE(x < region.width && y < region.height);
        ++covered.at(std::size_t{y} * region.width + x);
    }
    for (const int count : covered) EXPECT_EQ(count, 1);
}

TEST(Schedule, EveryPixelHasOnePlace) {
    expectCovers({0, 0, 1, 1}, 1 << 14);
    expectCovers({0, 0, 640, 480}, 1 << 14);
    expectCovers({3, 7, 100, 99}, 1024);
    expectCovers({0, 0, 16384, 1}, 1 << 14);
    expectCovers({0, 0, 1, 9000}, 4096);
    expectCovers({0, 0, 33, 33}, 64);
}

TEST(Schedule, NeighbouringLanesSeeNeighbouringPixels) {
    const std::vector<std::uint32_t> pixels = orderPixels({0, 0, 640, 480}, 1 << 14);
    for (std::size_t block = 0; block < pixels.size(); block += 64)
        for (std::size_t i = 0; i < 64; ++i) {
            ASSERT_EQ(pixelX(pixels[block + i]), pixelX(pixels[block]) + i % 8);
            ASSERT_EQ(pixelY(pixels[block + i]), pixelY(pixels[block]) + i / 8);
        }
    // A dispatch of all lanes is a square of the image.
    EXPECT_EQ(pixels[(1 << 14) - 1], packPixel(127, 127));
}

TEST(Schedule, BudgetsStayBelowTheLoopLimitOfEveryDriver) {
    for (const std::uint32_t subgroup : {1u, 4u, 8u, 16u, 32u, 64u}) {
        EXPECT_LE(maxStepBudget(subgroup) * std::uint64_t{subgroup}, 65'535u * 7 / 8);
        EXPECT_GE(maxStepBudget(subgroup), 16u);
    }
}

TEST(Schedule, BudgetFollowsTheClock) {
    EXPECT_EQ(nextStepBudget(1000, 0.2, 0.1, 7000), 500u);    // too long: shrinks at once
    EXPECT_EQ(nextStepBudget(1000, 0.001, 0.1, 7000), 2000u); // too short: doubles at most
    EXPECT_EQ(nextStepBudget(1000, 0.0, 0.1, 7000), 2000u);
    EXPECT_EQ(nextStepBudget(6000, 0.001, 0.1, 7000), 7000u);
    EXPECT_EQ(nextStepBudget(20, 100.0, 0.1, 7000), 16u);
}

} // namespace
} // namespace isolux
