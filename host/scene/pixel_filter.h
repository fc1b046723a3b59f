// Pixel filters as tables of quantiles: a random number becomes an offset from the pixel's centre with the filter as
// its density, so that every sample counts alike (Ernst, Stamminger and Greiner 2006). Shared by both renderers.
#pragma once

#include "scene/render_settings.h"

#include <array>
#include <cstdint>

namespace isolux {

inline constexpr std::uint32_t kFilterCells = 256;

/// Cell i holds the offsets for u in [i, i + 1) / kFilterCells: from quantiles[i] to quantiles[i + 1], linearly. The
/// filter that is rendered is this one, constant over each cell; quantiles[0] = -radius, the last is radius, the middle
/// one 0.
struct FilterTable {
    std::array<float, kFilterCells + 1> quantiles{};
};

/// The radius, in pixels, that a filter has unless another is asked for: box 0.5, triangle 1, Gaussian 1.5 (with a
/// standard deviation of a third of the radius), Blackman-Harris 1.5 (Harris 1978, four terms).
[[nodiscard]] double defaultRadius(PixelFilter filter);

/// The filter's density along one axis, not normalised, at a distance from the centre; 0 beyond the radius. The
/// Gaussian is cut off there and not lowered to 0.
[[nodiscard]] double filterDensity(const FilterSettings& filter, double offset);

[[nodiscard]] FilterTable buildFilterTable(const FilterSettings& filter);

} // namespace isolux
