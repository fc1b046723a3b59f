#include "app/stopping_options.h"

#include "app/validators.h"
#include "core/error.h"
#include "core/log.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <limits>

namespace isolux {
namespace {

constexpr std::uint32_t kAdaptiveSamples = 4096;

CLI::Option* addPositive(CLI::App& command, const std::string& name, std::optional<double>& target) {
    return command.add_option(name, target)->group("Stopping")->check(positiveNumber());
}

CLI::Option* addCount(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& target,
                      std::uint32_t least) {
    return command.add_option(name, target)
        ->group("Stopping")
        ->check(CLI::Range(least, std::numeric_limits<std::uint32_t>::max()));
}

} // namespace

void addStoppingOptions(CLI::App& command, StoppingOptions& options) {
    const AdaptiveRule usual;
    addPositive(command, "--time", options.seconds)
        ->description("Stop after about so many seconds of rendering; without --spp that alone decides");
    addPositive(command, "--adaptive", options.tolerance)
        ->description(
            fmt::format("Stop a pixel when the 95 % interval of its luminance and of its neighbours' is within "
                        "this fraction of the mean; --spp is the most (default then {}). Biased, "
                        "by how much is in host/film/README.md",
                        kAdaptiveSamples));
    addCount(command, "--adaptive-batch", options.batch, 1)
        ->description(fmt::format("Samples a pixel between two such tests (default: {})", usual.batch));
    addCount(command, "--adaptive-min", options.minSamples, 2)
        ->description(fmt::format("Samples a pixel before the first (default: {})", usual.minSamples));
    addPositive(command, "--until-error", options.relativeError)
        ->description(
            "Stop when the image's estimated relative RMSE is at most this; without --spp that alone decides");
}

StoppingRule stoppingRule(const StoppingOptions& options) {
    StoppingRule rule{options.seconds, std::nullopt, options.relativeError};
    if (options.batch && !options.tolerance) throwBadInput("--adaptive-batch", "needs --adaptive");
    if (options.minSamples && !options.tolerance) throwBadInput("--adaptive-min", "needs --adaptive");
    if (!options.tolerance) return rule;
    AdaptiveRule adaptive;
    adaptive.tolerance = *options.tolerance;
    adaptive.batch = options.batch.value_or(adaptive.batch);
    adaptive.minSamples = options.minSamples.value_or(adaptive.minSamples);
    rule.adaptive = adaptive;
    return rule;
}

std::uint32_t defaultSamples(const StoppingRule& rule, const SceneOptions& scene) {
    if (rule.adaptive) return kAdaptiveSamples;
    const bool open = rule.seconds || rule.relativeError;
    return open ? std::numeric_limits<std::uint32_t>::max() - scene.firstSample : scene.samples;
}

void warnOfStopping(const StoppingRule& rule, const RenderSettings& settings) {
    if (rule.adaptive && settings.sampleCount <= rule.adaptive->minSamples)
        spdlog::warn("--adaptive: without effect, as no pixel stops before {} samples and --spp is {}",
                     rule.adaptive->minSamples, settings.sampleCount);
    const bool early = rule.seconds || rule.adaptive || rule.relativeError;
    if (early && settings.sampler == PixelSampler::stratified)
        spdlog::warn("--pixel-sampler stratified: strata are laid out for {} samples, too fine for a render that stops "
                     "sooner; sobol is even at any number",
                     settings.sampleCount);
}

} // namespace isolux
