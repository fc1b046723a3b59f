// The GGX distribution of microfacets with Smith's masking: density, shadowing, sampling of visible normals. Directions
// are unit, in a frame about the shading normal, on its side.
#pragma once

#include "core/math.h"

#include <algorithm>
#include <cmath>

namespace isolux {

template <typename Real> struct Ggx {
    Vec2<Real> alpha; ///< along x and y

    explicit Ggx(Real isotropic) : alpha(isotropic) {}
    explicit Ggx(const Vec2<Real>& perAxis) : alpha(perAxis) {}

    /// Density of microfacet normals (Walter et al. 2007, eq. 33; per axis Heitz 2014, eq. 85), without the square of
    /// any cosine, whose difference from 1 would be lost in a narrow lobe.
    [[nodiscard]] Real density(const Vec3<Real>& h) const {
        const Real x = h.x / alpha.x;
        const Real y = h.y / alpha.y;
        const Real sum = (x * x + y * y) + h.z * h.z;
        return 1 / (static_cast<Real>(kPi) * alpha.x * alpha.y * sum * sum);
    }

    /// s of the written conventions: Smith's masking of a direction is 2 |z|/(|z| + s) (Heitz 2014, eq. 72).
    [[nodiscard]] Real slope(const Vec3<Real>& w) const {
        const Real x = alpha.x * w.x;
        const Real y = alpha.y * w.y;
        return std::sqrt(x * x + y * y + w.z * w.z);
    }

    /// Density of the normals visible from `wo` (Heitz 2014, eq. 16).
    [[nodiscard]] Real visibleDensity(const Vec3<Real>& wo, const Vec3<Real>& h) const {
        return 2 * density(h) * std::max(glm::dot(wo, h), Real(0)) / (wo.z + slope(wo));
    }

    /// Density of the direction to which a visible normal reflects `wo`: by 1/(4 wo.h) (Walter et al. 2007, eq. 14).
    [[nodiscard]] Real reflectionPdf(const Vec3<Real>& wo, const Vec3<Real>& h) const {
        return density(h) / (2 * (wo.z + slope(wo)));
    }

    /// Masking and shadowing of both directions, height-correlated, over the masking of `wo` (Heitz 2014, eq. 99): what
    /// a sample of the visible normals weighs. `wi` may lie on either side.
    [[nodiscard]] Real shadowing(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
        const Real out = slope(wo);
        const Real in = std::abs(wi.z);
        return in * (wo.z + out) / (wo.z * slope(wi) + in * out);
    }

    /// A normal visible from `wo`: spherical caps of Dupuy and Benyoub 2023, "Sampling visible GGX normals with
    /// spherical caps".
    [[nodiscard]] Vec3<Real> sampleVisible(const Vec3<Real>& wo, const Vec2<Real>& uv) const {
        const Vec3<Real> w = glm::normalize(Vec3<Real>(alpha.x * wo.x, alpha.y * wo.y, wo.z));
        const Real z = (1 - uv.y) * (1 + w.z) - w.z;
        const Real r = std::sqrt(std::max(1 - z * z, Real(0)));
        const Real phi = static_cast<Real>(2 * kPi) * uv.x;
        const Vec3<Real> sum(r * std::cos(phi) + w.x, r * std::sin(phi) + w.y, z + w.z);
        return glm::normalize(Vec3<Real>(alpha.x * sum.x, alpha.y * sum.y, sum.z));
    }
};

} // namespace isolux
