// The chart of a sweep, and what text needs to stand in a page.
#pragma once

#include "report/stress.h"

#include <string>
#include <vector>

namespace isolux {

[[nodiscard]] std::string escapedHtml(const std::string& text);

/// Deviation against stiffness as SVG, in the page's colours; empty if no step has a deviation. The index of a renderer
/// is that of its colour.
[[nodiscard]] std::string stressChart(const StressSweep& sweep, const std::vector<std::string>& renderers);

} // namespace isolux
