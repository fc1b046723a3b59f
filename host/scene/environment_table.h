// How an environment map is sampled: the definition that both renderers share, with its integer table.
#pragma once

#include "scene/alias_table.h"
#include "scene/scene.h"

namespace isolux {

/// A cell is the part of the sphere that a texel of the map covers. `cells` chooses one, row by row, by the luminance
/// that the bilinear interpolation of the map has in it on the average (README.md, "Environment maps"), times its solid
/// angle.
struct EnvironmentTable {
    AliasTable cells;
    double flux = 0.0; ///< integral of the map's luminance over all directions, sr; `radiance` not counted
};

/// Solid angle of each cell of a row, in sr: exact, as the difference of the cosines at its edges.
[[nodiscard]] double cellSolidAngle(const EnvironmentMap& map, std::uint32_t row);

/// Throws Error for a map of more than 2^28 texels. A map without light has an empty table.
[[nodiscard]] EnvironmentTable buildEnvironmentTable(const EnvironmentMap& map);

} // namespace isolux
