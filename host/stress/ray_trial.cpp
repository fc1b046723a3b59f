#include "stress/ray_trial.h"

#include "core/error.h"
#include "core/stopwatch.h"
#include "reference/ray_caster.h"
#include "reference/world.h"
#include "render/ray_query.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

namespace isolux {
namespace {

constexpr std::uint64_t kRaysAtOnce = std::uint64_t{1} << 18;

/// Calls `trace` with chunks of the trial's rays.
template <typename Trace> void forEachChunk(const RayTrial& trial, const StressBench& bench, const Trace& trace) {
    for (std::uint64_t first = 0; first < trial.count; first += kRaysAtOnce) {
        if (bench.interrupted && bench.interrupted()) return;
        trace(trial.make(first, static_cast<std::size_t>(std::min(kRaysAtOnce, trial.count - first))));
    }
}

bool sameHit(const shared::HitRecord& a, const shared::HitRecord& b) {
    const bool hit = a.primitive.x != shared::kNone;
    return a.primitive.x == b.primitive.x && (!hit || a.distance.x == b.distance.x);
}

StressFaults traceOnDevice(const RayTrial& trial, const StressBench& bench) {
    const PackedScene scene = packScene(trial.scene);
    RayQuery bvh(bench.device, scene, RayMethod::bvh);
    std::optional<RayQuery> every;
    if (trial.check == RayCheck::bruteForce) every.emplace(bench.device, scene, RayMethod::bruteForce);
    StressFaults faults;
    forEachChunk(trial, bench, [&](const std::vector<AimedRay>& rays) {
        std::vector<shared::RayRecord> records;
        records.reserve(rays.size());
        for (const AimedRay& ray : rays)
            records.push_back({{Vec3f(scene.space.fromWorld(ray.origin)), std::numeric_limits<float>::max()},
                               {Vec3f(ray.direction), 0.0f}});
        const std::vector<shared::HitRecord> hits = bvh.trace(records);
        faults.tried += rays.size();
        for (const shared::HitRecord& hit : hits) {
            if (hit.primitive.y == 0) ++faults.stackOverflows;
            if (trial.check == RayCheck::closed && hit.primitive.x == shared::kNone) ++faults.leaks;
        }
        if (!every) return;
        const std::vector<shared::HitRecord> all = every->trace(records);
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (!sameHit(hits[i], all[i])) ++faults.differentBits;
    });
    return faults;
}

template <typename Real> bool isFault(const AimedRay& aimed, const RayCaster<Real>& bvh, const RayCaster<Real>* every) {
    const Ray<Real> ray{Vec3<Real>(aimed.origin), Vec3<Real>(glm::normalize(aimed.direction))};
    const std::optional<Hit<Real>> hit = bvh.nearest(ray);
    if (every == nullptr) return !hit;
    const std::optional<Hit<Real>> nearest = every->nearest(ray);
    return hit.has_value() != nearest.has_value() ||
           (hit && (hit->primitive != nearest->primitive || hit->t != nearest->t));
}

template <typename Real> StressFaults traceOnProcessor(const RayTrial& trial, const StressBench& bench) {
    const World<Real> world = flatten<Real>(trial.scene);
    const RayCaster<Real> bvh(world);
    const RayCaster<Real> every(world, {.acceleration = Acceleration::none});
    const RayCaster<Real>* check = trial.check == RayCheck::bruteForce ? &every : nullptr;
    StressFaults faults;
    forEachChunk(trial, bench, [&](const std::vector<AimedRay>& rays) {
        const std::uint64_t found = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, rays.size()), std::uint64_t{0},
            [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t sum) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) sum += isFault(rays[i], bvh, check) ? 1 : 0;
                return sum;
            },
            std::plus<>());
        faults.tried += rays.size();
        (trial.check == RayCheck::closed ? faults.leaks : faults.differentBits) += found;
    });
    return faults;
}

template <typename Trace> StressFigures figuresOf(const char* renderer, const Trace& trace) {
    StressFigures figures;
    figures.renderer = renderer;
    const Stopwatch watch;
    try {
        figures.faults = trace();
    } catch (const Error& error) {
        if (error.code() == ExitCode::tryAgain) throw;
        figures.failure = error.what();
    }
    figures.seconds = watch.seconds();
    return figures;
}

} // namespace

std::vector<StressFigures> runRays(const RayTrial& trial, const StressBench& bench) {
    std::vector<StressFigures> all{figuresOf(kStressDevice, [&] { return traceOnDevice(trial, bench); })};
    if (trial.renderers != Renderers::deviceAlone)
        all.push_back(figuresOf(kStressSingle, [&] { return traceOnProcessor<float>(trial, bench); }));
    if (trial.renderers == Renderers::all)
        all.push_back(figuresOf(kStressDouble, [&] { return traceOnProcessor<double>(trial, bench); }));
    return all;
}

} // namespace isolux
