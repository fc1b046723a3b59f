// The sRGB transfer function (IEC 61966-2-1): what 8-bit image files store instead of linear values.
#pragma once

#include <cmath>

namespace isolux {

/// Encoded value of a linear one in [0, 1].
[[nodiscard]] inline double srgbFromLinear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// Linear value of an encoded one in [0, 1].
[[nodiscard]] inline double linearFromSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

} // namespace isolux
