// Passes over the image, pixels on all processors, samples into statistics.
#include "reference/reference.h"

#include "core/error.h"
#include "core/pacing.h"
#include "reference/path.h"

#include <oneapi/tbb/blocked_range2d.h>
#include <oneapi/tbb/combinable.h>
#include <oneapi/tbb/parallel_for.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace isolux {
namespace {

constexpr std::uint32_t kLargestPass = 16; // samples a pixel
constexpr std::size_t kTileSize = 8;       // pixels: paths differ in length by orders of magnitude

/// Counts that threads gather apart from each other; integers, so their sum does not depend on the order.
struct Counts {
    std::uint64_t rays = 0;
    Diagnostics diagnostics;
};

void diagnose(const Vec3d& radiance, Diagnostics& diagnostics) {
    if (!isFinite(radiance)) ++diagnostics.nonFiniteSamples;
    if (glm::any(glm::lessThan(radiance, Vec3d(0.0)))) ++diagnostics.negativeSamples;
}

template <typename Real>
void addSample(PixelStatistics& pixel, const PathResult<Real>& path, PathSignatures signatures) {
    pixel.add(Vec3d(path.radiance));
    pixel.hitCount += path.cameraHits;
    if (signatures == PathSignatures::on) pixel.pathSignature += path.signature;
}

template <typename Real> class Renderer {
public:
    Renderer(const Scene& scene, const RenderSettings& settings, const ReferenceOptions& options,
             const PixelRegion& region)
        : world_(flatten<Real>(scene)), tracer_(scene, world_, settings, options), settings_(settings),
          options_(options), region_(region), film_(region.width, region.height) {
        if (options.aovs == Aovs::on) film_.keepAovs();
    }

    [[nodiscard]] Film render(const ProgressCallback& progress) {
        const Pacing pacing(options_.stopping.seconds, kLargestPass);
        std::uint32_t done = 0;
        while (const std::uint32_t pass = nextPass(pacing, done)) {
            renderPass(settings_.firstSample + done, pass);
            done += pass;
            if (progress && progress(pacing.fraction(done, settings_.sampleCount)) == Continue::no) break;
        }
        return std::move(film_);
    }

private:
    /// The first passes are short without a time limit too, so that a slow scene can be interrupted and still shows
    /// every pixel.
    [[nodiscard]] std::uint32_t nextPass(const Pacing& pacing, std::uint32_t done) const {
        return std::min(std::max(done, 1u), pacing.nextPass(done, settings_.sampleCount));
    }

    void renderPass(std::uint32_t firstSample, std::uint32_t sampleCount) {
        tbb::combinable<Counts> counts;
        const tbb::blocked_range2d<std::uint32_t> pixels(0, region_.height, kTileSize, 0, region_.width, kTileSize);
        tbb::parallel_for(pixels, [&](const tbb::blocked_range2d<std::uint32_t>& tile) {
            for (std::uint32_t y = tile.rows().begin(); y < tile.rows().end(); ++y)
                for (std::uint32_t x = tile.cols().begin(); x < tile.cols().end(); ++x)
                    for (std::uint32_t i = 0; i < sampleCount; ++i) takeSample(x, y, firstSample + i, counts.local());
        });
        counts.combine_each([&](const Counts& part) {
            film_.rays += part.rays;
            film_.diagnostics.merge(part.diagnostics);
        });
    }

    void takeSample(std::uint32_t x, std::uint32_t y, std::uint32_t sample, Counts& counts) {
        const PathResult<Real> path = tracer_.trace(region_.x + x, region_.y + y, sample);
        addSample(film_.at(x, y), path, options_.signatures);
        if (path.firstHit && options_.aovs == Aovs::on)
            film_.aovs[std::size_t{y} * film_.width + x].add(*path.firstHit);
        counts.rays += path.rays;
        diagnose(Vec3d(path.radiance), counts.diagnostics);
    }

    World<Real> world_;
    PathTracer<Real> tracer_;
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
