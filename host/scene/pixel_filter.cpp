#include "scene/pixel_filter.h"

#include "core/math.h"

#include <cmath>
#include <vector>

namespace isolux {
namespace {

/// Steps of the numerical integral: midpoints, whose error on these smooth bumps is far below a float's.
constexpr std::uint32_t kSteps = 1u << 16;

double blackmanHarris(double x) { // x in [-1, 1]; Harris 1978, "On the use of windows", table 1
    return 0.35875 + 0.48829 * std::cos(kPi * x) + 0.14128 * std::cos(2.0 * kPi * x) +
           0.01168 * std::cos(3.0 * kPi * x);
}

/// The integral of the filter from its left end to each step, up to a factor.
std::vector<double> cumulate(const FilterSettings& filter) {
    std::vector<double> sums(kSteps + 1, 0.0);
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const double offset = filter.radius * ((2.0 * i + 1.0) / kSteps - 1.0);
        sums[i + 1] = sums[i] + filterDensity(filter, offset);
    }
    return sums;
}

} // namespace

double defaultRadius(PixelFilter filter) {
    switch (filter) {
    case PixelFilter::box: return 0.5;
    case PixelFilter::triangle: return 1.0;
    case PixelFilter::gaussian:
    case PixelFilter::blackmanHarris: return 1.5;
    }
    return 0.5;
}

double filterDensity(const FilterSettings& filter, double offset) {
    const double x = offset / filter.radius;
    if (std::abs(x) > 1.0) return 0.0;
    switch (filter.kind) {
    case PixelFilter::box: return 1.0;
    case PixelFilter::triangle: return 1.0 - std::abs(x);
    case PixelFilter::gaussian: return std::exp(-0.5 * 9.0 * x * x);
    case PixelFilter::blackmanHarris: return blackmanHarris(x);
    }
    return 0.0;
}

FilterTable buildFilterTable(const FilterSettings& filter) {
    const std::vector<double> sums = cumulate(filter);
    FilterTable table;
    constexpr std::uint32_t kHalf = kFilterCells / 2;
    std::uint32_t step = 0;
    // The left half, and its mirror image: the table is symmetric to the last bit.
    for (std::uint32_t i = 0; i < kHalf; ++i) {
        const double wanted = sums.back() * i / kFilterCells;
        while (sums[step + 1] <= wanted) ++step;
        const double within = (wanted - sums[step]) / (sums[step + 1] - sums[step]);
        const double offset = i == 0 ? -filter.radius : filter.radius * (2.0 * (step + within) / kSteps - 1.0);
        table.quantiles[i] = static_cast<float>(offset);
        table.quantiles[kFilterCells - i] = -table.quantiles[i];
    }
    table.quantiles[kHalf] = 0.0f;
    return table;
}

} // namespace isolux
