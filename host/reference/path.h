// One path: the six steps of "One path" in host/scene/README.md.
#pragma once

#include "reference/lights.h"
#include "reference/scattering.h"
#include "reference/tracing.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace isolux {

/// Follows paths through a scene. Keeps references; safe to use from many threads.
template <typename Real> class PathTracer {
public:
    PathTracer(const Scene& scene, const World<Real>& world, const RenderSettings& settings,
               const Tracing<Real>& tracing)
        : environment_(scene.environment), settings_(settings), counted_(countedBounces(settings)), tracing_(tracing),
          lights_(scene, world, settings) {}

    [[nodiscard]] PathResult<Real> trace(const SampleStream& stream) const {
        Path path{tracing_.cameraRay(stream)};
        for (std::uint32_t bounce = 0;; ++bounce) {
            const std::optional<Surface<Real>> surface = tracing_.findSurface(path.ray, path.result);
            if (!surface) {
                addEnvironment(path, bounce);
                break;
            }
            if (bounce == 0) tracing_.noteFirstHit(path.result, *surface);
            addEmission(path, *surface, bounce);
            if (bounce == counted_.last) break;
            if (counts(bounce + 1)) addDirectLight(path, *surface, stream, bounce);
            const PhiloxBlock words = stream.block(2 + 2 * bounce);
            if (scatter(path, *surface, words) == Fate::ends) break;
            if (bounce + 1 >= settings_.roulette.start && roulette(path, words[2]) == Fate::ends) break;
        }
        return path.result;
    }

private:
    enum class Fate { goesOn, ends };

    struct Path {
        Ray<Real> ray;
        Vec3<Real> throughput{1};
        Real pdf = 0; ///< solid angle, of the ray's direction; unused for the camera ray
        PathResult<Real> result{};
    };

    /// Whether light of so many bounces counts. No path is longer than the last that do.
    [[nodiscard]] bool counts(std::uint32_t bounce) const { return bounce >= counted_.first; }

    [[nodiscard]] Real misWeight(Real f, Real g) const {
        return settings_.misHeuristic == MisHeuristic::power ? powerHeuristic(f, g) : balanceHeuristic(f, g);
    }
    /// Of emission that a scattered ray met and that light sampling could have chosen.
    [[nodiscard]] Real weightOfScattering(Real pdf, Real lightPdf) const {
        return settings_.lightSampling == LightSampling::light ? Real(0) : misWeight(pdf, lightPdf);
    }
    [[nodiscard]] Real weightOfLight(const LightSample<Real>& light, Real scatteringPdf) const {
        const bool onlyWay = light.measure == Measure::discrete || settings_.lightSampling == LightSampling::light;
        return onlyWay ? Real(1) : misWeight(light.pdf, scatteringPdf);
    }

    /// What the camera sees beyond every surface counts as met, so that it is opaque.
    void addEnvironment(Path& path, std::uint32_t bounce) const {
        const Vec3<Real> radiance = environmentRadiance(environment_, path.ray.direction);
        if (radiance == Vec3<Real>(0)) return;
        if (bounce == 0) path.result.cameraHits = 1;
        if (!counts(bounce)) return;
        const bool onlyWay = bounce == 0 || !lights_.containsEnvironment();
        const Real weight = onlyWay ? Real(1) : weightOfScattering(path.pdf, lights_.pdfOfEnvironment());
        path.result.radiance += path.throughput * radiance * weight;
    }

    void addEmission(Path& path, const Surface<Real>& surface, std::uint32_t bounce) const {
        const Vec3<Real> emission = emissionFrom<Real>(tracing_.materialAt(surface), surface.side());
        if (emission == Vec3<Real>(0) || !counts(bounce)) return;
        const bool onlyWay = bounce == 0 || !lights_.contains(surface.primitive);
        const Real weight = onlyWay ? Real(1) : weightOfScattering(path.pdf, lights_.pdf(path.ray.origin, surface));
        path.result.radiance += path.throughput * emission * weight;
    }

    /// f of the written conventions: Lambertian, without the cosine. The geometric normal decides the side.
    [[nodiscard]] Vec3<Real> evaluate(const Surface<Real>& surface, const Vec3<Real>& wi) const {
        const bool reflects = tracing_.onOurSide(surface, wi) && glm::dot(wi, surface.ns) > 0;
        const Vec3<Real> baseColor(tracing_.materialAt(surface).baseColor);
        return reflects ? baseColor / static_cast<Real>(kPi) : Vec3<Real>(0);
    }

    void addDirectLight(Path& path, const Surface<Real>& surface, const SampleStream& stream,
                        std::uint32_t bounce) const {
        for (std::uint32_t index = 0; index < lights_.sampleCount(); ++index)
            addLight(path, surface, lights_.sample(surface, stream.block(lightBlock(bounce, index)), index));
    }

    /// The number of the block of light sample `index` at a bounce.
    [[nodiscard]] std::uint32_t lightBlock(std::uint32_t bounce, std::uint32_t index) const {
        constexpr std::uint32_t kFurther = 0x80000000u;
        return index == 0 ? 1 + 2 * bounce : kFurther | (bounce * lights_.sampleCount() + index);
    }

    void addLight(Path& path, const Surface<Real>& surface, std::optional<LightSample<Real>> light) const {
        const Vec3<Real> f = light ? evaluate(surface, light->wi) : Vec3<Real>(0);
        if (f == Vec3<Real>(0)) return path.result.record(PathEvent::noRay);
        light->shadowRay.origin = surface.originTowards(light->wi);
        if (tracing_.visibility(light->shadowRay, light->primitive, path.result) == Visibility::blocked) return;
        const Real cosine = glm::dot(light->wi, surface.ns);
        const Real weight = weightOfLight(*light, cosine / static_cast<Real>(kPi));
        path.result.radiance += path.throughput * f * light->emission * (cosine / light->pdf * weight);
    }

    [[nodiscard]] Fate scatter(Path& path, const Surface<Real>& surface, const PhiloxBlock& words) const {
        const bool uniform = settings_.lightSampling == LightSampling::hemisphere;
        const ScatteredDirection<Real> next =
            uniform ? scatterUniformly(surface, words) : scatterByCosine(surface, words);
        path.ray = {surface.originTowards(next.wi), next.wi};
        path.pdf = next.pdf;
        path.throughput *= next.weight * Vec3<Real>(tracing_.materialAt(surface).baseColor);
        const bool alive = tracing_.onOurSide(surface, next.wi) && path.throughput != Vec3<Real>(0);
        return alive ? Fate::goesOn : Fate::ends;
    }

    /// The probability with which the path goes on.
    [[nodiscard]] Real survival(const Path& path) const {
        switch (settings_.roulette.kind) {
        case Roulette::off: return 1;
        case Roulette::constant: return static_cast<Real>(1.0 - settings_.roulette.termination);
        case Roulette::throughput: return std::min(maxComponent(path.throughput), static_cast<Real>(kMaxSurvival));
        }
        return 1;
    }

    [[nodiscard]] Fate roulette(Path& path, std::uint32_t word) const {
        const Real q = survival(path);
        if (unitReal<Real>(word) < q) { // always if q = 1
            path.throughput /= q;
            return Fate::goesOn;
        }
        path.result.record(PathEvent::endedByRoulette);
        return Fate::ends;
    }

    const Environment& environment_;
    RenderSettings settings_;
    BounceRange counted_;
    const Tracing<Real>& tracing_;
    Lights<Real> lights_;
};

} // namespace isolux
