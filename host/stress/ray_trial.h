// Lists of rays to nearest hits, on the device and on both references.
#pragma once

#include "stress/trial.h"

namespace isolux {

[[nodiscard]] std::vector<StressFigures> runRays(const RayTrial& trial, const StressBench& bench);

} // namespace isolux
