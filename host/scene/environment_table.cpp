#include "scene/environment_table.h"

#include "core/error.h"

#include <fmt/format.h>

#include <array>

namespace isolux {
namespace {

constexpr std::uint64_t kMaxTexels = std::uint64_t{1} << 28; // as many as an alias table has items

/// Luminance of every texel, in double: the sum over a cell's neighbours must not overflow.
std::vector<double> texelLuminances(const EnvironmentMap& map) {
    std::vector<double> luminances;
    luminances.reserve(map.texels.size());
    for (const Vec3f& texel : map.texels) luminances.push_back(luminance(Vec3d(texel)));
    return luminances;
}

/// The row that lies at `row` - 1, `row` and `row` + 1, clamped to the map.
std::array<std::size_t, 3> neighbourRows(const EnvironmentMap& map, std::size_t row) {
    return {row == 0 ? 0 : row - 1, row, std::min<std::size_t>(row + 1, map.height - 1)};
}

/// What the bilinear interpolation of one row of `luminances` has between the edges of a column, on the average.
double meanAlongRow(const double* row, std::size_t column, std::size_t width) {
    const std::size_t left = column == 0 ? width - 1 : column - 1;
    const std::size_t right = column + 1 == width ? 0 : column + 1;
    return (row[left] + 6.0 * row[column] + row[right]) / 8.0;
}

/// A tent over a unit cell covers it with 3/4 and each neighbour with 1/8: 1 : 6 : 1 in both ways.
std::vector<double> cellWeights(const EnvironmentMap& map) {
    const std::vector<double> luminances = texelLuminances(map);
    std::vector<double> weights;
    weights.reserve(luminances.size());
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const std::array<std::size_t, 3> rows = neighbourRows(map, y);
        const double solidAngle = cellSolidAngle(map, y);
        for (std::size_t x = 0; x < map.width; ++x) {
            const auto mean = [&](std::size_t row) { return meanAlongRow(&luminances[row * map.width], x, map.width); };
            weights.push_back(solidAngle * (mean(rows[0]) + 6.0 * mean(rows[1]) + mean(rows[2])) / 8.0);
        }
    }
    return weights;
}

} // namespace

double cellSolidAngle(const EnvironmentMap& map, std::uint32_t row) {
    // cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2): no cancellation at the poles.
    const double middle = kPi * (row + 0.5) / map.height;
    const double half = kPi * 0.5 / map.height;
    return 2.0 * kPi / map.width * 2.0 * std::sin(middle) * std::sin(half);
}

EnvironmentTable buildEnvironmentTable(const EnvironmentMap& map) {
    if (map.texels.size() > kMaxTexels)
        throwBadInput(fmt::format("environment map '{}'", map.name),
                      fmt::format("{} texels are more than {}", map.texels.size(), kMaxTexels));
    const std::vector<double> weights = cellWeights(map);
    EnvironmentTable table;
    table.cells = buildAliasTable(weights);
    for (const double weight : weights) table.flux += weight;
    return table;
}

} // namespace isolux
