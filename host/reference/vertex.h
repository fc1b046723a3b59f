// A vertex of a path: the surface with its material there, and its scattering in the world. A purely Lambertian surface
// scatters by scattering.h, every other by its Bsdf.
#pragma once

#include "reference/bsdf.h"
#include "reference/medium.h"
#include "reference/scattering.h"
#include "reference/tracing.h"

#include <cstdint>
#include <optional>

namespace isolux {

/// What a direction reflects or transmits: `f` times `cosine`, which of surfaces that are not Lambertian is in `f`
/// already; and the density in solid angle with which scattering finds it.
template <typename Real> struct Response {
    Vec3<Real> f{0};
    Real cosine = 1;
    Real pdf = 0;
};

/// A direction to go on in.
template <typename Real> struct Departure {
    Vec3<Real> wi;
    Vec3<Real> weight;
    std::optional<Real> pdf;  ///< none of a delta lobe
    std::optional<Lobe> lobe; ///< none of a Lambertian surface
    Real radianceScale = 1;   ///< the part of the weight that scales radiance at a refraction
};

/// Keeps a reference to the tracing.
template <typename Real> class Vertex {
public:
    Vertex(const Tracing<Real>& tracing, const Surface<Real>& surface)
        : tracing_(tracing), surface_(surface), point_(tracing.materialPoint(surface)) {
        if (point_.isLambertian()) return;
        frame_ = frameAbout(surface.ns);
        const Vec3<Real> wo = frame_.toLocal(surface.wo);
        bsdf_.emplace(point_, Vec3<Real>(wo.x, wo.y, std::abs(wo.z)), surface.side());
    }

    [[nodiscard]] const Surface<Real>& surface() const { return surface_; }
    [[nodiscard]] const MaterialPoint<Real>& material() const { return point_; }
    /// Whether any direction can be found but those of delta lobes.
    [[nodiscard]] bool scattersBroadly() const { return !bsdf_ || bsdf_->spreadProbability() > 0; }

    /// The medium of the ray that arrived here out of `medium`: at the back of a solid, that solid.
    [[nodiscard]] std::uint32_t mediumBefore(std::uint32_t medium) const {
        return point_.isSolid() && surface_.side() == Side::back ? point_.material : medium;
    }
    /// The medium in the direction of `wi`, `medium` being that on the side of wo.
    [[nodiscard]] std::uint32_t mediumTowards(const Vec3<Real>& wi, std::uint32_t medium) const {
        if (!point_.isSolid() || !transmits(wi)) return medium;
        return surface_.side() == Side::front ? point_.material : kNoMedium;
    }

    /// Delta lobes apart. The geometric normal decides the side, and the shading normal agrees or there is nothing.
    [[nodiscard]] Response<Real> evaluate(const Vec3<Real>& wi) const {
        if (!bsdf_) return evaluateLambertian(wi);
        const Vec3<Real> local = frame_.toLocal(wi);
        if (!agrees(wi, local)) return {};
        const Scattered<Real> scattered = bsdf_->evaluate(local);
        return {scattered.value, 1, scattered.pdf};
    }

    /// None where a path ends for want of light in the direction that was found.
    [[nodiscard]] std::optional<Departure<Real>> scatter(LightSampling sampling, const PhiloxBlock& words) const {
        const bool uniform = sampling == LightSampling::hemisphere;
        if (!bsdf_) return scatterLambertian(uniform, words);
        const std::optional<LobeSample<Real>> sample = uniform ? bsdf_->sampleUniformly(words) : bsdf_->sample(words);
        if (!sample) return std::nullopt;
        const Vec3<Real> wi = glm::normalize(frame_.toWorld(sample->wi));
        if (!agrees(wi, sample->wi)) return std::nullopt;
        const Real scale = sample->transmits() ? bsdf_->radianceScale() : Real(1);
        return Departure<Real>{wi, sample->weight, sample->pdf, sample->lobe, scale};
    }

private:
    [[nodiscard]] bool transmits(const Vec3<Real>& wi) const { return glm::dot(wi, surface_.ns) < 0; }

    [[nodiscard]] bool agrees(const Vec3<Real>& wi, const Vec3<Real>& local) const {
        return local.z > 0 ? tracing_.onOurSide(surface_, wi) : local.z < 0 && tracing_.onTheOtherSide(surface_, wi);
    }

    [[nodiscard]] Response<Real> evaluateLambertian(const Vec3<Real>& wi) const {
        const Real cosine = glm::dot(wi, surface_.ns);
        if (!tracing_.onOurSide(surface_, wi) || !(cosine > 0)) return {};
        return {point_.base / static_cast<Real>(kPi), cosine, cosine / static_cast<Real>(kPi)};
    }

    [[nodiscard]] std::optional<Departure<Real>> scatterLambertian(bool uniform, const PhiloxBlock& words) const {
        const ScatteredDirection<Real> next =
            uniform ? scatterUniformly(surface_, words) : scatterByCosine(surface_, words);
        if (!tracing_.onOurSide(surface_, next.wi)) return std::nullopt;
        return Departure<Real>{next.wi, next.weight * point_.base, next.pdf, std::nullopt};
    }

    const Tracing<Real>& tracing_;
    Surface<Real> surface_;
    MaterialPoint<Real> point_;
    Frame<Real> frame_{};
    std::optional<Bsdf<Real>> bsdf_; ///< none of a Lambertian surface
};

} // namespace isolux
