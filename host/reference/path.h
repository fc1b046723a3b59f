// One path: the six steps of "One path" in host/scene/README.md.
#pragma once

#include "reference/lights.h"
#include "reference/vertex.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace isolux {

/// Blocks of words for the cells of environment maps.
inline constexpr std::uint32_t kCellBlocks = 0x40000000u;

/// Follows paths through a scene. Keeps references; safe to use from many threads.
template <typename Real> class PathTracer {
public:
    PathTracer(const Scene& scene, const World<Real>& world, const RenderSettings& settings,
               const Tracing<Real>& tracing)
        : scene_(scene), settings_(settings), counted_(countedBounces(settings)), tracing_(tracing),
          lights_(scene, world, settings) {}

    [[nodiscard]] PathResult<Real> trace(const SampleStream& stream) const {
        Path path{tracing_.cameraRay(stream)};
        for (std::uint32_t bounce = 0;; ++bounce) {
            const std::optional<Surface<Real>> surface =
                tracing_.findSurface(path.ray, tracing_.presence(stream, 2 * bounce), path.result);
            if (!surface) {
                addEnvironment(path, bounce);
                break;
            }
            if (bounce == 0) tracing_.noteFirstHit(path.result, *surface);
            const Vertex<Real> vertex(tracing_, *surface);
            absorb(path, vertex);
            if (addEmission(path, vertex, bounce) == Fate::ends || bounce == counted_.last) break;
            if (counts(bounce + 1) && vertex.scattersBroadly()) addDirectLight(path, vertex, stream, bounce);
            const PhiloxBlock words = stream.block(2 + 2 * bounce);
            const Real before = path.carried();
            if (scatter(path, vertex, words) == Fate::ends) break;
            if (bounce + 1 < settings_.roulette.start) continue;
            if (roulette(path, survival(path, before), words[2]) == Fate::ends) break;
        }
        return path.result;
    }

private:
    enum class Fate { goesOn, ends };

    struct Path {
        Ray<Real> ray;
        Vec3<Real> throughput{1};
        std::optional<Real> pdf{}; ///< solid angle, of the ray's direction; none if no other way leads there
        std::uint32_t medium = kNoMedium;
        Real radianceScale = 1; ///< what refractions have scaled the throughput by
        PathResult<Real> result{};

        /// Without the scaling of radiance at refractions, which a path undoes when it leaves the solid.
        [[nodiscard]] Real carried() const { return maxComponent(throughput) / radianceScale; }
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
        const Vec3<Real>& direction = path.ray.direction;
        const Vec3<Real> radiance = lights_.radianceOfEnvironment(direction);
        if (radiance == Vec3<Real>(0)) return;
        if (bounce == 0) path.result.cameraHits = 1;
        if (!counts(bounce)) return;
        const bool onlyWay = !path.pdf || !lights_.containsEnvironment();
        const Real weight = onlyWay ? Real(1) : weightOfScattering(*path.pdf, lights_.pdfOfEnvironment(direction));
        path.result.radiance += path.throughput * radiance * weight;
    }

    /// What the solid in which the ray ran has left of the path.
    void absorb(Path& path, const Vertex<Real>& vertex) const {
        path.medium = vertex.mediumBefore(path.medium);
        if (path.medium != kNoMedium) path.throughput *= transmittanceIn(scene_, path.medium, vertex.surface().t);
    }

    /// Unlit surfaces end a path.
    [[nodiscard]] Fate addEmission(Path& path, const Vertex<Real>& vertex, std::uint32_t bounce) const {
        const Surface<Real>& surface = vertex.surface();
        if (tracing_.materialAt(surface).unlit) {
            if (counts(bounce)) path.result.radiance += path.throughput * vertex.material().base;
            return Fate::ends;
        }
        const Vec3<Real> emission = emissionAt(tracing_.attributes(), surface.place(), surface.side());
        if (emission == Vec3<Real>(0) || !counts(bounce)) return Fate::goesOn;
        const bool onlyWay = !path.pdf || !lights_.contains(surface.primitive);
        const Real weight = onlyWay ? Real(1) : weightOfScattering(*path.pdf, lights_.pdf(path.ray.origin, surface));
        path.result.radiance += path.throughput * emission * weight;
        return Fate::goesOn;
    }

    void addDirectLight(Path& path, const Vertex<Real>& vertex, const SampleStream& stream,
                        std::uint32_t bounce) const {
        for (std::uint32_t index = 0; index < lights_.sampleCount(); ++index) {
            const std::uint32_t block = lightBlock(bounce, index);
            const PhiloxBlock cellWords = lights_.hasMap() ? stream.block(kCellBlocks ^ block) : PhiloxBlock{};
            const auto light = lights_.sample(vertex.surface(), stream.block(block), index, cellWords);
            const Response<Real> response = light ? vertex.evaluate(light->wi) : Response<Real>{};
            if (response.f == Vec3<Real>(0))
                path.result.record(PathEvent::noRay);
            else
                addLight(path, vertex, response, *light, tracing_.presence(stream, block));
        }
    }

    /// The number of the block of light sample `index` at a bounce.
    [[nodiscard]] std::uint32_t lightBlock(std::uint32_t bounce, std::uint32_t index) const {
        constexpr std::uint32_t kFurther = 0x80000000u;
        return index == 0 ? 1 + 2 * bounce : kFurther | (bounce * lights_.sampleCount() + index);
    }

    /// The ray to a light, which was sampled from the side of wo, from the side on which it leaves to the same point.
    [[nodiscard]] static Ray<Real> shadowRay(const Surface<Real>& surface, const LightSample<Real>& light) {
        const Ray<Real>& ray = light.shadowRay;
        const Vec3<Real> origin = surface.originTowards(light.wi);
        if (origin == ray.origin || !std::isfinite(ray.tMax)) return {origin, ray.direction, ray.tMax};
        const Vec3<Real> way = ray.origin + ray.tMax * ray.direction - origin;
        const Real distance = glm::length(way);
        return {origin, way / distance, distance};
    }

    void addLight(Path& path, const Vertex<Real>& vertex, const Response<Real>& response,
                  const LightSample<Real>& light, const std::optional<Presence<Real>>& presence) const {
        const Ray<Real> ray = shadowRay(vertex.surface(), light);
        if (tracing_.visibility(ray, light.primitive, presence, path.result) == Visibility::blocked) return;
        const std::uint32_t medium = vertex.mediumTowards(light.wi, path.medium);
        const Vec3<Real> arriving = light.emission * transmittanceIn(scene_, medium, ray.tMax);
        const Real weight = weightOfLight(light, response.pdf);
        path.result.radiance += path.throughput * response.f * arriving * (response.cosine / light.pdf * weight);
    }

    [[nodiscard]] Fate scatter(Path& path, const Vertex<Real>& vertex, const PhiloxBlock& words) const {
        const std::optional<Departure<Real>> next = vertex.scatter(settings_.lightSampling, words);
        if (!next) return Fate::ends;
        path.ray = {vertex.surface().originTowards(next->wi), next->wi};
        path.pdf = next->pdf;
        path.medium = vertex.mediumTowards(next->wi, path.medium);
        path.throughput *= next->weight;
        path.radianceScale *= next->radianceScale;
        if (path.throughput == Vec3<Real>(0)) return Fate::ends;
        if (next->lobe) path.result.record(*next->lobe);
        return Fate::goesOn;
    }

    /// The probability with which the path goes on, which carried `before` until it was scattered.
    [[nodiscard]] Real survival(const Path& path, Real before) const {
        switch (settings_.roulette.kind) {
        case Roulette::off: return 1;
        case Roulette::constant: return static_cast<Real>(1.0 - settings_.roulette.termination);
        case Roulette::throughput: return survivalByThroughput(path.carried(), path.carried() / before);
        }
        return 1;
    }

    /// kMaxSurvival says why. `share`: of what was carried, left by the last bounce.
    [[nodiscard]] static Real survivalByThroughput(Real carried, Real share) {
        const Real most = static_cast<Real>(kMaxSurvival);
        return std::min(carried, share <= static_cast<Real>(kLossless) ? std::max(share, most) : most);
    }

    [[nodiscard]] Fate roulette(Path& path, Real q, std::uint32_t word) const {
        if (unitReal<Real>(word) < q) { // always if q = 1
            path.throughput /= q;
            return Fate::goesOn;
        }
        path.result.record(PathEvent::endedByRoulette);
        return Fate::ends;
    }

    const Scene& scene_;
    RenderSettings settings_;
    BounceRange counted_;
    const Tracing<Real>& tracing_;
    Lights<Real> lights_;
};

} // namespace isolux
