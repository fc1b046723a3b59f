// The opaque part of a surface: a specular lobe over a diffuse one, which gets what the specular does not reflect.
// Directions are unit, in a frame about the shading normal; wo above the surface.
#pragma once

#include "reference/albedo.h"
#include "reference/fresnel.h"
#include "reference/ggx.h"
#include "reference/material_point.h"
#include "reference/scattered.h"

namespace isolux {

/// Reflectance by Schlick 1994, with what is lost between microfacets given back.
template <typename Real> struct Reflectance {
    Vec3<Real> normal;  ///< at normal incidence
    Vec3<Real> grazing; ///< at grazing

    /// Turquin 2019: `albedo` is that of the lobe where all is reflected.
    [[nodiscard]] static Reflectance compensated(const Vec3<Real>& f0, Real f90, Real albedo) {
        const Vec3<Real> gain = Vec3<Real>(1) + f0 * (1 - albedo) / albedo;
        return {gain * f0, gain * f90};
    }
    /// Where (1 - cosine)^5 is `weight`, or has that mean.
    [[nodiscard]] Vec3<Real> at(Real weight) const { return normal + (grazing - normal) * weight; }
};

template <typename Real> class OpaquePart {
public:
    OpaquePart(const MaterialPoint<Real>& point, const Vec3<Real>& wo)
        : wo_(wo), ggx_(point.alpha), smooth_(isSmooth(point)) {
        const Real albedo = smooth_ ? Real(1) : reflectionAlbedoAt(wo.z, point.alpha);
        const Real rim = smooth_ ? schlickWeight(wo.z) : fresnelAlbedoAt(wo.z, point.alpha);
        const auto coat = Reflectance<Real>::compensated(point.f0, point.f90, albedo);
        const auto metal = Reflectance<Real>::compensated(point.base, Real(1), albedo);
        reflectance_ = {glm::mix(coat.normal, metal.normal, point.metal),
                        glm::mix(coat.grazing, metal.grazing, point.metal)};
        const auto most = [&](const Reflectance<Real>& share) {
            return std::min(maxComponent(share.at(rim)) * albedo, Real(1)); // rounding may leave a little more
        };
        const Real reflected = most(reflectance_);
        // The metal's share has no base below it.
        diffuse_ = (1 - point.metal) * (1 - most(coat)) * point.base;
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
        const Vec3<Real> fresnel = reflectance_.at(schlickWeight(glm::dot(wo_, h)));
        scattered.value += fresnel * (pdf * ggx_.shadowing(wo_, wi));
        scattered.pdf += specularShare_ * pdf;
        return scattered;
    }

    [[nodiscard]] Vec3<Real> sampleSpecular(const Vec2<Real>& uv) const {
        return smooth_ ? Vec3<Real>(0, 0, 1) : ggx_.sampleVisible(wo_, uv);
    }
    /// What a delta specular lobe reflects.
    [[nodiscard]] Vec3<Real> mirrorAlbedo() const { return reflectance_.at(schlickWeight(wo_.z)); }

private:
    [[nodiscard]] static bool isSmooth(const MaterialPoint<Real>& point) {
        return point.alpha < static_cast<Real>(kSmallestAlpha);
    }

    Vec3<Real> wo_;
    Ggx<Real> ggx_;
    bool smooth_;
    Reflectance<Real> reflectance_; ///< of dielectric and metal together
    Vec3<Real> diffuse_;            ///< albedo of the diffuse lobe
    Real specularShare_;
};

} // namespace isolux
