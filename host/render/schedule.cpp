#include "render/schedule.h"

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

constexpr std::uint32_t kLoopIterationLimit = 56'000; // of 65,535: the rest is for stacks and leaves
constexpr std::uint32_t kMaxBudget = 7'000;
constexpr std::uint32_t kMinBudget = 16;
constexpr std::uint32_t kBlockLanes = 64; // 8 x 8 pixels

} // namespace

Schedule makeSchedule(const Tile& region, const ScheduleLimits& limits) {
    Schedule schedule;
    const std::uint32_t blocks = std::max(limits.maxLanes / kBlockLanes, 1u);
    // About square, so that a tile's paths see similar things; long thin images get long thin tiles.
    const auto square = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(blocks)));
    const std::uint32_t rows = std::max(std::min((region.height + 7) / 8, square), 1u);
    const std::uint32_t tileHeight = rows * 8;
    const std::uint32_t tileWidth = blocks / rows * 8;
    for (std::uint32_t y = 0; y < region.height; y += tileHeight)
        for (std::uint32_t x = 0; x < region.width; x += tileWidth) {
            const Tile tile{region.x + x, region.y + y, std::min(tileWidth, region.width - x),
                            std::min(tileHeight, region.height - y)};
            schedule.maxLaneCount = std::max(schedule.maxLaneCount, tile.laneCount());
            schedule.tiles.push_back(tile);
        }
    return schedule;
}

std::uint32_t maxStepBudget(std::uint32_t subgroupSize) {
    return std::clamp(kLoopIterationLimit / std::max(subgroupSize, 1u), kMinBudget, kMaxBudget);
}

std::uint32_t nextStepBudget(std::uint32_t budget, double seconds, double targetSeconds, std::uint32_t maximum) {
    const double factor = seconds > 0.0 ? std::min(2.0, targetSeconds / seconds) : 2.0;
    const double next = static_cast<double>(budget) * factor;
    return static_cast<std::uint32_t>(std::clamp(next, static_cast<double>(kMinBudget), static_cast<double>(maximum)));
}

} // namespace isolux
