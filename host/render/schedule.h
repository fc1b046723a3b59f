// How a render is cut into dispatches: a pure function of resolution, samples and limits, so that it can be tested
// without a device and cannot make the image depend on timing.
#pragma once

#include "scene/render_settings.h"

#include <cstdint>
#include <vector>

namespace isolux {

/// Samples a lane takes before the host joins its statistics in double. Fixed, because the order of summation is part
/// of the image; a render with a time limit takes fewer in some batches.
inline constexpr std::uint32_t kBatchSamples = 16;

struct Tile {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t width = 0;
    std::uint32_t height = 0;

    /// Lanes that cover the tile in blocks of 8 x 8 pixels.
    [[nodiscard]] std::uint32_t laneCount() const { return ((width + 7) / 8) * ((height + 7) / 8) * 64; }
    [[nodiscard]] std::uint32_t pixelCount() const { return width * height; }
};

struct Batch {
    std::uint32_t firstSample = 0;
    std::uint32_t sampleCount = 0;
};

/// Every tile of a batch is rendered before the next batch begins: an interrupted render covers the image.
struct Schedule {
    std::vector<Tile> tiles;
    std::uint32_t maxLaneCount = 0; ///< of any tile
};

struct ScheduleLimits {
    std::uint32_t maxLanes = 1u << 18; ///< lanes whose state fits the device's buffers
};

/// Tiles cover exactly the region, without overlap.
[[nodiscard]] Schedule makeSchedule(const Tile& region, const ScheduleLimits& limits);

/// Most steps a lane may take in one dispatch. Lavapipe of Mesa 22.3 ends loops after 65,535 iterations, counted over
/// the lanes of a subgroup and over all loops; what a lane needs beyond its steps (leaves begun, stacks stored) is
/// within the margin left.
[[nodiscard]] std::uint32_t maxStepBudget(std::uint32_t subgroupSize);

/// The next dispatch's step budget, from how long the last one took, to last about `targetSeconds`: it at most doubles.
[[nodiscard]] std::uint32_t nextStepBudget(std::uint32_t budget, double seconds, double targetSeconds,
                                           std::uint32_t maximum);

} // namespace isolux
