// What every integrator does: the random words of a sample, its camera ray, the surfaces that rays meet, what is
// counted.
#pragma once

#include "core/sample_sequence.h"
#include "film/film.h"
#include "reference/alpha.h"
#include "reference/back_faces.h"
#include "reference/camera.h"
#include "reference/material_point.h"
#include "reference/normal_map.h"
#include "reference/scattered.h"
#include "reference/surface.h"

#include <cstdint>
#include <optional>

namespace isolux {

/// Words of a path's signature, besides the primitives that rays meet. `scattered` and the following ones count lobes.
enum class PathEvent : std::uint32_t { blocked = 0, reached = 1, noRay = 2, endedByRoulette = 3, scattered = 4 };

/// What one sample of one pixel leaves.
template <typename Real> struct PathResult {
    Vec3<Real> radiance{0};                ///< or whatever else the integrator measures
    std::uint32_t signature = 2166136261u; ///< FNV-1a of the path's discrete events
    std::uint64_t rays = 0;
    std::uint64_t cameraHits = 0; ///< 1 if the camera ray met a surface, or an environment that emits there
    TraversalTests tests;
    std::optional<FirstHit> firstHit;

    void record(std::uint32_t word) { signature = (signature ^ word) * 16777619u; }
    void record(PathEvent event) { record(static_cast<std::uint32_t>(event)); }
    void record(Lobe lobe) {
        record(static_cast<std::uint32_t>(PathEvent::scattered) + static_cast<std::uint32_t>(lobe));
    }
};

/// The random words of one sample of one pixel.
struct SampleStream {
    PixelSampler sampler;
    SequencePlan plan;
    SampleIndex index;

    [[nodiscard]] PhiloxBlock block(std::uint32_t number) const {
        switch (sampler) {
        case PixelSampler::independent: return independentBlock(plan, index, number);
        case PixelSampler::stratified: return stratifiedBlock(plan, index, number);
        case PixelSampler::sobol: return sobolBlock(plan, index, number);
        case PixelSampler::sobolBlueNoise: return sobolBlueNoiseBlock(plan, index, number);
        }
        return {};
    }

    /// The key of alpha for a ray: for the one that finds hit b, of 2b; for a shadow ray, of its light sample's block.
    [[nodiscard]] std::uint32_t alphaKey(std::uint32_t number) const {
        return independentBlock(plan, index, 0x20000000u ^ number)[0];
    }
};

/// Keeps references; safe to use from many threads.
template <typename Real> class Tracing {
public:
    Tracing(const Scene& scene, const World<Real>& world, const RenderSettings& settings, SideRule sides)
        : scene_(scene), world_(world), attributes_(scene, world), covered_(hasCoverage(scene)),
          backFaces_(scene, world, settings.backFaces),
          sampler_(settings.sampler), plan_{settings.seed, cellBitsOf(settings)}, sides_(sides),
          camera_(scene.cameras[settings.camera], settings), caster_(world, settings.intersection) {}

    [[nodiscard]] SampleStream stream(const SampleIndex& index) const { return {sampler_, plan_, index}; }

    [[nodiscard]] Ray<Real> cameraRay(const SampleStream& stream) const {
        return camera_.sample(stream.index.x, stream.index.y, stream.block(0));
    }

    /// The presence of surfaces for a ray, by the number of its key; none where all are there for every ray.
    [[nodiscard]] std::optional<Presence<Real>> presence(const SampleStream& stream, std::uint32_t number) const {
        return covered_ ? std::optional(Presence<Real>(attributes_, stream.alphaKey(number))) : std::nullopt;
    }

    [[nodiscard]] std::optional<Surface<Real>>
    findSurface(const Ray<Real>& ray, const std::optional<Presence<Real>>& presence, PathResult<Real>& result) const {
        ++result.rays;
        const std::optional<Hit<Real>> hit =
            caster_.nearest(ray, result.tests, [&](const Place<Real>& place) { return isThere(ray, place, presence); });
        result.record(hit ? hit->primitive : kNoPrimitive);
        if (!hit) return std::nullopt;
        Surface<Real> surface = withNormalMap(surfaceAt(world_, ray, *hit), attributes_);
        if (sides_ == SideRule::shading && glm::dot(surface.ns, surface.wo) < 0) surface.ns = -surface.ns;
        return surface;
    }

    [[nodiscard]] Visibility visibility(const Ray<Real>& ray, std::uint32_t ignored,
                                        const std::optional<Presence<Real>>& presence, PathResult<Real>& result) const {
        ++result.rays;
        const Visibility visibility = caster_.visibility(
            ray, ignored, result.tests, [&](const Place<Real>& place) { return isThere(ray, place, presence); });
        result.record(visibility == Visibility::clear ? PathEvent::reached : PathEvent::blocked);
        return visibility;
    }

    void noteFirstHit(PathResult<Real>& result, const Surface<Real>& surface) const {
        result.cameraHits = 1;
        result.firstHit = FirstHit{Vec3d(baseAt(attributes_, surface.place())), Vec3d(surface.ns),
                                   static_cast<double>(depthOf(surface)), world_.objectOf(surface.primitive)};
    }

    /// Whether scattering reaches a direction as far as the geometric normal is asked.
    [[nodiscard]] bool onOurSide(const Surface<Real>& surface, const Vec3<Real>& wi) const {
        return sides_ == SideRule::shading || glm::dot(wi, surface.facing) > 0;
    }
    /// The same of transmission.
    [[nodiscard]] bool onTheOtherSide(const Surface<Real>& surface, const Vec3<Real>& wi) const {
        return sides_ == SideRule::shading || glm::dot(wi, surface.facing) < 0;
    }

    [[nodiscard]] const Material& materialAt(const Surface<Real>& surface) const {
        return scene_.materials[surface.material];
    }
    [[nodiscard]] MaterialPoint<Real> materialPoint(const Surface<Real>& surface) const {
        return materialPointAt(attributes_, surface.material, surface.place());
    }
    [[nodiscard]] const Attributes<Real>& attributes() const { return attributes_; }
    [[nodiscard]] Real depthOf(const Surface<Real>& surface) const { return camera_.depth(surface.position); }

private:
    [[nodiscard]] bool isThere(const Ray<Real>& ray, const Place<Real>& place,
                               const std::optional<Presence<Real>>& presence) const {
        return backFaces_.isThere(ray, place) && (!presence || (*presence)(place));
    }

    const Scene& scene_;
    const World<Real>& world_;
    Attributes<Real> attributes_;
    bool covered_; ///< surfaces may not be there for some rays
    BackFaceTest<Real> backFaces_;
    PixelSampler sampler_;
    SequencePlan plan_;
    SideRule sides_;
    CameraRays<Real> camera_;
    RayCaster<Real> caster_;
};

} // namespace isolux
