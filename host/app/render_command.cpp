// `isolux render`: a scene to image files, with a report of time and error.
#include "app/backends.h"
#include "app/commands.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/scene_options.h"
#include "app/symptoms.h"
#include "app/validators.h"
#include "core/log.h"
#include "core/platform.h"
#include "report/format.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace isolux {
namespace {

struct RenderCommand {
    SceneOptions scene;
    OutputRequest output;
    std::string layers = "variance,samples";
    std::string tonemap = "none";
    std::string backend = "vulkan";
    std::string precision = "double";
    std::string json;
    std::optional<double> seconds;
    bool samplesGiven = false;
    bool statistics = false;
};

constexpr std::uint32_t kDefaultWidth = 512;

BackendOptions backendOptions(const RenderCommand& command) {
    BackendOptions options;
    options.backend = command.backend == "reference" ? Backend::reference : Backend::vulkan;
    options.precision = command.precision == "float" ? Precision::singlePrecision : Precision::doublePrecision;
    options.device = deviceOptions(command.scene);
    options.aovs = needsAovs(command.output.layers) ? Aovs::on : Aovs::off;
    options.seconds = command.seconds;
    options.dispatchSeconds = 1e-3 * command.scene.dispatchMilliseconds;
    return options;
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
    // With a time limit alone there are as many samples as it allows.
    if (command.seconds && !command.samplesGiven)
        command.scene.samples = std::numeric_limits<std::uint32_t>::max() - command.scene.firstSample;
}

/// A render is whole when all its samples are taken, or, within a time limit, as many of each pixel.
Completion completionOf(const Film& film, const RenderSettings& settings, const std::optional<double>& limit,
                        Completion ending) {
    const bool whole = limit ? film.minSampleCount() == film.maxSampleCount() && ending == Completion::whole
                             : film.minSampleCount() == settings.sampleCount;
    if (whole) return Completion::whole;
    return ending == Completion::failed ? Completion::failed : Completion::interrupted;
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
    if (!command.json.empty()) writeText(command.json, jsonText(toJson(report)));
    return first;
}

ExitCode run(RenderCommand command) {
    prepare(command);
    const SceneRun scene = openScene(command.scene, kDefaultWidth);
    Film film(scene.settings.width, scene.settings.height);
    RunReport report = describeRun(scene, command.scene);
    const std::optional<Error> failure = renderWhatCanBe(film, report, scene, command);
    if (film.maxSampleCount() == 0) {
        spdlog::warn("interrupted before the first sample; nothing was written");
        return ExitCode::interrupted;
    }
    describeFilm(report, film);
    report.timeLimit = command.seconds;
    report.layers = layerNames(command.output.layers);
    report.explanations = explainImage(gatherSymptoms(film, scene));
    const Completion ending = failure                ? Completion::failed
                              : interruptRequested() ? Completion::interrupted
                                                     : Completion::whole;
    const Completion completion = completionOf(film, scene.settings, command.seconds, ending);
    if (failure) fmt::print(stderr, "isolux: error: {}\n", failure->what());
    if (command.statistics || !command.scene.quiet)
        fmt::print("{}", toText(report));
    else
        for (const std::string& explanation : report.explanations) spdlog::warn("{}", explanation);
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
    sub.add_flag("--stats", command.statistics, "Print the report even with --quiet");
}

} // namespace

void addRenderCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("render", "Render a scene to an image");
    auto command = std::make_shared<RenderCommand>();
    addSceneOptions(*sub, command->scene);
    sub->add_option("--time", command->seconds,
                    "Stop after about so many seconds of rendering; without --spp that alone decides")
        ->check(finiteNumber())
        ->check(CLI::PositiveNumber);
    addOutputOptions(*sub, *command);
    sub->add_option("--backend", command->backend, "What renders")
        ->check(CLI::IsMember({"vulkan", "reference"}))
        ->capture_default_str();
    sub->add_option("--precision", command->precision, "Of the reference")
        ->check(CLI::IsMember({"double", "float"}))
        ->capture_default_str();
    sub->footer("Ctrl-C keeps what is done: the samples finished so far are written.\n"
                "Exit codes: 0 done, 1 failed, 2 bad usage or input, 75 try again (device lost, out of memory), "
                "130 interrupted.\n"
                "Examples:\n"
                "  isolux render scene.glb -o image.png --tonemap agx --exposure 0.5\n"
                "  isolux render scene.gltf -o image.exr --spp 1024 --seed 7 --json report.json\n"
                "  isolux render scene.gltf -o image.exr --aov all --size 1920x1080 --camera Top\n"
                "  isolux render scene.gltf -o image.exr --time 60 --environment 0.5,0.6,0.8\n"
                "  isolux render scene.gltf -o half.exr --spp 512 --first-sample 512\n"
                "  isolux render scene.gltf -o truth.exr --backend reference --precision double");
    sub->callback([command, sub, &result] {
        command->samplesGiven = sub->count("--spp") > 0;
        result = run(*command);
    });
}

} // namespace isolux
