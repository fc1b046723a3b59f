#include "render/schedule.h"

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

constexpr std::uint32_t kLoopIterationLimit = 56'000; // of 65,535: the rest is for stacks and leaves
constexpr std::uint32_t kMaxBudget = 7'000;
constexpr std::uint32_t kMinBudget = 16;
constexpr std::uint32_t kBlockEdge = 8; // pixels
constexpr std::uint32_t kBlockLanes = kBlockEdge * kBlockEdge;

void addBlock(const Tile& block, std::vector<std::uint32_t>& pixels) {
    for (std::uint32_t y = block.y; y < block.y + block.height; ++y)
        for (std::uint32_t x = block.x; x < block.x + block.width; ++x) pixels.push_back(packPixel(x, y));
}

void addBlocks(const Tile& tile, std::vector<std::uint32_t>& pixels) {
    for (std::uint32_t y = 0; y < tile.height; y += kBlockEdge)
        for (std::uint32_t x = 0; x < tile.width; x += kBlockEdge)
            addBlock(
                {tile.x + x, tile.y + y, std::min(kBlockEdge, tile.width - x), std::min(kBlockEdge, tile.height - y)},
                pixels);
}

} // namespace

std::vector<std::uint32_t> orderPixels(const Tile& region, std::uint32_t maxLanes) {
    std::vector<std::uint32_t> pixels;
    pixels.reserve(region.pixelCount());
    const std::uint32_t blocks = std::max(maxLanes / kBlockLanes, 1u);
    // About square, so that a tile's paths see similar things; long thin images get long thin tiles.
    const auto square = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(blocks)));
    const std::uint32_t rows = std::max(std::min((region.height + kBlockEdge - 1) / kBlockEdge, square), 1u);
    const std::uint32_t tileHeight = rows * kBlockEdge;
    const std::uint32_t tileWidth = blocks / rows * kBlockEdge;
    for (std::uint32_t y = 0; y < region.height; y += tileHeight)
        for (std::uint32_t x = 0; x < region.width; x += tileWidth)
            addBlocks({region.x + x, region.y + y, std::min(tileWidth, region.width - x),
                       std::min(tileHeight, region.height - y)},
                      pixels);
    return pixels;
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
