// From radiance to what a display can show: exposure and tone map, for files of eight bits.
#pragma once

#include "core/math.h"

#include <string_view>

namespace isolux {

enum class Tonemap { none, reinhard, aces, agx, pbrNeutral };

struct DisplayTransform {
    Tonemap tonemap = Tonemap::none;
    double exposure = 0.0; ///< stops: 2^exposure multiplies radiance before the tone map
};

/// Reads none, reinhard, aces, agx or pbr-neutral. Throws Error (bad input).
[[nodiscard]] Tonemap parseTonemap(std::string_view name);

/// The linear Rec. 709 colour, in [0, 1], that a display is to show. Negative radiance counts as 0, infinite as huge.
/// NaN stays NaN, and if the tone map mixes channels it takes the others with it.
[[nodiscard]] Vec3d applyDisplay(const DisplayTransform& transform, const Vec3d& linearRec709);

} // namespace isolux
