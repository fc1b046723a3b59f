// The families of stress tests: each a file of this folder.
#pragma once

#include "stress/trial.h"

#include <string>
#include <vector>

namespace isolux {

struct PlannedFamily {
    std::string name;
    std::string title;
    std::vector<PlannedSweep> (*sweeps)(Extent);
};

/// In the order in which they are run.
[[nodiscard]] const std::vector<PlannedFamily>& stressFamilies();

[[nodiscard]] std::vector<PlannedSweep> scaleSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> distanceSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> mixedScaleSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> triangleSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> watertightSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> raySweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> grazingSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> lightSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> surfaceSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> transportSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> accumulationSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> cameraSweeps(Extent extent);
[[nodiscard]] std::vector<PlannedSweep> nothingSweeps(Extent extent);

} // namespace isolux
