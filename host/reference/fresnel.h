// How much of light a smooth boundary reflects, and where it sends the rest.
#pragma once

#include "core/math.h"

#include <algorithm>
#include <cmath>

namespace isolux {

/// Unpolarised reflectance of a boundary between dielectrics (Born and Wolf 1999, 1.5.2, eq. 21), `cosine` on the side
/// of the light, in [0, 1]; eta = (index beyond)/(index on this side). 1 beyond the angle of total reflection.
template <typename Real> [[nodiscard]] Real dielectricFresnel(Real cosine, Real eta) {
    const Real c = std::min(cosine, Real(1));
    const Real sinSquaredBeyond = (1 - c) * (1 + c) / (eta * eta);
    if (!(sinSquaredBeyond < 1)) return 1;
    const Real beyond = std::sqrt(1 - sinSquaredBeyond);
    const Real perpendicular = (c - eta * beyond) / (c + eta * beyond);
    const Real parallel = (eta * c - beyond) / (eta * c + beyond);
    return (perpendicular * perpendicular + parallel * parallel) / 2;
}

/// (1 - cosine)^5 of Schlick 1994, eq. 15.
template <typename Real> [[nodiscard]] Real schlickWeight(Real cosine) {
    const Real rest = std::clamp(1 - cosine, Real(0), Real(1));
    const Real squared = rest * rest;
    return squared * squared * rest;
}

/// The direction to which `wo` is mirrored at a plane with normal `h`.
template <typename Real> [[nodiscard]] Vec3<Real> reflectAt(const Vec3<Real>& h, const Vec3<Real>& wo) {
    return 2 * glm::dot(wo, h) * h - wo;
}

/// The direction to which `wo` is refracted at a plane with normal `h` on its side (Snell); eta as above. Only where
/// the reflectance is less than 1.
template <typename Real> [[nodiscard]] Vec3<Real> refractAt(const Vec3<Real>& h, const Vec3<Real>& wo, Real eta) {
    const Real c = glm::dot(wo, h);
    const Real sinSquaredBeyond = std::max((1 - c) * (1 + c), Real(0)) / (eta * eta);
    const Real beyond = std::sqrt(std::max(1 - sinSquaredBeyond, Real(0)));
    return (c / eta - beyond) * h - wo / eta;
}

} // namespace isolux
