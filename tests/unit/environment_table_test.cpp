// The cells of environment maps: probabilities, solid angles, flux.
#include "scene/environment_table.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace isolux {
namespace {

EnvironmentMap blackMap(std::uint32_t width, std::uint32_t height) {
    EnvironmentMap map;
    map.name = "sky";
    map.width = width;
    map.height = height;
    map.texels.assign(std::size_t{width} * height, Vec3f(0.0f));
    return map;
}

EnvironmentMap randomMap(std::uint32_t width, std::uint32_t height) {
    EnvironmentMap map = blackMap(width, height);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> exponent(-3.0f, 3.0f);
    for (Vec3f& texel : map.texels)
        texel = {std::pow(10.0f, exponent(random)), std::pow(10.0f, exponent(random)),
                 std::pow(10.0f, exponent(random))};
    return map;
}

/// Luminance of the bilinear interpolation at (u, v) in texels, straight from the definition.
double interpolated(const EnvironmentMap& map, double u, double v) {
    const double column = std::floor(u - 0.5);
    const double row = std::floor(v - 0.5);
    double sum = 0.0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
            const auto width = static_cast<double>(map.width);
            const double wrapped = column + i - width * std::floor((column + i) / width);
            const double clamped = std::clamp(row + j, 0.0, map.height - 1.0);
            const double weight = (1.0 - std::abs(u - 0.5 - column - i)) * (1.0 - std::abs(v - 0.5 - row - j));
            sum += weight * luminance(Vec3d(map.texels[static_cast<std::size_t>(clamped * width + wrapped)]));
        }
    return sum;
}

/// Mean of the interpolation over a cell: the midpoints of its quarters are exact for what is linear in each.
double meanOfCell(const EnvironmentMap& map, std::uint32_t column, std::uint32_t row) {
    double sum = 0.0;
    for (const double u : {0.25, 0.75})
        for (const double v : {0.25, 0.75}) sum += interpolated(map, column + u, row + v);
    return 0.25 * sum;
}

double solidAngleByCosines(const EnvironmentMap& map, std::uint32_t row) {
    const double upper = std::cos(kPi * row / map.height);
    const double lower = std::cos(kPi * (row + 1.0) / map.height);
    return 2.0 * kPi / map.width * (upper - lower);
}

TEST(EnvironmentTable, ProbabilitiesAreLightTimesSolidAngle) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {2u, 1u}, {1u, 2u}, {2u, 2u}, {3u, 5u}, {16u, 8u}}) {
        const EnvironmentMap map = randomMap(width, height);
        const EnvironmentTable table = buildEnvironmentTable(map);
        ASSERT_EQ(table.cells.pdf.size(), map.texels.size());
        double flux = 0.0;
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) flux += meanOfCell(map, x, y) * solidAngleByCosines(map, y);
        EXPECT_NEAR(table.flux / flux, 1.0, 1e-12);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const double expected = meanOfCell(map, x, y) * solidAngleByCosines(map, y) / flux;
                // Integer shares round down by less than one unit, and the largest takes what is left: at most as many
                // units as there are texels, of 2^32 a texel.
                EXPECT_NEAR(table.cells.pdf[y * width + x], expected, 0x1p-32 + 1e-12)
                    << width << " x " << height << ", " << x << ", " << y;
            }
    }
}

TEST(EnvironmentTable, SolidAnglesFillTheSphere) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {2u, 1u}, {7u, 3u}, {4096u, 2048u}}) {
        const EnvironmentMap map{"", width, height, {}};
        double sum = 0.0;
        for (std::uint32_t y = 0; y < height; ++y) {
            EXPECT_NEAR(cellSolidAngle(map, y), solidAngleByCosines(map, y), 1e-15 * 4.0 * kPi);
            sum += width * cellSolidAngle(map, y);
        }
        EXPECT_NEAR(sum, 4.0 * kPi, 1e-12);
    }
}

TEST(EnvironmentTable, AConstantMapIsUniform) {
    EnvironmentMap map = blackMap(64, 32);
    map.texels.assign(map.texels.size(), Vec3f(0.5f));
    const EnvironmentTable table = buildEnvironmentTable(map);
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const double density = table.cells.pdf[y * map.width + x] / cellSolidAngle(map, y);
            // The smallest share has more than 2^26 units of 2^-43; the largest, of 2^32, takes those of 2^11 cells.
            EXPECT_NEAR(density * 4.0 * kPi, 1.0, 0x1p-20) << y;
        }
    EXPECT_NEAR(table.flux, 4.0 * kPi * 0.5, 1e-12);
}

TEST(EnvironmentTable, OneTexelLightsItsNeighbourhoodAlone) {
    for (const auto& [column, row] : {std::pair{0u, 0u}, {7u, 3u}, {3u, 2u}}) {
        EnvironmentMap map = blackMap(8, 4);
        map.texels[row * 8 + column] = Vec3f(0.0f, 0.0f, 1e-38f);
        const EnvironmentTable table = buildEnvironmentTable(map);
        for (std::uint32_t y = 0; y < 4; ++y)
            for (std::uint32_t x = 0; x < 8; ++x) {
                const std::uint32_t apart = (x + 8 - column) % 8;
                const bool near = (apart <= 1 || apart == 7) && y + 1 >= row && y <= row + 1;
                EXPECT_EQ(table.cells.pdf[y * 8 + x] > 0.0, near) << x << ", " << y;
            }
    }
}

TEST(EnvironmentTable, EveryLitCellIsReached) {
    EnvironmentMap map = blackMap(32, 16);
    map.texels.assign(map.texels.size(), Vec3f(1e-45f)); // the smallest float, beside the largest
    map.texels[100] = Vec3f(std::numeric_limits<float>::max());
    const EnvironmentTable table = buildEnvironmentTable(map);
    EXPECT_TRUE(std::isfinite(table.flux));
    for (const double probability : table.cells.pdf) EXPECT_GT(probability, 0.0);
    EXPECT_NEAR(std::accumulate(table.cells.pdf.begin(), table.cells.pdf.end(), 0.0), 1.0, 1e-12);
}

TEST(EnvironmentTable, ABlackMapHasNone) {
    const EnvironmentTable table = buildEnvironmentTable(blackMap(4, 2));
    EXPECT_TRUE(table.cells.bins.empty());
    EXPECT_TRUE(table.cells.pdf.empty());
    EXPECT_EQ(table.flux, 0.0);
}

} // namespace
} // namespace isolux
