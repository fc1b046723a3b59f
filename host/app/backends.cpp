#include "app/backends.h"

#include "app/method_names.h"
#include "core/log.h"
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
}

void renderOnDevice(Film& film, RunReport& report, const SceneRun& run, const BackendOptions& options,
                    ProgressBar& bar) {
    bar.stage("opening the device");
    const Device device(options.device);
    report.deviceName = device.description().name;
    report.driverName = device.description().driverName;
    report.driverVersion = device.description().driverVersion;
    spdlog::debug("device {}: {}", device.description().name, device.description().driverVersion);
    RenderOptions renderOptions;
    renderOptions.aovs = options.aovs;
    renderOptions.counts = options.counts;
    renderOptions.stopping = options.stopping;
    renderOptions.dispatchSeconds = options.dispatchSeconds;
    renderOptions.stage = [&](std::string_view name) { bar.stage(name); };
    PathRenderer renderer(device, run.scene, run.settings, renderOptions);
    try {
        const ScopedTimer timer(report.timings.render);
        renderer.render(film, bar.callback());
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
    film = renderReference(run.scene, run.settings, reference, bar.callback());
}

} // namespace

SceneRun openScene(const SceneOptions& options, const MethodOptions& methods, std::uint32_t defaultWidth) {
    SceneRun run;
    const ScopedTimer timer(run.loadSeconds);
    RenderSettings chosen = chosenMethods(methods);
    chosen.width = defaultWidth;
    run.scene = loadScene(options);
    run.settings = settingsFor(run.scene, options, chosen);
    checkMethods(run.settings, run.scene);
    run.environmentGiven = !options.environment.empty();
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
    const Environment& environment = run.scene.environment;
    if (environment.emits())
        report.environment = EnvironmentSummary{
            environment.radiance, environment.extent == EnvironmentExtent::sphere ? "sphere" : "upper half"};
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
