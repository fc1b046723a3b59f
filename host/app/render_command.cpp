// `isolux render`: a scene to image files, with a report of time and error.
#include "app/backends.h"
#include "app/commands.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/scene_options.h"
#include "app/stopping_options.h"
#include "app/symptoms.h"
#include "app/validators.h"
#include "core/log.h"
#include "core/platform.h"
#include "report/format.h"
#include "report/sample_map.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>

namespace isolux {
namespace {

struct RenderCommand {
    SceneOptions scene;
    MethodOptions methods;
    StoppingOptions stopping;
    StoppingRule rule; ///< of `stopping`, once it has been checked
    OutputRequest output;
    std::string layers = "variance,samples";
    std::string tonemap = "none";
    std::string backend = "vulkan";
    std::string precision = "double";
    std::string json;
    std::string sampleMap;
    bool samplesGiven = false;
    bool statistics = false;
    bool explain = false;
    FeatureOptions features;
};

constexpr std::uint32_t kDefaultWidth = 512;

BackendOptions backendOptions(const RenderCommand& command) {
    BackendOptions options;
    options.backend = command.backend == "reference" ? Backend::reference : Backend::vulkan;
    options.precision = command.precision == "float" ? Precision::singlePrecision : Precision::doublePrecision;
    options.device = deviceOptions(command.scene);
    options.aovs = needsAovs(command.output.layers) ? Aovs::on : Aovs::off;
    options.counts = command.methods.counts();
    options.stopping = command.rule;
    options.dispatchSeconds = 1e-3 * command.scene.dispatchMilliseconds;
    options.features = command.features;
    return options;
}

/// Whether two names lead to one place, be there a file or not.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    return std::filesystem::weakly_canonical(a) == std::filesystem::weakly_canonical(b);
}

void checkSampleMap(const RenderCommand& command) {
    if (command.sampleMap.empty()) return;
    checkImagePath(command.sampleMap);
    for (const std::string& path : command.output.paths)
        if (sameFile(path, command.sampleMap)) throwBadInput("--sample-map", "it would replace the image");
}

/// What can be known to be wrong before any work is done.
void prepare(RenderCommand& command) {
    command.output.layers = parseLayers(command.layers);
    command.output.display.tonemap = parseTonemap(command.tonemap);
    bool anyExr = false;
    for (const std::string& path : command.output.paths) {
        checkImagePath(path);
        anyExr = anyExr || holdsLayers(path);
    }
    if (!command.json.empty()) checkTextPath(command.json);
    if (needsAovs(command.output.layers) && !anyExr)
        spdlog::warn("--aov: layers go into .exr files, and none is written");
    checkSampleMap(command);
    command.rule = stoppingRule(command.stopping);
    if (!command.samplesGiven) command.scene.samples = defaultSamples(command.rule, command.scene);
}

/// Whether a film holds what was asked for, if nothing but the rule has ended its render: all samples or, where
/// something may stop it sooner, as many of each pixel; adaptive sampling alone leaves pixels with different numbers.
bool holdsAll(const Film& film, const RenderSettings& settings, const StoppingRule& rule, Completion ending) {
    if (film.minSampleCount() == settings.sampleCount) return true;
    if (ending != Completion::whole) return false;
    if (rule.adaptive) return true;
    return (rule.seconds || rule.relativeError) && film.minSampleCount() == film.maxSampleCount();
}

Completion completionOf(const Film& film, const RenderSettings& settings, const StoppingRule& rule, Completion ending) {
    if (holdsAll(film, settings, rule, ending)) return Completion::whole;
    return ending == Completion::failed ? Completion::failed : Completion::interrupted;
}

/// What the film and the request add to the report.
void completeReport(RunReport& report, const Film& film, const SceneRun& scene, const RenderCommand& command) {
    describeFilm(report, film);
    report.timeLimit = command.rule.seconds;
    report.errorTarget = command.rule.relativeError;
    if (command.rule.adaptive)
        report.adaptive = summariseAdaptive(film, *command.rule.adaptive, scene.settings.sampleCount);
    report.layers = layerNames(command.output.layers);
    report.explanations = explainImage(gatherSymptoms(film, scene));
}

void warnOfError(const RunReport& report) {
    if (!report.errorTarget || report.errorTargetReached()) return;
    spdlog::warn("--until-error {}: not reached after {} samples a pixel, the relative RMSE is estimated as {}",
                 *report.errorTarget, report.samplesPerPixel, formatNumber(report.quality.relativeRmse));
}

/// Renders as far as it goes. What was finished before a device is lost or memory runs out is worth keeping: that error
/// is returned. It is thrown if there is no sample yet.
std::optional<Error> renderWhatCanBe(Film& film, RunReport& report, const SceneRun& scene,
                                     const RenderCommand& command) {
    ProgressBar bar("rendering", progressDisplay(command.scene));
    try {
        renderFilm(film, report, scene, backendOptions(command), bar);
    } catch (const Error& error) {
        if (film.maxSampleCount() == 0) throw;
        return error;
    }
    return std::nullopt;
}

/// Images first, then the report; the first error, if a file could not be written.
std::optional<Error> writeAll(const RenderCommand& command, const Film& film, const SceneRun& scene,
                              const RunReport& report, Completion completion) {
    std::optional<Error> first;
    try {
        writeOutputs(command.output, film, scene, report, completion);
    } catch (const Error& error) {
        first = error;
    }
    try {
        // Where a limit that was not given is the maximum, the scale ends at what was taken.
        const std::uint64_t scale =
            command.samplesGiven || command.rule.adaptive ? scene.settings.sampleCount : film.maxSampleCount();
        if (!command.sampleMap.empty()) writeImage(command.sampleMap, sampleMap(film, scale));
    } catch (const Error& error) {
        if (!first) first = error;
    }
    if (!command.json.empty()) writeText(command.json, jsonText(toJson(report)));
    return first;
}

ExitCode run(RenderCommand command) {
    prepare(command);
    const SceneRun scene = openScene(command.scene, command.methods, kDefaultWidth);
    warnOfStopping(command.rule, scene.settings);
    Film film(scene.settings.width, scene.settings.height);
    RunReport report = describeRun(scene, command.scene);
    const std::optional<Error> failure = renderWhatCanBe(film, report, scene, command);
    if (film.maxSampleCount() == 0) {
        spdlog::warn("interrupted before the first sample; nothing was written");
        return ExitCode::interrupted;
    }
    completeReport(report, film, scene, command);
    const Completion ending = failure                ? Completion::failed
                              : interruptRequested() ? Completion::interrupted
                                                     : Completion::whole;
    const Completion completion = completionOf(film, scene.settings, command.rule, ending);
    if (failure) fmt::print(stderr, "isolux: error: {}\n", failure->what());
    if (completion == Completion::whole) warnOfError(report);
    if (command.statistics || !command.scene.quiet)
        fmt::print("{}", toText(report));
    else
        for (const std::string& explanation : report.explanations) spdlog::warn("{}", explanation);
    if (command.explain) fmt::print("{}", toText(report.features));
    const std::optional<Error> unwritten = writeAll(command, film, scene, report, completion);
    // Whoever runs this again asks why the render stopped before why a file could not be replaced.
    if (unwritten && completion == Completion::whole) throw Error(*unwritten);
    if (unwritten) fmt::print(stderr, "isolux: {}\n", unwritten->what());
    if (failure) return failure->code();
    if (completion == Completion::interrupted) return ExitCode::interrupted;
    return film.diagnostics.clean() && report.validationMessages.empty() ? ExitCode::success : ExitCode::failure;
}

void addOutputOptions(CLI::App& sub, RenderCommand& command) {
    sub.add_option("-o,--output", command.output.paths, "Image to write: .exr, .png or .hdr; may be repeated")
        ->required();
    sub.add_option("--aov", command.layers,
                   "Layers of .exr files, separated by commas: variance, samples, albedo, normal, depth, object, "
                   "material; or all, none")
        ->capture_default_str();
    sub.add_option("--tonemap", command.tonemap, "Of .png files: none, reinhard, aces, agx or pbr-neutral")
        ->capture_default_str();
    sub.add_option("--exposure", command.output.display.exposure, "Of .png files, in stops")
        ->check(finiteNumber())
        ->check(CLI::Range(-100.0, 100.0))
        ->capture_default_str();
    sub.add_option("--json", command.json, "Also write the report to this file");
    sub.add_option("--sample-map", command.sampleMap,
                   "Also write in false colour how many samples each pixel took: .png, .exr or .hdr");
    sub.add_flag("--stats", command.statistics, "Print the report even with --quiet");
    sub.add_flag("--explain", command.explain,
                 "Print what was left out of the kernels for this scene and these options, and why");
}

} // namespace

void addRenderCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("render", "Render a scene to an image");
    auto command = std::make_shared<RenderCommand>();
    addSceneOptions(*sub, command->scene);
    addOutputOptions(*sub, *command);
    sub->add_option("--backend", command->backend, "What renders")
        ->check(CLI::IsMember({"vulkan", "reference"}))
        ->capture_default_str();
    sub->add_option("--precision", command->precision, "Of the reference")
        ->check(CLI::IsMember({"double", "float"}))
        ->capture_default_str();
    addStoppingOptions(*sub, command->stopping);
    addMethodOptions(*sub, command->methods);
    addFeatureOptions(*sub, command->features);
    sub->footer("Ctrl-C keeps what is done: the samples finished so far are written.\n"
                "Exit codes: 0 done, 1 failed, 2 bad usage or input, 75 try again (device lost, out of memory), "
                "130 interrupted.\n"
                "Examples:\n"
                "  isolux render scene.glb -o image.png --tonemap agx --exposure 0.5\n"
                "  isolux render scene.gltf -o image.exr --spp 1024 --seed 7 --json report.json\n"
                "  isolux render scene.gltf -o image.exr --aov all --size 1920x1080 --camera Top\n"
                "  isolux render scene.gltf -o image.exr --time 60 --environment 0.5,0.6,0.8\n"
                "  isolux render scene.gltf -o image.exr --environment sky.hdr --environment-rotation 90\n"
                "  isolux render scene.gltf -o image.exr --adaptive 0.05 --spp 4096 --sample-map samples.png\n"
                "  isolux render scene.gltf -o image.exr --until-error 0.02 --pixel-sampler sobol\n"
                "  isolux render scene.gltf -o image.exr --light-sampling light --max-depth 3 --roulette off\n"
                "  isolux render scene.gltf -o half.exr --spp 512 --first-sample 512\n"
                "  isolux render scene.gltf -o truth.exr --backend reference --precision double");
    sub->callback([command, sub, &result] {
        command->samplesGiven = sub->count("--spp") > 0;
        result = run(*command);
    });
}

} // namespace isolux
