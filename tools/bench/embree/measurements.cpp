// Everything is timed on one thread and on all, whoever traces or builds.
#include "measurements.h"

#include "accel/bvh.h"
#include "accel/wide_bvh.h"
#include "core/error.h"
#include "core/stopwatch.h"

#include <nlohmann/json.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

#include <atomic>

namespace isolux::bench {
namespace {

constexpr std::size_t kGrain = 1024; // rays: a task is long against its start

std::size_t countOf(Threads threads) {
    return threads == Threads::one ? 1 : static_cast<std::size_t>(tbb::info::default_concurrency());
}

/// Seconds of one call, from as many as the effort allows.
template <typename Function> double secondsOf(const Effort& effort, const Function& function) {
    const Stopwatch watch;
    int calls = 0;
    do {
        function();
        ++calls;
    } while (watch.seconds() < effort.seconds);
    return watch.seconds() / calls;
}

struct ByThreads {
    double one = 0.0;
    double all = 0.0;
};

nlohmann::ordered_json toJson(const ByThreads& figures) { return {{"one", figures.one}, {"all", figures.all}}; }

/// Seconds of a call.
template <typename Function> ByThreads byThreads(const Effort& effort, const Function& function) {
    const auto onThreads = [&](Threads threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, countOf(threads));
        return secondsOf(effort, function);
    };
    return {onThreads(Threads::one), onThreads(Threads::all)};
}

/// How many of the rays hit something.
template <typename Nearest> std::size_t trace(const Rays& rays, const Nearest& nearest) {
    std::atomic<std::size_t> hits = 0;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), kGrain), [&](const auto& range) {
        std::size_t own = 0;
        for (std::size_t i = range.begin(); i < range.end(); ++i) own += nearest(rays[i]) != kNoPrimitive ? 1 : 0;
        hits += own;
    });
    return hits;
}

/// The first pass is not timed: it wakes threads and fills caches. That all others must hit as many keeps a compiler
/// from leaving work out.
template <typename Nearest> ByThreads raysPerSecond(const Rays& rays, const Effort& effort, const Nearest& nearest) {
    const std::size_t hits = trace(rays, nearest);
    const ByThreads seconds = byThreads(effort, [&] {
        if (trace(rays, nearest) != hits) throwFailure("rays", "they hit more or less on another pass");
    });
    const auto count = static_cast<double>(rays.size());
    return {count / seconds.one, count / seconds.all};
}

std::uint32_t primitiveOf(const std::optional<Hit<float>>& hit) { return hit ? hit->primitive : kNoPrimitive; }

/// Embree finds the boxes of its primitives itself, so this is part of the time.
std::vector<Box3f> boxesOf(const World<float>& world) {
    std::vector<Box3f> boxes(world.boxes.size());
    for (std::size_t i = 0; i < world.triangles.size(); ++i)
        for (const Vec3f& position : world.triangles[i].positions) boxes[i].extend(position);
    for (std::size_t i = 0; i < world.spheres.size(); ++i) {
        const WorldSphere<float>& sphere = world.spheres[i];
        boxes[world.triangles.size() + i] = {sphere.center - sphere.radius, sphere.center + sphere.radius};
    }
    return boxes;
}

} // namespace

nlohmann::ordered_json measureBuilds(const World<float>& world, const Effort& effort) {
    const EmbreeDevice device = openEmbree();
    const EmbreeGeometry geometry(world);
    const Bvh bvh = buildBvh(world.boxes);
    nlohmann::ordered_json found;
    const auto embree = [&](EmbreeEdges edges) {
        return toJson(byThreads(effort, [&] { const EmbreeScene scene(device, geometry, edges); }));
    };
    found["embree-robust"] = embree(EmbreeEdges::robust);
    found["embree-fast"] = embree(EmbreeEdges::fast);
    found["isolux-binary"] = toJson(byThreads(effort, [&] { static_cast<void>(buildBvh(boxesOf(world))); }));
    found["isolux-wide"] = toJson(byThreads(effort, [&] { static_cast<void>(buildWideBvh(bvh)); }));
    return found;
}

nlohmann::ordered_json measureRays(const World<float>& world, const RayCaster<float>& caster, const Rays& rays,
                                   const Effort& effort) {
    const EmbreeDevice device = openEmbree();
    const EmbreeGeometry geometry(world);
    const EmbreeScene robust(device, geometry, EmbreeEdges::robust);
    const EmbreeScene fast(device, geometry, EmbreeEdges::fast);
    const auto figures = [&](const auto& nearest) { return toJson(raysPerSecond(rays, effort, nearest)); };
    nlohmann::ordered_json found;
    found["embree-robust"] = figures([&](const auto& ray) { return robust.nearest(ray); });
    found["embree-fast"] = figures([&](const auto& ray) { return fast.nearest(ray); });
    found["isolux-reference"] = figures([&](const auto& ray) { return primitiveOf(caster.nearest(ray)); });
    return found;
}

nlohmann::ordered_json countTests(const RayCaster<float>& caster, const Rays& rays) {
    TraversalTests tests;
    for (const Ray<float>& ray : rays) static_cast<void>(caster.nearest(ray, tests));
    const auto count = static_cast<double>(rays.size());
    return {{"boxesPerRay", static_cast<double>(tests.boxes) / count},
            {"primitivesPerRay", static_cast<double>(tests.primitives) / count}};
}

double agreement(const World<float>& world, const RayCaster<float>& caster, const Rays& rays) {
    const EmbreeDevice device = openEmbree();
    const EmbreeGeometry geometry(world);
    const EmbreeScene robust(device, geometry, EmbreeEdges::robust);
    std::size_t same = 0;
    for (const Ray<float>& ray : rays) same += robust.nearest(ray) == primitiveOf(caster.nearest(ray)) ? 1 : 0;
    return static_cast<double>(same) / static_cast<double>(rays.size());
}

} // namespace isolux::bench
