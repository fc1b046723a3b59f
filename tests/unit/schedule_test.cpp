#include "render/schedule.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

void expectCovers(const Tile& region, std::uint32_t maxLanes) {
    const Schedule schedule = makeSchedule(region, {maxLanes});
    std::vector<int> covered(std::size_t{region.width} * region.height, 0);
    for (const Tile& tile : schedule.tiles) {
        EXPECT_LE(tile.laneCount(), std::max(maxLanes, 64u));
        EXPECT_LE(tile.laneCount(), schedule.maxLaneCount);
        for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x)
                ++covered.at(std::size_t{y - region.y} * region.width + (x - region.x));
    }
    for (const int count : covered) EXPECT_EQ(count, 1);
}

TEST(Schedule, TilesCoverEveryPixelOnce) {
    expectCovers({0, 0, 1, 1}, 1 << 14);
    expectCovers({0, 0, 640, 480}, 1 << 14);
    expectCovers({3, 7, 100, 99}, 1024);
    expectCovers({0, 0, 16384, 1}, 1 << 14);
    expectCovers({0, 0, 1, 9000}, 4096);
    expectCovers({0, 0, 33, 33}, 64);
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
