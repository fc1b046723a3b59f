// The options that may end a render before all samples are taken: time, each pixel's error, the image's.
#pragma once

#include "app/scene_options.h"
#include "film/sample_plan.h"

#include <cstdint>
#include <optional>

namespace isolux {

struct StoppingOptions {
    std::optional<double> seconds;
    std::optional<double> tolerance; ///< of adaptive sampling
    std::optional<std::uint32_t> batch;
    std::optional<std::uint32_t> minSamples;
    std::optional<double> relativeError;
};

void addStoppingOptions(CLI::App& command, StoppingOptions& options);

/// Throws Error (bad input) if options do not fit each other.
[[nodiscard]] StoppingRule stoppingRule(const StoppingOptions& options);

/// The samples a pixel where --spp is not given: 4096 at most if they are adaptive; as many as the time or the error
/// asks for; else the usual number.
[[nodiscard]] std::uint32_t defaultSamples(const StoppingRule& rule, const SceneOptions& scene);

/// Warns of what a render that may stop early does to the other methods, or they to it.
void warnOfStopping(const StoppingRule& rule, const RenderSettings& settings);

} // namespace isolux
