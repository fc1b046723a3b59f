// Tables of pixel filters against the filters themselves: symmetric, monotone, with the right moments and the right
// density.
#include "scene/pixel_filter.h"

#include "core/math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace isolux {
namespace {

class Filters : public ::testing::TestWithParam<FilterSettings> {};

INSTANTIATE_TEST_SUITE_P(
    All, Filters,
    ::testing::Values(FilterSettings{PixelFilter::box, 0.5}, FilterSettings{PixelFilter::triangle, 1.0},
                      FilterSettings{PixelFilter::triangle, 0.3}, FilterSettings{PixelFilter::gaussian, 1.5},
                      FilterSettings{PixelFilter::gaussian, 8.0}, FilterSettings{PixelFilter::blackmanHarris, 1.5},
                      FilterSettings{PixelFilter::blackmanHarris, 4.0}));

TEST_P(Filters, TableIsSymmetricAndRisesToTheRadius) {
    const FilterTable table = buildFilterTable(GetParam());
    const auto radius = static_cast<float>(GetParam().radius);
    EXPECT_EQ(table.quantiles.front(), -radius);
    EXPECT_EQ(table.quantiles.back(), radius);
    EXPECT_EQ(table.quantiles[kFilterCells / 2], 0.0f);
    for (std::uint32_t i = 0; i < kFilterCells; ++i) {
        EXPECT_LT(table.quantiles[i], table.quantiles[i + 1]) << i;
        EXPECT_EQ(table.quantiles[i], -table.quantiles[kFilterCells - i]) << i;
    }
}

/// The integral of the filter's density from one offset to another, by Simpson's rule between kinks.
double integral(const FilterSettings& filter, double from, double to) {
    constexpr int kSteps = 2000;
    const double step = (to - from) / kSteps;
    double sum = filterDensity(filter, from) + filterDensity(filter, to);
    for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * filterDensity(filter, from + i * step);
    return sum * step / 3.0;
}

/// Each cell holds the same share of the filter. Rounding to float moves an end by 2^-25 radii, at a density of at most
/// 1.4 / radius, so a share of 1/256 by 2 * 256 * 1.4 * 2^-25 = 2.2e-5 of itself.
TEST_P(Filters, EveryCellHoldsTheSameShare) {
    const FilterTable table = buildFilterTable(GetParam());
    const double half = integral(GetParam(), 0.0, GetParam().radius);
    for (std::uint32_t i = kFilterCells / 2; i < kFilterCells; ++i) {
        const double to = std::min(double{table.quantiles[i + 1]}, GetParam().radius);
        const double share = integral(GetParam(), table.quantiles[i], to) / (2.0 * half);
        EXPECT_NEAR(share * kFilterCells, 1.0, 2.5e-5) << i;
    }
}

double standardDeviation(const FilterTable& table) {
    double square = 0.0; // of a density constant over each cell
    for (std::uint32_t i = 0; i < kFilterCells; ++i) {
        const double a = table.quantiles[i];
        const double b = table.quantiles[i + 1];
        square += (a * a + a * b + b * b) / 3.0 / kFilterCells;
    }
    return std::sqrt(square);
}

/// Of the analytic filters: box r / sqrt 3; triangle r / sqrt 6; the Gaussian of r / 3 cut off at 3 sigma: sigma *
/// sqrt(1 - 6 phi(3) / erf(3 / sqrt 2)); Blackman-Harris by integrating its cosines: int x^2 cos(k pi x) over [-1, 1]
/// is 4 (-1)^k / (k pi)^2.
double analyticDeviation(const FilterSettings& filter) {
    const double r = filter.radius;
    switch (filter.kind) {
    case PixelFilter::box: return r / std::sqrt(3.0);
    case PixelFilter::triangle: return r / std::sqrt(6.0);
    case PixelFilter::gaussian: {
        const double density = std::exp(-4.5) / std::sqrt(2.0 * kPi);
        return r / 3.0 * std::sqrt(1.0 - 6.0 * density / std::erf(3.0 / std::sqrt(2.0)));
    }
    case PixelFilter::blackmanHarris: {
        const double cosines = -0.48829 + 0.14128 / 4.0 - 0.01168 / 9.0;
        return r * std::sqrt((0.35875 * 2.0 / 3.0 + cosines * 4.0 / (kPi * kPi)) / (2.0 * 0.35875));
    }
    }
    return 0.0;
}

/// What spreading each cell's share evenly may change; host/scene/README.md states these figures.
struct Difference {
    double deviation;
    double elsewhere;
};
Difference largestDifference(PixelFilter kind) {
    switch (kind) {
    case PixelFilter::box: return {1e-7, 1e-6};
    case PixelFilter::triangle: return {8e-4, 0.0044};
    case PixelFilter::gaussian: return {0.0014, 0.0044};
    case PixelFilter::blackmanHarris: return {0.008, 0.0068};
    }
    return {};
}

TEST_P(Filters, DeviationIsTheFilters) {
    const double expected = analyticDeviation(GetParam());
    const double relative = standardDeviation(buildFilterTable(GetParam())) / expected - 1.0;
    EXPECT_GE(relative, -1e-7) << "the density falls from the centre, so a cell spread evenly is wider";
    EXPECT_LE(relative, largestDifference(GetParam().kind).deviation);
}

/// Half the integral of the difference of the densities: the share of samples that lie elsewhere than the filter wants.
TEST_P(Filters, NearlyAllSamplesLieWhereTheFilterWants) {
    const FilterTable table = buildFilterTable(GetParam());
    const double whole = 2.0 * integral(GetParam(), 0.0, GetParam().radius);
    double elsewhere = 0.0;
    for (std::uint32_t i = 0; i < kFilterCells; ++i) {
        constexpr int kSteps = 200;
        const double width = (double{table.quantiles[i + 1]} - table.quantiles[i]) / kSteps;
        const double constant = 1.0 / kFilterCells / kSteps;
        for (int step = 0; step < kSteps; ++step) {
            const double offset = table.quantiles[i] + (step + 0.5) * width;
            elsewhere += 0.5 * std::abs(filterDensity(GetParam(), offset) * width / whole - constant);
        }
    }
    EXPECT_LE(elsewhere, largestDifference(GetParam().kind).elsewhere);
}

TEST(PixelFilter, DensitiesEndAtTheRadius) {
    for (const PixelFilter kind :
         {PixelFilter::box, PixelFilter::triangle, PixelFilter::gaussian, PixelFilter::blackmanHarris}) {
        const FilterSettings filter{kind, 2.0};
        EXPECT_EQ(filterDensity(filter, 2.0001), 0.0);
        EXPECT_EQ(filterDensity(filter, -2.0001), 0.0);
        EXPECT_NEAR(filterDensity(filter, 0.0), 1.0, 1e-12);
        EXPECT_EQ(filterDensity(filter, 0.7), filterDensity(filter, -0.7));
        EXPECT_GT(defaultRadius(kind), 0.0);
    }
    EXPECT_NEAR(filterDensity({PixelFilter::gaussian, 1.5}, 0.5), std::exp(-0.5), 1e-12) << "sigma is a third";
    EXPECT_NEAR(filterDensity({PixelFilter::blackmanHarris, 1.0}, 1.0), 6e-5, 1e-12) << "Harris 1978: -92 dB";
    EXPECT_EQ(filterDensity({PixelFilter::triangle, 1.0}, 0.25), 0.75);
}

} // namespace
} // namespace isolux
