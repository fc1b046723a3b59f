// Where two images differ, in false colour: brighter is larger, or blue below, white at and red above zero.
#pragma once

#include "core/math.h"
#include "film/image.h"
#include "report/comparison.h"

#include <span>
#include <string>

namespace isolux {

/// What a heatmap shows of each pixel.
enum class HeatmapQuantity {
    flip,   ///< FLIP, from 0 to 1
    relMse, ///< relMSE, from 0 to the value that 99 % of the pixels keep below
    bias,   ///< (a - b) / sqrt(b^2 + 0.01) of luminance, signed; the range holds 99 % of the pixels
    blocks  ///< the z value of the pixel's block, up to the limit of the error budget
};

/// Colours that are ordered by lightness (sequential), or by lightness on either side of the middle (diverging).
enum class Ramp { sequential, diverging };

/// Linear Rec. 709 of t in [0, 1]; beyond that the colour of the end; of NaN green, which is in neither ramp.
[[nodiscard]] Vec3d rampColor(Ramp ramp, double t);

struct Heatmap {
    HeatmapRange range;
    Image image; ///< R, G, B in false colour, and the values themselves as error.Y
};

/// Throws Error (bad input) if the report lacks what is to be shown: FLIP, or blocks where no image carries variance.
[[nodiscard]] Heatmap makeHeatmap(HeatmapQuantity quantity, const Image& image, const Image& reference,
                                  const ComparisonReport& report);

} // namespace isolux
