// The opaque part of a surface: a specular lobe over a diffuse one, which gets what the specular does not reflect.
// Directions are unit, in a frame about the shading normal; wo above the surface.
#pragma once

#include "reference/albedo.h"
#include "reference/fresnel.h"
#include "reference/ggx.h"
#include "reference/material_point.h"
#include "reference/scattered.h"

namespace isolux {

template <typename Real> class OpaquePart {
public:
    OpaquePart(const MaterialPoint<Real>& point, const Vec3<Real>& wo)
        : wo_(wo), ggx_(point.alpha), f0_(point.f0), f90_(point.f90), smooth_(isSmooth(point)) {
        const Real albedo = smooth_ ? Real(1) : reflectionAlbedoAt(wo.z, point.alpha);
        const Real rim = smooth_ ? schlickWeight(wo.z) : fresnelAlbedoAt(wo.z, point.alpha);
        const auto compensation = [&](const Vec3<Real>& f0) { return Real(1) + f0 * (1 / albedo - 1); };
        const auto most = [&](const Vec3<Real>& f0, Real f90) {
            const Vec3<Real> reflected = compensation(f0) * (f0 + (Vec3<Real>(f90) - f0) * rim) * albedo;
            return std::min(maxComponent(reflected), Real(1)); // rounding may leave a little more
        };
        compensation_ = compensation(f0_);
        const Real reflected = most(f0_, f90_);
        // The metal's share has no base below it.
        diffuse_ = (1 - point.metal) * (1 - most(point.coatF0, point.coatF90)) * point.base;
        const Real rest = maxComponent(diffuse_);
        specularShare_ = reflected > 0 ? reflected / (reflected + rest) : Real(0);
    }

    /// The probability of choosing the specular lobe, given that the opaque part is.
    [[nodiscard]] Real specularProbability() const { return specularShare_; }
    [[nodiscard]] bool hasDeltaSpecular() const { return smooth_; }

    /// f times cosine of both lobes, delta lobes apart, and the density of what they sample; `wi` above the surface, h
    /// half-way.
    [[nodiscard]] Scattered<Real> evaluate(const Vec3<Real>& wi, const Vec3<Real>& h) const {
        const Real cosine = wi.z / static_cast<Real>(kPi);
        Scattered<Real> scattered{diffuse_ * cosine, (1 - specularShare_) * cosine};
        if (smooth_ || specularShare_ == 0) return scattered;
        const Real pdf = ggx_.reflectionPdf(wo_, h);
        const Vec3<Real> fresnel = schlickFresnel(f0_, f90_, glm::dot(wo_, h));
        scattered.value += compensation_ * fresnel * (pdf * ggx_.shadowing(wo_, wi));
        scattered.pdf += specularShare_ * pdf;
        return scattered;
    }

    [[nodiscard]] Vec3<Real> sampleSpecular(const Vec2<Real>& uv) const {
        return smooth_ ? Vec3<Real>(0, 0, 1) : ggx_.sampleVisible(wo_, uv);
    }
    /// What a delta specular lobe reflects.
    [[nodiscard]] Vec3<Real> mirrorAlbedo() const { return schlickFresnel(f0_, f90_, wo_.z); }

private:
    [[nodiscard]] static bool isSmooth(const MaterialPoint<Real>& point) {
        return point.alpha < static_cast<Real>(kSmallestAlpha);
    }

    Vec3<Real> wo_;
    Ggx<Real> ggx_;
    Vec3<Real> f0_;
    Real f90_;
    bool smooth_;
    Vec3<Real> compensation_; ///< for light lost between microfacets (Turquin 2019)
    Vec3<Real> diffuse_;      ///< albedo of the diffuse lobe
    Real specularShare_;
};

} // namespace isolux
