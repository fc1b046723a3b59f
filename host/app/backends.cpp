#include "app/backends.h"

#include "app/method_names.h"
#include "core/log.h"
#include "core/platform.h"
#include "core/stopwatch.h"
#include "reference/reference.h"
#include "render/path_renderer.h"

namespace isolux {
namespace {

/// Stores the time a scope took, however it is left.
class ScopedTimer {
public:
    explicit ScopedTimer(double& target) : target_(target) {}
    ~ScopedTimer() { target_ = watch_.seconds(); }
    ScopedTimer(const ScopedTimer&) = delete;
    ScopedTimer& operator=(const ScopedTimer&) = delete;

private:
    double& target_;
    Stopwatch watch_;
};

void addStatistics(RunReport& report, const RenderStatistics& statistics) {
    report.timings.build = statistics.packSeconds;
    report.timings.upload = statistics.uploadSeconds;
    report.timings.compile = statistics.compileSeconds;
    report.timings.device = statistics.deviceSeconds;
    report.dispatchCount = statistics.dispatchCount;
    report.longestDispatch = statistics.longestDispatchSeconds;
    report.sceneBytes = statistics.sceneBytes;
    report.specialization = statistics.specialization;
}

/// Notes when the first samples were done.
ProgressCallback noting(std::optional<double>& firstPixel, const ProgressCallback& callback) {
    return [&firstPixel, callback](double fraction) {
        if (!firstPixel && fraction > 0.0) firstPixel = processSeconds();
        return callback(fraction);
    };
}

/// What the kernels have of the scene and of the options.
std::vector<FeatureUse> featuresOf(const SceneRun& run, const RenderStatistics& statistics) {
    std::vector<FeatureUse> features = explainScene(run.scene, run.settings, statistics.features);
    const std::vector<FeatureUse> methods = explainMethods(statistics.specialization);
    features.insert(features.end(), methods.begin(), methods.end());
    return features;
}

void renderOnDevice(Film& film, RunReport& report, const SceneRun& run, const BackendOptions& options,
                    ProgressBar& bar) {
    bar.stage("opening the device");
    const Stopwatch opening;
    const Device device(options.device);
    report.timings.open = opening.seconds();
    report.deviceName = device.description().name;
    report.driverName = device.description().driverName;
    report.driverVersion = device.description().driverVersion;
    spdlog::debug("device {}: {}", device.description().name, device.description().driverVersion);
    RenderOptions renderOptions;
    renderOptions.aovs = options.aovs;
    renderOptions.counts = options.counts;
    renderOptions.stopping = options.stopping;
    renderOptions.dispatchSeconds = options.dispatchSeconds;
    renderOptions.features = chosenFeatures(options.features, run.scene, run.settings);
    renderOptions.stage = [&](std::string_view name) { bar.stage(name); };
    PathRenderer renderer(device, run.scene, run.settings, renderOptions);
    report.features = featuresOf(run, renderer.statistics());
    try {
        const ScopedTimer timer(report.timings.render);
        renderer.render(film, noting(report.timings.firstPixel, bar.callback()));
    } catch (...) {
        addStatistics(report, renderer.statistics());
        throw;
    }
    addStatistics(report, renderer.statistics());
    report.validationMessages = device.validationMessages();
}

void renderOnProcessor(Film& film, RunReport& report, const SceneRun& run, const BackendOptions& options,
                       ProgressBar& bar) {
    report.deviceName =
        options.precision == Precision::doublePrecision ? "CPU, double precision" : "CPU, single precision";
    const ScopedTimer timer(report.timings.render);
    ReferenceOptions reference;
    reference.precision = options.precision;
    reference.aovs = options.aovs;
    reference.counts = options.counts;
    reference.stopping = options.stopping;
    film = renderReference(run.scene, run.settings, reference, noting(report.timings.firstPixel, bar.callback()));
}

} // namespace

SceneRun openScene(const SceneOptions& options, const MethodOptions& methods, std::uint32_t defaultWidth) {
    SceneRun run;
    const ScopedTimer timer(run.loadSeconds);
    RenderSettings chosen = chosenMethods(methods);
    chosen.width = defaultWidth;
    run.scene = loadScene(options);
    run.environment = applyEnvironment(run.scene, options.environment, chosen);
    run.settings = settingsFor(run.scene, options, chosen);
    checkMethods(run.settings, run.scene);
    if (run.environment.origin == EnvironmentOrigin::defaultSky)
        spdlog::warn("{}: no light: it gets a white sky; --environment R,G,B or FILE gives it another, --environment "
                     "none leaves it dark",
                     options.file);
    return run;
}

RunReport describeRun(const SceneRun& run, const SceneOptions& options) {
    RunReport report;
    report.scene = options.file;
    report.sceneHash = run.scene.contentHash;
    report.width = run.settings.width;
    report.height = run.settings.height;
    report.firstSample = run.settings.firstSample;
    report.seed = run.settings.seed;
    if (run.settings.maxDepth != kUnlimitedDepth) report.maxDepth = run.settings.maxDepth;
    report.methods = methodsOf(run.settings);
    report.timings.load = run.loadSeconds;
    report.camera = run.scene.cameras[run.settings.camera].name;
    report.environment = summariseEnvironment(run.scene, run.environment);
    return report;
}

void renderFilm(Film& film, RunReport& report, const SceneRun& run, const BackendOptions& options, ProgressBar& bar) {
    if (options.backend == Backend::vulkan) {
        report.backend = "vulkan";
        renderOnDevice(film, report, run, options, bar);
    } else {
        report.backend = "reference";
        renderOnProcessor(film, report, run, options, bar);
    }
}

} // namespace isolux
