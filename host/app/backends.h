// Loading a scene and rendering it with either backend, with the report filled in on the way.
#pragma once

#include "app/feature_options.h"
#include "app/method_options.h"
#include "app/scene_options.h"
#include "core/progress.h"
#include "film/film.h"
#include "film/sample_plan.h"
#include "reference/options.h"
#include "render/path_renderer.h"
#include "report/run_report.h"

namespace isolux {

enum class Backend { vulkan, reference };

struct BackendOptions {
    Backend backend = Backend::vulkan;
    Precision precision = Precision::doublePrecision;
    DeviceOptions device;
    Aovs aovs = Aovs::off;
    TraversalCounts counts = TraversalCounts::off;
    StoppingRule stopping;
    double dispatchSeconds = RenderOptions{}.dispatchSeconds;
    FeatureOptions features;
};

/// A loaded scene with what is to be rendered of it.
struct SceneRun {
    Scene scene;
    RenderSettings settings;
    EnvironmentChoice environment;
    double loadSeconds = 0.0;
};

/// Throws Error (bad input) if options do not fit each other or the scene.
[[nodiscard]] SceneRun openScene(const SceneOptions& options, const MethodOptions& methods, std::uint32_t defaultWidth);

/// A report that knows the scene and the settings.
[[nodiscard]] RunReport describeRun(const SceneRun& run, const SceneOptions& options);

/// Renders into `film` and adds device and timings to `report`. If it is interrupted, or a device fails, both tell how
/// far it got.
void renderFilm(Film& film, RunReport& report, const SceneRun& run, const BackendOptions& options, ProgressBar& bar);

} // namespace isolux
