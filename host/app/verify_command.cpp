// `isolux verify`: both backends on the same random numbers, pixel against pixel.
#include "app/backends.h"
#include "app/commands.h"
#include "app/divergence.h"
#include "app/method_names.h"
#include "app/progress_bar.h"
#include "app/scene_options.h"
#include "app/validators.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "reference/reference.h"
#include "report/format.h"
#include "report/paired_limits.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace isolux {
namespace {

struct VerifyCommand {
    SceneOptions scene;
    MethodOptions methods;
    FeatureOptions features;
    double tolerance = 1e-3;
    PairedLimits limits;
    bool json = false;
};

constexpr std::uint32_t kDefaultWidth = 256;
constexpr std::size_t kExplainedPixels = 3;

struct Outcome {
    PairedDifferences differences;
    std::vector<std::pair<PairedPixel, Divergence>> divergences;
    double deviceSeconds = 0.0;
    double referenceSeconds = 0.0;
    std::string device;
    std::size_t validationMessages = 0;
    Diagnostics diagnostics;
    std::vector<MethodChoice> methods;
    std::string tests;                 ///< a ray, if they were counted
    std::vector<std::string> failures; ///< what the two disagree in; none: they agree
};

std::string testsText(const Film& film) { return formatTestsPerRay(film.boxTests, film.primitiveTests, film.rays); }

std::vector<std::string> failuresOf(const Outcome& outcome, const PairedLimits& limits) {
    std::vector<std::string> failures = exceededLimits(outcome.differences, limits);
    if (!outcome.diagnostics.clean()) failures.push_back("faults: " + formatDiagnostics(outcome.diagnostics));
    if (outcome.validationMessages > 0)
        failures.push_back(fmt::format("{} validation messages", outcome.validationMessages));
    return failures;
}

Film referenceFilm(const SceneRun& run, const VerifyCommand& command, Precision precision) {
    ReferenceOptions options;
    options.precision = precision;
    const bool exact = precision == Precision::doublePrecision;
    options.signatures = exact ? PathSignatures::on : PathSignatures::off;
    options.counts = exact ? command.methods.counts() : TraversalCounts::off;
    ProgressBar bar(exact ? "reference" : "single precision", progressDisplay(command.scene));
    return renderReference(run.scene, run.settings, options, bar.callback());
}

void explainBranches(Outcome& outcome, PathRenderer& renderer, const SceneRun& run) {
    for (const PairedPixel& pixel : outcome.differences.worst) {
        if (outcome.divergences.size() == kExplainedPixels || pixel.signature == Signature::same) continue;
        if (const auto divergence = findDivergence(renderer, run.scene, run.settings, pixel))
            outcome.divergences.emplace_back(pixel, *divergence);
    }
}

/// Nothing if it was interrupted.
std::optional<Outcome> compareBackends(const VerifyCommand& command) {
    const SceneRun run = openScene(command.scene, command.methods, kDefaultWidth);
    const Device device(deviceOptions(command.scene));
    RenderOptions options;
    options.signatures = PathSignatures::on;
    options.counts = command.methods.counts();
    options.dispatchSeconds = 1e-3 * command.scene.dispatchMilliseconds;
    options.features = chosenFeatures(command.features, run.scene, run.settings);
    PathRenderer renderer(device, run.scene, run.settings, options);
    Outcome outcome;
    outcome.methods = methodsOf(run.settings);
    outcome.device = fmt::format("{} ({})", device.description().name, device.description().driverVersion);
    Film film(run.settings.width, run.settings.height);
    {
        ProgressBar bar("device   ", progressDisplay(command.scene));
        renderer.render(film, bar.callback());
        outcome.deviceSeconds = bar.elapsedSeconds();
    }
    if (film.minSampleCount() < run.settings.sampleCount) return std::nullopt;
    const Stopwatch watch;
    const Film reference = referenceFilm(run, command, Precision::doublePrecision);
    outcome.referenceSeconds = watch.seconds();
    if (reference.minSampleCount() < run.settings.sampleCount) return std::nullopt;
    if (command.methods.countTests)
        outcome.tests = fmt::format("device {}, reference {}", testsText(film), testsText(reference));
    outcome.differences = pairedDifferences(film, reference, {command.tolerance, nullptr});
    if (outcome.differences.unexplained > 0) {
        const Film single = referenceFilm(run, command, Precision::singlePrecision);
        if (single.minSampleCount() < run.settings.sampleCount) return std::nullopt;
        outcome.differences = pairedDifferences(film, reference, {command.tolerance, &single});
    }
    outcome.diagnostics = film.diagnostics;
    outcome.diagnostics.merge(reference.diagnostics);
    explainBranches(outcome, renderer, run);
    outcome.validationMessages = device.validationMessages().size();
    outcome.failures = failuresOf(outcome, command.limits);
    return outcome;
}

void printText(const Outcome& outcome) {
    fmt::print("device        {}\n", outcome.device);
    if (!outcome.methods.empty()) fmt::print("methods       {}\n", formatMethods(outcome.methods));
    fmt::print("{}", toText(outcome.differences));
    for (const auto& [pixel, divergence] : outcome.divergences)
        fmt::print("pixel ({}, {}) parts at sample {}, bounce {}\n", pixel.x, pixel.y, divergence.sample,
                   divergence.bounce);
    fmt::print("time          device {:.2f} s, reference {:.2f} s\n", outcome.deviceSeconds, outcome.referenceSeconds);
    if (!outcome.tests.empty()) fmt::print("tests a ray   {}\n", outcome.tests);
    for (const std::string& failure : outcome.failures) fmt::print("disagreement  {}\n", failure);
    fmt::print("{}\n", outcome.failures.empty() ? "the two backends agree" : "THE TWO BACKENDS DISAGREE");
}

void printJson(const Outcome& outcome) {
    nlohmann::ordered_json json = toJson(outcome.differences);
    json["device"] = outcome.device;
    json["methods"] = toJson(outcome.methods);
    json["deviceSeconds"] = outcome.deviceSeconds;
    json["referenceSeconds"] = outcome.referenceSeconds;
    json["divergences"] = nlohmann::ordered_json::array();
    for (const auto& [pixel, divergence] : outcome.divergences)
        json["divergences"].push_back(
            {{"x", pixel.x}, {"y", pixel.y}, {"sample", divergence.sample}, {"bounce", divergence.bounce}});
    json["validationMessages"] = outcome.validationMessages;
    json["diagnosticsClean"] = outcome.diagnostics.clean();
    json["failures"] = outcome.failures;
    json["passed"] = outcome.failures.empty();
    fmt::print("{}\n", json.dump(2));
}

ExitCode run(const VerifyCommand& command) {
    const std::optional<Outcome> outcome = compareBackends(command);
    if (!outcome) {
        spdlog::warn("interrupted; nothing was compared");
        return ExitCode::interrupted;
    }
    command.json ? printJson(*outcome) : printText(*outcome);
    return outcome->failures.empty() ? ExitCode::success : ExitCode::failure;
}

} // namespace

void addVerifyCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("verify", "Check the Vulkan renderer against the CPU reference, path by path");
    auto command = std::make_shared<VerifyCommand>();
    command->scene.samples = 16;
    addSceneOptions(*sub, command->scene);
    addMethodOptions(*sub, command->methods);
    addFeatureOptions(*sub, command->features);
    sub->add_option("--tolerance", command->tolerance, "Relative difference that rounding may cause in a pixel")
        ->check(finiteNumber())
        ->capture_default_str();
    sub->add_option("--min-agreement", command->limits.agreement,
                    "Share of lit pixels within it below which the mean must be known to agree")
        ->check(finiteNumber())
        ->capture_default_str();
    sub->add_option("--max-relative-bias", command->limits.relativeBias, "Of the mean luminance")
        ->check(finiteNumber())
        ->capture_default_str();
    sub->add_flag("--json", command->json, "Print JSON");
    sub->footer(
        "Both backends take the same random numbers, so pixels agree to rounding unless rounding turned a path to\n"
        "another branch; path signatures tell which. The two agree if no pixel is unexplained and the interval of the\n"
        "relative bias is not wholly beyond --max-relative-bias; if fewer pixels than --min-agreement are within the\n"
        "tolerance, it must be wholly within. Exit code 0: they agree; 1: they do not, and a line says in what.\n"
        "Examples:\n"
        "  isolux verify scene.glb\n"
        "  isolux verify scene.glb --width 128 --spp 64 --seed 3\n"
        "  isolux verify scene.glb --light-choice all --pixel-sampler sobol");
    sub->callback([command, &result] { result = run(*command); });
}

} // namespace isolux
