// Finds out whether any two triangles lie at the same spot: only then must kernels ask whether a ray leaves one for
// another.
#pragma once

#include "pack/device_space.h"

#include <cstdint>
#include <span>

namespace isolux {

enum class Coincidence { none, found, unknown };

struct CoincidentTriangles {
    Coincidence outcome = Coincidence::none; ///< unknown: so many lie close together that looking on would take long
    std::array<std::uint32_t, 2> pair{};     ///< the lower index first, if two were found
};

/// Ends at the first pair; the same for the same triangles. Takes O(n log n).
[[nodiscard]] CoincidentTriangles findCoincident(std::span<const TriangleCorners> triangles);

} // namespace isolux
