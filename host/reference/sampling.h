// The sampling recipes of host/scene/README.md: pure maps from the unit square, and the two heuristics.
#pragma once

#include "core/math.h"

#include <algorithm>
#include <cmath>

namespace isolux {

/// An orthonormal right-handed basis (t, s, n); the names are those of the written conventions.
template <typename Real> struct Frame {
    Vec3<Real> t;
    Vec3<Real> s;
    Vec3<Real> n;

    [[nodiscard]] Vec3<Real> toWorld(const Vec3<Real>& local) const { return local.x * t + local.y * s + local.z * n; }
    [[nodiscard]] Vec3<Real> toLocal(const Vec3<Real>& world) const {
        return {glm::dot(world, t), glm::dot(world, s), glm::dot(world, n)};
    }
};

/// Duff et al. 2017, "Building an orthonormal basis, revisited", with the threshold moved away from common normals.
template <typename Real> [[nodiscard]] Frame<Real> frameAbout(const Vec3<Real>& n) {
    const Real sigma = n.z < Real(-0.38) ? Real(-1) : Real(1);
    const Real a = -1 / (sigma + n.z);
    const Real b = n.x * n.y * a;
    return {Vec3<Real>(1 + sigma * n.x * n.x * a, sigma * b, -sigma * n.x), Vec3<Real>(b, sigma + n.y * n.y * a, -n.y),
            n};
}

/// The concentric map of the square to the unit disk, and from there up to the hemisphere (Malley): z is the height
/// above (x, y). Shirley and Chiu 1997.
template <typename Real> [[nodiscard]] Vec3<Real> sampleCosineHemisphere(Real u, Real v) {
    const Real a = 2 * u - 1;
    const Real b = 2 * v - 1;
    if (a == 0 && b == 0) return {0, 0, 1};
    constexpr Real kQuarterPi = static_cast<Real>(kPi / 4);
    const bool horizontal = std::abs(a) > std::abs(b);
    const Real r = horizontal ? a : b;
    const Real phi = kQuarterPi * (horizontal ? b / a : a / b);
    // On the rim itself the direction would lie in the surface, and a path in 2^23 would end there.
    const Real inside = std::min(std::abs(r), Real(1) - Real(0x1p-24));
    const Real z = std::sqrt((1 - inside) * (1 + inside));
    if (horizontal) return {r * std::cos(phi), r * std::sin(phi), z};
    return {r * std::sin(phi), r * std::cos(phi), z};
}

/// Uniform point on the unit disk, by the same concentric map.
template <typename Real> [[nodiscard]] Vec2<Real> sampleDisk(Real u, Real v) {
    return Vec2<Real>(sampleCosineHemisphere(u, v));
}

/// Uniform direction of the hemisphere about +z; pdf in solid angle 1/(2 pi).
template <typename Real> [[nodiscard]] Vec3<Real> sampleUniformHemisphere(Real u, Real v) {
    const Real r = std::sqrt((1 - u) * (1 + u));
    const Real phi = static_cast<Real>(2 * kPi) * v;
    return {r * std::cos(phi), r * std::sin(phi), u};
}

/// Uniform barycentric coordinates (Heitz 2019, "A low-distortion map between triangle and square").
template <typename Real> [[nodiscard]] Vec3<Real> sampleTriangle(Real u, Real v) {
    const Real half = std::min(u, v) / 2;
    const Real b0 = v > u ? half : u - half;
    const Real b1 = v > u ? v - half : half;
    return {b0, b1, 1 - b0 - b1};
}

/// 1 - cos of half the angle under which a sphere is seen from `distanceSquared`, beyond its radius. No cancellation
/// however small the sphere.
template <typename Real> [[nodiscard]] Real coneHeight(Real radiusSquared, Real distanceSquared) {
    const Real sinSquared = radiusSquared / distanceSquared;
    return sinSquared / (1 + std::sqrt(std::max(Real(0), 1 - sinSquared)));
}

/// Uniform direction in the cone about +z with 1 - cos(half angle) = `height`; pdf in solid angle 1/(2 pi height).
template <typename Real> [[nodiscard]] Vec3<Real> sampleCone(Real height, Real u, Real v) {
    const Real oneMinusCos = u * height;
    const Real sinTheta = std::sqrt(oneMinusCos * (2 - oneMinusCos));
    const Real phi = static_cast<Real>(2 * kPi) * v;
    return {sinTheta * std::cos(phi), sinTheta * std::sin(phi), 1 - oneMinusCos};
}

/// Uniform direction on the whole sphere.
template <typename Real> [[nodiscard]] Vec3<Real> sampleSphere(Real u, Real v) {
    const Real z = 1 - 2 * u;
    const Real r = std::sqrt(std::max(Real(0), (1 - z) * (1 + z)));
    const Real phi = static_cast<Real>(2 * kPi) * v;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Uniform direction about +y, from all directions.
template <typename Real> [[nodiscard]] Vec3<Real> sampleSphereAboutY(Real u, Real v) {
    const Real r = 2 * std::sqrt(u * (1 - u));
    const Real phi = static_cast<Real>(2 * kPi) * v;
    return {r * std::cos(phi), 1 - 2 * u, r * std::sin(phi)};
}

/// Uniform direction with y > 0.
template <typename Real> [[nodiscard]] Vec3<Real> sampleUpperHalf(Real u, Real v) {
    const Real r = std::sqrt(u * (2 - u));
    const Real phi = static_cast<Real>(2 * kPi) * v;
    return {r * std::cos(phi), 1 - u, r * std::sin(phi)};
}

/// Weight of a sample drawn with pdf `f` that could have been drawn with pdf `g` (Veach 1997, eq. 9.13, beta 2). By the
/// ratio, since squares of large pdfs overflow.
template <typename Real> [[nodiscard]] Real powerHeuristic(Real f, Real g) {
    if (g <= f) {
        const Real ratio = g / f;
        return 1 / (1 + ratio * ratio);
    }
    const Real ratio = f / g;
    return ratio * ratio / (1 + ratio * ratio);
}

/// The same by f/(f + g) (Veach 1997, eq. 9.8).
template <typename Real> [[nodiscard]] Real balanceHeuristic(Real f, Real g) {
    if (g <= f) return 1 / (1 + g / f);
    const Real ratio = f / g;
    return ratio / (1 + ratio);
}

} // namespace isolux
