// The sweeps of the family of lights, by kinds of light.
#pragma once

#include "stress/trial.h"

#include <vector>

namespace isolux {

/// Half of what is seen of a floor: so little that its light is even to some 1e-6.
inline constexpr double kPatch = 1e-3;

[[nodiscard]] std::vector<PlannedSweep> lampSweeps(Extent extent);        ///< squares that emit
[[nodiscard]] std::vector<PlannedSweep> sphereLightSweeps(Extent extent); ///< from outside and inside
[[nodiscard]] std::vector<PlannedSweep> punctualSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> contrastSweeps(Extent extent); ///< bright and dim, alone and beside each other

} // namespace isolux
