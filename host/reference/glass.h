// The glass part of a surface: a dielectric boundary that reflects by Fresnel's formulas and transmits the rest, into a
// solid by refraction (Walter et al. 2007), through a thin wall straight. Directions as in scattered.h.
#pragma once

#include "reference/albedo.h"
#include "reference/fresnel.h"
#include "reference/ggx.h"
#include "reference/material_point.h"
#include "reference/scattered.h"

namespace isolux {

template <typename Real> class GlassPart {
public:
    GlassPart(const MaterialPoint<Real>& point, const Vec3<Real>& wo, Side side)
        : wo_(wo), ggx_(point.alpha), base_(point.base), body_(point.body), smooth_(isSmooth(point)) {
        eta_ = body_ == Body::solid && side == Side::back ? 1 / point.ior : point.ior;
        if (!smooth_) compensation_ = 1 / albedo(point, side);
    }

    [[nodiscard]] bool isDelta() const { return smooth_; }
    /// What a microfacet reflects.
    [[nodiscard]] Real reflectance(const Vec3<Real>& h) const {
        return dielectricFresnel(std::abs(glm::dot(wo_, h)), eta_);
    }
    /// What a ray's throughput is multiplied with when it is transmitted without loss: the tint, and in a solid the
    /// scaling of radiance.
    [[nodiscard]] Vec3<Real> transmittance() const { return base_ * radianceScale(); }
    /// 1/eta^2 where radiance is refracted (Veach 1997, 5.2).
    [[nodiscard]] Real radianceScale() const { return body_ == Body::solid ? 1 / (eta_ * eta_) : Real(1); }

    [[nodiscard]] Vec3<Real> sampleMicrofacet(const Vec2<Real>& uv) const {
        return smooth_ ? Vec3<Real>(0, 0, 1) : ggx_.sampleVisible(wo_, uv);
    }
    [[nodiscard]] Vec3<Real> reflected(const Vec3<Real>& h) const { return reflectAt(h, wo_); }
    [[nodiscard]] Vec3<Real> transmitted(const Vec3<Real>& h) const {
        return body_ == Body::solid ? refractAt(h, wo_, eta_) : mirrored(reflectAt(h, wo_));
    }

    /// The microfacet that transmits from `wi`, below the surface, to wo.
    [[nodiscard]] Vec3<Real> transmittingMicrofacet(const Vec3<Real>& wi) const {
        if (body_ == Body::wall) return glm::normalize(wo_ + mirrored(wi));
        const Vec3<Real> h = glm::normalize(wo_ + eta_ * wi);
        return h.z < 0 ? -h : h;
    }

    /// Of a rough surface: `wi` above it, h half-way.
    [[nodiscard]] Scattered<Real> evaluateReflection(const Vec3<Real>& wi, const Vec3<Real>& h) const {
        const Real pdf = reflectance(h) * ggx_.reflectionPdf(wo_, h);
        return {Vec3<Real>(compensation_ * pdf * ggx_.shadowing(wo_, wi)), pdf};
    }

    /// Of a rough surface: `wi` below it, h the microfacet above.
    [[nodiscard]] Scattered<Real> evaluateTransmission(const Vec3<Real>& wi, const Vec3<Real>& h) const {
        const Real pdf = (1 - reflectance(h)) * transmissionPdf(wi, h);
        return {transmittance() * (compensation_ * pdf * ggx_.shadowing(wo_, wi)), pdf};
    }

private:
    [[nodiscard]] static Vec3<Real> mirrored(const Vec3<Real>& w) { return {w.x, w.y, -w.z}; }

    /// Microfacets of a solid that differ little in index bend little, however rough.
    [[nodiscard]] static bool isSmooth(const MaterialPoint<Real>& point) {
        const Real smallest = static_cast<Real>(kSmallestAlpha);
        return point.alpha < smallest || (point.isSolid() && point.alpha * std::abs(point.ior - 1) < smallest);
    }

    [[nodiscard]] Real albedo(const MaterialPoint<Real>& point, Side side) const {
        if (body_ == Body::wall) return reflectionAlbedoAt(wo_.z, point.alpha);
        return glassAlbedoAt(wo_.z, point.alpha, point.ior, side);
    }

    /// Density of the direction to which a visible normal transmits wo; by eq. 17 of Walter et al. 2007 for a solid.
    [[nodiscard]] Real transmissionPdf(const Vec3<Real>& wi, const Vec3<Real>& h) const {
        if (body_ == Body::wall) return ggx_.reflectionPdf(wo_, h);
        const Real out = glm::dot(wo_, h), in = glm::dot(wi, h);
        if (!(out > 0 && in < 0)) return 0; // the microfacet does not face both
        const Real sum = out + eta_ * in;
        return ggx_.visibleDensity(wo_, h) * eta_ * eta_ * -in / (sum * sum);
    }

    Vec3<Real> wo_;
    Ggx<Real> ggx_;
    Vec3<Real> base_;
    Body body_;
    bool smooth_;
    Real eta_ = 1;          ///< (index beyond)/(index on the side of wo)
    Real compensation_ = 1; ///< for light lost between microfacets
};

} // namespace isolux
