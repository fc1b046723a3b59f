// How a render is cut into dispatches: pure functions of resolution and limits, so that they can be tested without a
// device and cannot make the image depend on timing.
#pragma once

#include "film/sample_plan.h"

#include <cstdint>
#include <vector>

namespace isolux {

/// A rectangle of pixels.
struct Tile {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t width = 0;
    std::uint32_t height = 0;

    [[nodiscard]] std::uint64_t pixelCount() const { return std::uint64_t{width} * height; }
};

/// Every pixel of the region once (packPixel), in the order in which lanes take them: about square tiles of at most
/// `maxLanes` pixels, in them blocks of 8 x 8, so that neighbouring lanes follow similar paths.
[[nodiscard]] std::vector<std::uint32_t> orderPixels(const Tile& region, std::uint32_t maxLanes);

/// Most steps a lane may take in one dispatch. Lavapipe of Mesa 22.3 ends loops after 65,535 iterations, counted over
/// the lanes of a subgroup and over all loops; what a lane needs beyond its steps (leaves begun, stacks stored) is
/// within the margin left.
[[nodiscard]] std::uint32_t maxStepBudget(std::uint32_t subgroupSize);

/// The next dispatch's step budget, from how long the last one took, to last about `targetSeconds`: it at most doubles.
[[nodiscard]] std::uint32_t nextStepBudget(std::uint32_t budget, double seconds, double targetSeconds,
                                           std::uint32_t maximum);

} // namespace isolux
