// What the kernels are compiled with and without: options that compile in more than a scene needs, and the reasons.
#pragma once

#include "gpu/pipeline_cache.h"
#include "pack/scene_features.h"
#include "report/run_report.h"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace isolux {

struct FeatureOptions {
    std::string base = "needed";   ///< or "all"
    std::vector<std::string> with; ///< as in `namedFeatures`, or "light-choice"
};

/// Adds --features and --with, in a group of their own.
void addFeatureOptions(CLI::App& command, FeatureOptions& options);

/// The features to compile; nothing: those that the scene needs. The image is the same with any.
[[nodiscard]] std::optional<SceneFeatures> chosenFeatures(const FeatureOptions& options, const Scene& scene,
                                                          const RenderSettings& settings);

/// Each feature of scenes: whether the kernels have it, by `compiled`, and why the scene needs it or not.
[[nodiscard]] std::vector<FeatureUse> explainScene(const Scene& scene, const RenderSettings& settings,
                                                   const SceneFeatures& compiled);

/// The same of what options ask for, by the constants of the path kernel.
[[nodiscard]] std::vector<FeatureUse> explainMethods(const Specialization& specialization);

} // namespace isolux
