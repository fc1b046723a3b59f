// The chart of a sweep.
#pragma once

#include "report/stress.h"

#include <string>
#include <vector>

namespace isolux {

/// Deviation against stiffness as SVG, in the page's colours; empty if no step has a deviation. The index of a renderer
/// is that of its colour.
[[nodiscard]] std::string stressChart(const StressSweep& sweep, const std::vector<std::string>& renderers);

} // namespace isolux
