// A surface's scattering at a point: which lobe is sampled, and the sum of all of them. wo and wi point away from the
// surface, and values include the cosine (scattered.h). Surfaces that are purely Lambertian do not come here:
// scattering.h is theirs.
#pragma once

#include "core/philox.h"
#include "reference/glass.h"
#include "reference/opaque.h"
#include "reference/sampling.h"

#include <cmath>
#include <optional>

namespace isolux {

template <typename Real> class Bsdf {
public:
    /// `wo` above the surface, `side` the one that it lies on.
    Bsdf(const MaterialPoint<Real>& point, const Vec3<Real>& wo, Side side) : wo_(wo), glassShare_(point.transmission) {
        if (glassShare_ < 1) opaque_.emplace(point, wo);
        if (glassShare_ > 0) glass_.emplace(point, wo, side);
    }

    /// The probability that `sample` does not choose a delta lobe.
    [[nodiscard]] Real spreadProbability() const {
        Real probability = 0;
        if (glass_ && !glass_->isDelta()) probability += glassShare_;
        if (opaque_)
            probability += (1 - glassShare_) * (opaque_->hasDeltaSpecular() ? 1 - opaque_->specularProbability() : 1);
        return probability;
    }

    /// All lobes but delta lobes.
    [[nodiscard]] Scattered<Real> evaluate(const Vec3<Real>& wi) const {
        if (wi.z > 0) return evaluateAt(wi, glm::normalize(wo_ + wi));
        return transmitsBroadly() && wi.z < 0 ? evaluateAt(wi, glass_->transmittingMicrofacet(wi)) : Scattered<Real>{};
    }

    /// A direction by the words of a scattering block; none where a lobe leads to the wrong side.
    [[nodiscard]] std::optional<LobeSample<Real>> sample(const PhiloxBlock& words) const {
        const Vec2<Real> uv(unitReal<Real>(words[0]), unitReal<Real>(words[1]));
        const Choice choice = choose(unitReal<Real>(words[3]));
        if (choice.lobe == Lobe::diffuse) {
            const Vec3<Real> wi = sampleCosineHemisphere(uv.x, uv.y);
            return weighed(wi, glm::normalize(wo_ + wi), Lobe::diffuse);
        }
        if (choice.lobe == Lobe::specular) return sampleSpecular(uv);
        return sampleGlass(uv, choice.rest);
    }

    /// The same with uniform directions in the place of every lobe that is no delta lobe: over the side of wo, or over
    /// all where something is transmitted.
    [[nodiscard]] std::optional<LobeSample<Real>> sampleUniformly(const PhiloxBlock& words) const {
        const Vec2<Real> uv(unitReal<Real>(words[0]), unitReal<Real>(words[1]));
        const Choice choice = choose(unitReal<Real>(words[3]));
        const bool specularDelta = choice.lobe == Lobe::specular && opaque_->hasDeltaSpecular();
        const bool glassDelta = choice.lobe == Lobe::glassReflection && glass_->isDelta();
        if (specularDelta) return sampleSpecular(uv);
        if (glassDelta) return sampleGlass(uv, choice.rest);
        const bool everywhere = transmitsBroadly();
        const Vec3<Real> wi = everywhere ? sampleSphere(uv.x, uv.y) : sampleUniformHemisphere(uv.x, uv.y);
        const Real pdf = spreadProbability() / static_cast<Real>((everywhere ? 4 : 2) * kPi);
        const bool through = choice.lobe == Lobe::glassReflection && wi.z < 0;
        return LobeSample<Real>{wi, evaluate(wi).value / pdf, pdf, through ? Lobe::glassTransmission : choice.lobe};
    }

    /// By which the throughput's scaling of radiance changes in a direction below the surface.
    [[nodiscard]] Real radianceScale() const { return glass_ ? glass_->radianceScale() : Real(1); }

private:
    /// A lobe, with glass not yet told apart, and what is left of the number that chose it.
    struct Choice {
        Lobe lobe;
        Real rest;
    };

    [[nodiscard]] bool transmitsBroadly() const { return glass_ && !glass_->isDelta(); }

    [[nodiscard]] Choice choose(Real x) const {
        if (x < glassShare_) return {Lobe::glassReflection, x / glassShare_};
        const Real rest = (x - glassShare_) / (1 - glassShare_);
        return {rest < opaque_->specularProbability() ? Lobe::specular : Lobe::diffuse, rest};
    }

    /// All lobes but delta lobes; `h` is the microfacet that they share.
    [[nodiscard]] Scattered<Real> evaluateAt(const Vec3<Real>& wi, const Vec3<Real>& h) const {
        if (wi.z < 0) return share(glassShare_, glass_->evaluateTransmission(wi, h));
        Scattered<Real> sum;
        if (opaque_) sum = share(1 - glassShare_, opaque_->evaluate(wi, h));
        if (!transmitsBroadly()) return sum;
        const Scattered<Real> glass = share(glassShare_, glass_->evaluateReflection(wi, h));
        return {sum.value + glass.value, sum.pdf + glass.pdf};
    }

    [[nodiscard]] static Scattered<Real> share(Real part, const Scattered<Real>& scattered) {
        return {part * scattered.value, part * scattered.pdf};
    }

    /// A direction found through the microfacet `h`, which is more exact than one found from the direction again.
    [[nodiscard]] std::optional<LobeSample<Real>> weighed(const Vec3<Real>& wi, const Vec3<Real>& h, Lobe lobe) const {
        const bool below = lobe == Lobe::glassTransmission;
        if (below ? !(wi.z < 0) : !(wi.z > 0)) return std::nullopt;
        const Scattered<Real> scattered = evaluateAt(wi, h);
        if (!(scattered.pdf > 0)) return std::nullopt;
        return LobeSample<Real>{wi, scattered.value / scattered.pdf, scattered.pdf, lobe};
    }

    [[nodiscard]] std::optional<LobeSample<Real>> sampleSpecular(const Vec2<Real>& uv) const {
        const Vec3<Real> h = opaque_->sampleSpecular(uv);
        const Vec3<Real> wi = reflectAt(h, wo_);
        if (!opaque_->hasDeltaSpecular()) return weighed(wi, h, Lobe::specular);
        const Vec3<Real> weight = opaque_->mirrorAlbedo() / opaque_->specularProbability();
        return LobeSample<Real>{wi, weight, std::nullopt, Lobe::specular};
    }

    [[nodiscard]] std::optional<LobeSample<Real>> sampleGlass(const Vec2<Real>& uv, Real x) const {
        const Vec3<Real> h = glass_->sampleMicrofacet(uv);
        const bool reflects = x < glass_->reflectance(h);
        const Vec3<Real> wi = reflects ? glass_->reflected(h) : glass_->transmitted(h);
        const Lobe lobe = reflects ? Lobe::glassReflection : Lobe::glassTransmission;
        if (!glass_->isDelta()) return weighed(wi, h, lobe);
        return LobeSample<Real>{wi, reflects ? Vec3<Real>(1) : glass_->transmittance(), std::nullopt, lobe};
    }

    Vec3<Real> wo_;
    Real glassShare_;
    std::optional<OpaquePart<Real>> opaque_;
    std::optional<GlassPart<Real>> glass_;
};

} // namespace isolux
