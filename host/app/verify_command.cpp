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
#include "report/comparison.h"

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
    double minAgreement = 0.999;
    double maxRelativeBias = 1e-4;
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
    std::string tests; ///< a ray, if they were counted
    bool passed = false;
};

std::string testsText(const Film& film) { return formatTestsPerRay(film.boxTests, film.primitiveTests, film.rays); }

bool passes(const Outcome& outcome, const VerifyCommand& command) {
    const PairedDifferences& d = outcome.differences;
    const double agreement =
        d.litPixels == 0 ? 1.0 : static_cast<double>(d.withinTolerance) / static_cast<double>(d.litPixels);
    return d.unexplained == 0 && agreement >= command.minAgreement &&
           checkLimit(d.luminanceBias, command.maxRelativeBias) == Verdict::within && outcome.diagnostics.clean() &&
           outcome.validationMessages == 0;
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
    outcome.passed = passes(outcome, command);
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
    if (!outcome.diagnostics.clean()) fmt::print("diagnostics   not clean: render with --json to see the counts\n");
    if (outcome.validationMessages > 0) fmt::print("validation    {} messages\n", outcome.validationMessages);
    fmt::print("{}\n", outcome.passed ? "the two backends agree" : "THE TWO BACKENDS DISAGREE");
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
    json["passed"] = outcome.passed;
    fmt::print("{}\n", json.dump(2));
}

ExitCode run(const VerifyCommand& command) {
    const std::optional<Outcome> outcome = compareBackends(command);
    if (!outcome) {
        spdlog::warn("interrupted; nothing was compared");
        return ExitCode::interrupted;
    }
    command.json ? printJson(*outcome) : printText(*outcome);
    return outcome->passed ? ExitCode::success : ExitCode::failure;
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
    sub->add_option("--min-agreement", command->minAgreement, "Share of lit pixels that must be within it")
        ->check(finiteNumber())
        ->capture_default_str();
    sub->add_option("--max-relative-bias", command->maxRelativeBias, "Of the mean luminance")
        ->check(finiteNumber())
        ->capture_default_str();
    sub->add_flag("--json", command->json, "Print JSON");
    sub->footer(
        "Both backends take the same random numbers, so pixels agree to rounding unless rounding turned a path to\n"
        "another branch; path signatures tell which. Exit code 0: they agree; 1: they do not.\n"
        "Examples:\n"
        "  isolux verify scene.glb\n"
        "  isolux verify scene.glb --width 128 --spp 64 --seed 3\n"
        "  isolux verify scene.glb --light-choice all --pixel-sampler sobol");
    sub->callback([command, &result] { result = run(*command); });
}

} // namespace isolux
