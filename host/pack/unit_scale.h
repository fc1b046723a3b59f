// The powers of two that bring radiance near 1.
#pragma once

#include <algorithm>
#include <cmath>

namespace isolux {

/// What brings `largest` to (1/2, 1], but never so much or little that single precision lacks it or its inverse; 1 for
/// 0.
[[nodiscard]] inline double unitScale(double largest) {
    constexpr double kNormalExponents = 126.0;
    if (!(largest > 0.0)) return 1.0;
    return std::exp2(std::clamp(-std::ceil(std::log2(largest)), -kNormalExponents, kNormalExponents));
}

} // namespace isolux
