// embree_rays SCENE: builds and rays a second of Embree and of Isolux' own BVH on one scene, as JSON.
#include "core/error.h"
#include "core/log.h"
#include "load/gltf.h"
#include "measurements.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/info.h>

namespace isolux::bench {
namespace {

struct Options {
    std::string scene;
    std::uint32_t size = 128;
    std::uint32_t samples = 4;
    Effort effort;
    bool checkHits = false;
};

void addOptions(CLI::App& app, Options& options) {
    app.add_option("SCENE", options.scene, "A glTF file")->required();
    app.add_option("--size", options.size, "Pixels a row and a column")->check(CLI::Range(1, 4096));
    app.add_option("--spp", options.samples, "Camera rays a pixel")->check(CLI::Range(1, 1024));
    app.add_option("--seconds", options.effort.seconds, "At least so long for each figure")
        ->check(CLI::Range(0.0, 3600.0));
    app.add_flag("--check-hits", options.checkHits, "Count the rays that find the same primitive with both");
}

nlohmann::ordered_json measureSet(const World<float>& world, const RayCaster<float>& caster, const Rays& rays,
                                  const Options& options) {
    if (rays.empty()) return nullptr; // nothing is hit, so that nothing bounces
    nlohmann::ordered_json found{{"count", rays.size()},
                                 {"raysPerSecond", measureRays(world, caster, rays, options.effort)},
                                 {"tests", countTests(caster, rays)}};
    if (options.checkHits) found["samePrimitive"] = agreement(world, caster, rays);
    return found;
}

nlohmann::ordered_json measure(const Options& options) {
    const Scene scene = loadScene(options.scene);
    const World<float> world = flatten<float>(scene);
    const RayCaster<float> caster(world);
    const RaySets rays = makeRaySets(scene, world, caster,
                                     {.width = options.size, .height = options.size, .sampleCount = options.samples});
    const BvhStatistics bvh = statistics(buildBvh(world.boxes));
    return {{"schema", 1},
            {"scene", options.scene},
            {"sceneHash", scene.contentHash},
            {"primitives", world.primitiveCount()},
            {"threads", tbb::info::default_concurrency()},
            {"embree", RTC_VERSION_STRING},
            {"buildSeconds", measureBuilds(world, options.effort)},
            {"bvh", {{"sahCost", bvh.sahCost}, {"nodes", bvh.nodeCount}, {"depth", bvh.depth}}},
            {"primary", measureSet(world, caster, rays.primary, options)},
            {"bounce", measureSet(world, caster, rays.bounce, options)}};
}

int run(int argumentCount, char** arguments) {
    CLI::App app("Rays a second of Embree, the yardstick of tools/bench/history.");
    Options options;
    addOptions(app, options);
    try {
        app.parse(argumentCount, arguments);
    } catch (const CLI::Success& success) { // --help
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        app.exit(error);
        return static_cast<int>(ExitCode::badInput);
    }
    fmt::print("{}\n", measure(options).dump(2));
    return 0;
}

} // namespace
} // namespace isolux::bench

int main(int argumentCount, char** arguments) {
    isolux::initialiseLog();
    try {
        return isolux::bench::run(argumentCount, arguments);
    } catch (const isolux::Error& error) {
        fmt::print(stderr, "embree_rays: error: {}\n", error.what());
        return static_cast<int>(error.code());
    } catch (const std::exception& error) {
        fmt::print(stderr, "embree_rays: error: {}\n", error.what());
        return static_cast<int>(isolux::ExitCode::failure);
    }
}
