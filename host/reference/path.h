// One path: the six steps of "One path" in host/scene/README.md.
#pragma once

#include "film/film.h"
#include "reference/camera.h"
#include "reference/lights.h"

#include <cstdint>
#include <optional>

namespace isolux {

/// What one sample of one pixel leaves.
template <typename Real> struct PathResult {
    Vec3<Real> radiance{0};
    std::uint32_t signature = 2166136261u; ///< FNV-1a of the path's discrete events
    std::uint64_t rays = 0;
    std::uint64_t cameraHits = 0; ///< 1 if the camera ray met a surface, or an environment that emits there
    std::optional<FirstHit> firstHit;

    void record(std::uint32_t event) { signature = (signature ^ event) * 16777619u; }
};

/// Follows paths through a scene. Keeps references; safe to use from many threads.
template <typename Real> class PathTracer {
public:
    PathTracer(const Scene& scene, const World<Real>& world, const RenderSettings& settings,
               const ReferenceOptions& options)
        : scene_(scene), world_(world), settings_(settings), sides_(options.sides),
          camera_(scene.cameras[settings.camera], settings), caster_(world, settings.intersection),
          lights_(scene, world) {}

    [[nodiscard]] PathResult<Real> trace(std::uint32_t x, std::uint32_t y, std::uint32_t sample) const {
        const Stream stream{settings_.seed, x, y, sample};
        Path path = start(stream);
        for (std::uint32_t bounce = 0;; ++bounce) {
            const std::optional<Surface<Real>> surface = findSurface(path);
            if (!surface) {
                addEnvironment(path, bounce);
                break;
            }
            if (bounce == 0) noteFirstHit(path.result, *surface);
            addEmission(path, *surface, bounce);
            if (bounce == settings_.maxDepth) break;
            if (!lights_.empty()) addDirectLight(path, *surface, stream.block(1 + 2 * bounce));
            const PhiloxBlock words = stream.block(2 + 2 * bounce);
            if (scatter(path, *surface, words) == Fate::ends) break;
            if (bounce + 1 >= settings_.roulette.start && roulette(path, words[2]) == Fate::ends) break;
        }
        return path.result;
    }

private:
    enum class Fate { goesOn, ends };

    struct Stream {
        std::uint64_t seed;
        std::uint32_t x, y, sample;
        [[nodiscard]] PhiloxBlock block(std::uint32_t index) const { return randomBlock(seed, x, y, sample, index); }
    };

    struct Path {
        Ray<Real> ray;
        Vec3<Real> throughput{1};
        Real pdf = 0; ///< solid angle, of the ray's direction; unused for the camera ray
        PathResult<Real> result{};
    };

    [[nodiscard]] Path start(const Stream& stream) const {
        const PhiloxBlock words = stream.block(0);
        return {camera_.through(stream.x, stream.y, unitReal<Real>(words[0]), unitReal<Real>(words[1]))};
    }

    [[nodiscard]] const Material& materialAt(const Surface<Real>& surface) const {
        return scene_.materials[surface.material];
    }

    [[nodiscard]] std::optional<Surface<Real>> findSurface(Path& path) const {
        ++path.result.rays;
        const std::optional<Hit<Real>> hit = caster_.nearest(path.ray);
        path.result.record(hit ? hit->primitive : kNoPrimitive);
        if (!hit) return std::nullopt;
        Surface<Real> surface = surfaceAt(world_, path.ray, *hit);
        if (sides_ == SideRule::shading && glm::dot(surface.ns, surface.wo) < 0) surface.ns = -surface.ns;
        return surface;
    }

    /// Whether scattering reaches a direction as far as the geometric normal is asked.
    [[nodiscard]] bool onOurSide(const Surface<Real>& surface, const Vec3<Real>& wi) const {
        return sides_ == SideRule::shading || glm::dot(wi, surface.facing) > 0;
    }

    void noteFirstHit(PathResult<Real>& result, const Surface<Real>& surface) const {
        result.cameraHits = 1;
        result.firstHit =
            FirstHit{materialAt(surface).baseColor, Vec3d(surface.ns),
                     static_cast<double>(camera_.depth(surface.position)), world_.objectOf(surface.primitive)};
    }

    /// What the camera sees beyond every surface counts as met, so that it is opaque.
    void addEnvironment(Path& path, std::uint32_t bounce) const {
        const Vec3<Real> radiance = environmentRadiance(scene_.environment, path.ray.direction);
        if (radiance == Vec3<Real>(0)) return;
        if (bounce == 0) path.result.cameraHits = 1;
        const bool onlyWay = bounce == 0 || !lights_.containsEnvironment();
        const Real weight = onlyWay ? Real(1) : powerHeuristic(path.pdf, lights_.pdfOfEnvironment());
        path.result.radiance += path.throughput * radiance * weight;
    }

    void addEmission(Path& path, const Surface<Real>& surface, std::uint32_t bounce) const {
        const Vec3<Real> emission = emissionFrom<Real>(materialAt(surface), surface.side());
        if (emission == Vec3<Real>(0)) return;
        const bool onlyWay = bounce == 0 || !lights_.contains(surface.primitive);
        const Real weight = onlyWay ? Real(1) : powerHeuristic(path.pdf, lights_.pdf(path.ray.origin, surface));
        path.result.radiance += path.throughput * emission * weight;
    }

    /// f of the written conventions: Lambertian, without the cosine. The geometric normal decides the side.
    [[nodiscard]] Vec3<Real> evaluate(const Surface<Real>& surface, const Vec3<Real>& wi) const {
        const bool reflects = onOurSide(surface, wi) && glm::dot(wi, surface.ns) > 0;
        return reflects ? Vec3<Real>(materialAt(surface).baseColor) / static_cast<Real>(kPi) : Vec3<Real>(0);
    }

    void addDirectLight(Path& path, const Surface<Real>& surface, const PhiloxBlock& words) const {
        constexpr std::uint32_t kBlocked = 0, kReached = 1, kNoRay = 2;
        std::optional<LightSample<Real>> light = lights_.sample(surface, words);
        const Vec3<Real> f = light ? evaluate(surface, light->wi) : Vec3<Real>(0);
        if (f == Vec3<Real>(0)) return path.result.record(kNoRay);
        ++path.result.rays;
        light->shadowRay.origin = surface.originTowards(light->wi);
        if (caster_.visibility(light->shadowRay, light->primitive) == Visibility::blocked)
            return path.result.record(kBlocked);
        path.result.record(kReached);
        const Real cosine = glm::dot(light->wi, surface.ns);
        const bool onlyWay = light->measure == Measure::discrete;
        const Real weight = onlyWay ? Real(1) : powerHeuristic(light->pdf, cosine / static_cast<Real>(kPi));
        path.result.radiance += path.throughput * f * light->emission * (cosine / light->pdf * weight);
    }

    [[nodiscard]] Fate scatter(Path& path, const Surface<Real>& surface, const PhiloxBlock& words) const {
        const Vec3<Real> local = sampleCosineHemisphere(unitReal<Real>(words[0]), unitReal<Real>(words[1]));
        const Vec3<Real> wi = glm::normalize(frameAbout(surface.ns).toWorld(local));
        path.ray = {surface.originTowards(wi), wi};
        path.pdf = glm::dot(wi, surface.ns) / static_cast<Real>(kPi);
        path.throughput *= Vec3<Real>(materialAt(surface).baseColor);
        const bool alive = onOurSide(surface, wi) && path.throughput != Vec3<Real>(0);
        return alive ? Fate::goesOn : Fate::ends;
    }

    [[nodiscard]] Fate roulette(Path& path, std::uint32_t word) const {
        const Real survival = std::min(maxComponent(path.throughput), static_cast<Real>(kMaxSurvival));
        if (unitReal<Real>(word) < survival) {
            path.throughput /= survival;
            return Fate::goesOn;
        }
        constexpr std::uint32_t kEndedByRoulette = 3;
        path.result.record(kEndedByRoulette);
        return Fate::ends;
    }

    const Scene& scene_;
    const World<Real>& world_;
    RenderSettings settings_;
    SideRule sides_;
    CameraRays<Real> camera_;
    RayCaster<Real> caster_;
    Lights<Real> lights_;
};

} // namespace isolux
