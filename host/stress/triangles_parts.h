// What the files of the family of triangles share.
#pragma once

#include "stress/sweep_parts.h"

#include <vector>

namespace isolux {

/// Many at one spot: coplanar ones, copies, and some without area.
[[nodiscard]] std::vector<PlannedSweep> crowdSweeps(Extent extent);

/// A convex white body in a white world: a ray that leaves it and meets it again brings 0.
[[nodiscard]] RenderTrial convexAndWhite(Mesh mesh, const Mat4d& worldFromObject);

[[nodiscard]] PlannedSweep sweepByCount(const StressSweep& about, const std::vector<int>& counts,
                                        RenderTrial (*trialOfCount)(int));

} // namespace isolux
