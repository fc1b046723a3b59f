// Passes over the image, pixels on all processors, samples into statistics.
#include "reference/reference.h"

#include "core/error.h"
#include "reference/first_hit.h"
#include "reference/path.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/combinable.h>
#include <oneapi/tbb/parallel_for.h>

#include <fmt/format.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace isolux {
namespace {

constexpr std::size_t kGrain = 32; // pixels of a task: paths differ in length by orders of magnitude

/// Counts that threads gather apart from each other; integers, so their sum does not depend on the order.
struct Counts {
    std::uint64_t rays = 0;
    TraversalTests tests;
    Diagnostics diagnostics;
};

void diagnose(const Vec3d& radiance, Diagnostics& diagnostics) {
    if (!isFinite(radiance)) ++diagnostics.nonFiniteSamples;
    if (glm::any(glm::lessThan(radiance, Vec3d(0.0)))) ++diagnostics.negativeSamples;
}

/// The pixels of a film, row by row.
std::vector<std::uint32_t> pixelsOf(const Film& film) {
    std::vector<std::uint32_t> pixels;
    pixels.reserve(film.pixels.size());
    for (std::uint32_t y = 0; y < film.height; ++y)
        for (std::uint32_t x = 0; x < film.width; ++x) pixels.push_back(packPixel(x, y));
    return pixels;
}

template <typename Real> class Renderer {
public:
    Renderer(const Scene& scene, const RenderSettings& settings, const ReferenceOptions& options,
             const PixelRegion& region)
        : world_(flatten<Real>(scene)), tracing_(scene, world_, settings, options.sides),
          paths_(scene, world_, settings, tracing_), firstHits_(tracing_, settings), settings_(settings),
          options_(options), region_(region), film_(region.width, region.height) {
        if (options.aovs == Aovs::on) film_.keepAovs();
        if (usesReplicates(settings.sampler)) film_.keepReplicates();
    }

    [[nodiscard]] Film render(const ProgressCallback& progress) {
        const SampleRange samples{settings_.firstSample, settings_.sampleCount};
        SamplePlan plan(options_.stopping, samples, FirstPasses::growing, pixelsOf(film_));
        while (const std::optional<Pass> pass = plan.next(film_)) {
            renderPass(*pass);
            film_.refineVariance();
            if (progress && progress(plan.fraction(1.0)) == Continue::no) break;
            if (options_.pass && options_.pass(film_) == Continue::no) break;
        }
        return std::move(film_);
    }

private:
    void renderPass(const Pass& pass) {
        tbb::combinable<Counts> counts;
        const tbb::blocked_range<std::size_t> places(0, pass.pixels.size(), kGrain);
        tbb::parallel_for(places, [&](const tbb::blocked_range<std::size_t>& part) {
            for (std::size_t place = part.begin(); place != part.end(); ++place)
                for (std::uint32_t i = 0; i < pass.sampleCount; ++i)
                    takeSample(pass.pixels[place], pass.firstSample + i, counts.local());
        });
        counts.combine_each([&](const Counts& part) { addCounts(part); });
    }

    void addCounts(const Counts& counts) {
        film_.rays += counts.rays;
        film_.diagnostics.merge(counts.diagnostics);
        if (options_.counts == TraversalCounts::off) return;
        film_.boxTests += counts.tests.boxes;
        film_.primitiveTests += counts.tests.primitives;
    }

    void takeSample(std::uint32_t pixel, std::uint32_t sample, Counts& counts) {
        const SampleIndex index{region_.x + pixelX(pixel), region_.y + pixelY(pixel), sample};
        const SampleStream stream = tracing_.stream(index);
        const PathResult<Real> path = followsLight(settings_) ? paths_.trace(stream) : firstHits_.trace(stream);
        addSample(std::size_t{pixelY(pixel)} * film_.width + pixelX(pixel), sample, path);
        counts.rays += path.rays;
        counts.tests.merge(path.tests);
        diagnose(Vec3d(path.radiance), counts.diagnostics);
    }

    void addSample(std::size_t place, std::uint32_t sample, const PathResult<Real>& path) {
        PixelStatistics& pixel = film_.pixels[place];
        const Vec3d radiance(path.radiance);
        pixel.add(radiance);
        pixel.hitCount += path.cameraHits;
        if (options_.signatures == PathSignatures::on) pixel.pathSignature += path.signature;
        if (options_.aovs == Aovs::on && path.firstHit) film_.aovs[place].add(*path.firstHit);
        if (!film_.replicates.empty()) film_.replicates[place].add(sample, radiance);
    }

    World<Real> world_;
    Tracing<Real> tracing_;
    PathTracer<Real> paths_;
    FirstHitTracer<Real> firstHits_;
    RenderSettings settings_;
    ReferenceOptions options_;
    PixelRegion region_;
    Film film_;
};

void checkRequest(const Scene& scene, const RenderSettings& settings, const PixelRegion& region) {
    if (settings.camera >= scene.cameras.size())
        throwBadInput("reference",
                      fmt::format("camera {} does not exist; the scene has {}", settings.camera, scene.cameras.size()));
    const bool inside = std::uint64_t{region.x} + region.width <= settings.width &&
                        std::uint64_t{region.y} + region.height <= settings.height;
    if (!inside) throwBadInput("reference", "the region of pixels leaves the image");
    const bool endless = followsLight(settings) && settings.roulette.kind == Roulette::off &&
                         countedBounces(settings).last == kUnlimitedDepth;
    if (endless) throwBadInput("reference", "without roulette paths need a largest number of bounces");
}

} // namespace

Film renderReference(const Scene& scene, const RenderSettings& settings, const ReferenceOptions& options,
                     const ProgressCallback& progress) {
    return renderReferenceRegion(scene, settings, options, {0, 0, settings.width, settings.height}, progress);
}

Film renderReferenceRegion(const Scene& scene, const RenderSettings& settings, const ReferenceOptions& options,
                           const PixelRegion& region, const ProgressCallback& progress) {
    checkRequest(scene, settings, region);
    if (options.precision == Precision::doublePrecision)
        return Renderer<double>(scene, settings, options, region).render(progress);
    return Renderer<float>(scene, settings, options, region).render(progress);
}

} // namespace isolux
