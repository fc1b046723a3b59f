// Bounds on accumulated rounding, and points pushed off a surface by such a bound.
#pragma once

#include "core/math.h"

#include <cmath>
#include <limits>

namespace isolux {

/// gamma_n of Higham 2002 (Accuracy and Stability of Numerical Algorithms, 3.1): n roundings in a row change a value by
/// no more than this fraction of it.
template <typename Real> [[nodiscard]] constexpr Real roundingBound(int roundings) {
    constexpr Real kUnitRoundoff = std::numeric_limits<Real>::epsilon() / 2;
    const Real accumulated = static_cast<Real>(roundings) * kUnitRoundoff;
    return accumulated / (1 - accumulated);
}

/// `point`, known to +-`error` per axis, moved along the unit `normal` until it is on that side of every plane with
/// this normal through the box of uncertainty (Pharr, Jakob and Humphreys 2023, 6.8.6).
template <typename Real>
[[nodiscard]] Vec3<Real> offsetPoint(const Vec3<Real>& point, const Vec3<Real>& error, const Vec3<Real>& normal) {
    const Vec3<Real> offset = glm::dot(glm::abs(normal), error) * normal;
    Vec3<Real> moved = point + offset;
    constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (offset[axis] > 0) moved[axis] = std::nextafter(moved[axis], kInfinity);
        if (offset[axis] < 0) moved[axis] = std::nextafter(moved[axis], -kInfinity);
    }
    return moved;
}

} // namespace isolux
