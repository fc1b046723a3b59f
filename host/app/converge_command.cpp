// `isolux converge`: error against run time of several ways to render the same image.
#include "app/commands.h"
#include "app/converge_options.h"
#include "app/converge_output.h"
#include "app/converge_reference.h"
#include "app/converge_run.h"
#include "app/output.h"
#include "core/error.h"
#include "core/log.h"
#include "core/platform.h"
#include "report/format.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>

namespace isolux {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kDefaultWidth = 128;

FitOptions fitOptions(const ConvergeOptions& options) {
    FitOptions fit;
    fit.errors = options.errors;
    return fit;
}

ExitCode fit(const ConvergeOptions& options) {
    std::ifstream file(options.fit, std::ios::binary);
    std::stringstream text;
    if (!(text << file.rdbuf())) throwBadInput(options.fit, "cannot read");
    const std::vector<ErrorSample> samples = fromCsv(text.str(), options.fit);
    const ConvergenceReport report = summarise(samples, {}, fitOptions(options));
    makeFolder(options.folder);
    writeReport(options.folder, describeFit(options, samples), report, std::nullopt);
    fmt::print("{}", toText(report));
    return ExitCode::success;
}

/// What can be known to be wrong before any work is done, and defaults that depend on other options.
void prepare(ConvergeOptions& options) {
    if (options.scene.file.empty()) throwBadInput("SCENE", "is needed, unless --fit gives a file");
    if (options.references.size() > 2) throwBadInput("--reference", "give one image, or two independent ones");
    if (options.scene.seed >= kFirstReferenceSeed / 4)
        throwBadInput("--seed", fmt::format("must be below {}", kFirstReferenceSeed / 4));
    const SceneOptions& scene = options.scene;
    if (!options.references.empty() && !scene.width && !scene.height && scene.size.empty()) {
        const Image image = readImage(options.references.front());
        options.scene.size = fmt::format("{}x{}", image.width, image.height);
    }
    options.scene.samples = options.maxSamples.value_or(options.maxSeconds ? kSamplesInTime : kUsualSamples);
    makeFolder(options.folder);
}

void warn(const std::vector<Variant>& variants, const ConvergeOptions& options) {
    for (const Variant& variant : variants) {
        StoppingRule rule = variant.stopping;
        if (!options.maxSamples) rule.seconds = options.maxSeconds;
        RenderSettings settings = variant.settings;
        settings.sampleCount = options.scene.samples;
        warnOfStopping(rule, settings);
    }
}

/// The samples at which renders end: where time alone limits them, what the quickest variant can take in it.
std::uint32_t samplesAtEnd(const ConvergeOptions& options, const std::vector<MeasuredVariant>& variants) {
    if (options.maxSamples || !options.maxSeconds) return options.scene.samples;
    double most = 1.0;
    for (const MeasuredVariant& measured : variants)
        most = std::max(most, *options.maxSeconds / measured.secondsPerSample);
    return std::bit_floor(static_cast<std::uint32_t>(std::min<double>(most, options.scene.samples)));
}

ConvergeLimits limitsOf(const ConvergeOptions& options, const std::vector<MeasuredVariant>& variants) {
    return {options.seeds, options.scene.seed, samplesAtEnd(options, variants), options.maxSeconds, options.flipSeeds};
}

References findReferences(const ConvergeOptions& options, const SceneRun& run, const Device* device,
                          const ConvergeLimits& limits) {
    if (!options.references.empty()) return readReferences(options.references, run);
    const RenderSettings settings = referenceSettings(run.settings);
    const std::uint32_t samples = options.referenceSamples.value_or(kReferenceFactor * limits.maxSamples);
    const fs::path cache = deviceOptions(options.scene).cacheFolder;
    const ReferenceCache kept(cache.empty() ? fs::path() : cache / "references",
                              referenceKey(run, settings, options.backend));
    return renderReferences(
        run, {settings, samples, device, 1e-3 * options.scene.dispatchMilliseconds, progressDisplay(options.scene)},
        kept);
}

/// What of the variants is whole, in their order.
std::vector<ErrorSample> samplesOf(const std::vector<MeasuredVariant>& variants) {
    std::vector<ErrorSample> all;
    for (const MeasuredVariant& measured : variants) {
        const std::vector<ErrorSample> samples = measured.samples();
        all.insert(all.end(), samples.begin(), samples.end());
    }
    return all;
}

ConvergenceReport reportOf(const std::vector<MeasuredVariant>& variants, const std::vector<ErrorSample>& samples,
                           const ReferenceQuality& quality, const ConvergeOptions& options) {
    ConvergenceReport report = summarise(samples, quality, fitOptions(options));
    for (VariantSummary& summary : report.variants)
        for (const MeasuredVariant& measured : variants)
            if (measured.variant.name == summary.name) measured.complete(summary);
    return report;
}

void printReport(const ConvergenceReport& report, const References& references, const Diagnostics& diagnostics) {
    const ReferenceQuality& quality = references.meter->quality();
    fmt::print("{}", formatLine("reference", fmt::format("{}, {} samples a pixel in all, relative RMSE {} of its own",
                                                         references.method, formatNumber(quality.samplesPerPixel),
                                                         formatNumber(quality.relativeRmse()))));
    const std::vector<std::string> noisy = tooNoisyFor(report, quality);
    if (!noisy.empty())
        fmt::print("{}", formatLine("", fmt::format("its variance is above 1 % of the MSE of {}: take more samples",
                                                    fmt::join(noisy, ", "))));
    fmt::print("{}", formatLine("diagnostics", formatDiagnostics(diagnostics)));
    fmt::print("{}", toText(report));
}

Diagnostics diagnosticsOf(const std::vector<MeasuredVariant>& variants) {
    Diagnostics all;
    for (const MeasuredVariant& measured : variants) all.merge(measured.diagnostics);
    return all;
}

std::optional<EqualTimeImages> imagesOf(const ConvergeOptions& options, const std::vector<MeasuredVariant>& variants,
                                        const ConvergeLimits& limits, const ErrorMeter& meter) {
    if (options.noImages || interruptRequested()) return std::nullopt;
    ProgressBar bar("images of equal time", progressDisplay(options.scene));
    return writeImages(options.folder, variants, limits, meter, bar);
}

ExitCode conclude(const ConvergeScene& scene, const std::vector<MeasuredVariant>& variants,
                  const ConvergeLimits& limits) {
    const ErrorMeter& meter = *scene.references.meter;
    const std::vector<ErrorSample> samples = samplesOf(variants);
    if (samples.empty()) {
        spdlog::warn("interrupted before a seed was whole; nothing was written");
        return ExitCode::interrupted;
    }
    const fs::path folder = scene.options.folder;
    writeText((folder / "convergence.csv").string(), toCsv(samples));
    const ConvergenceReport report = reportOf(variants, samples, meter.quality(), scene.options);
    const Diagnostics diagnostics = diagnosticsOf(variants);
    const auto images = imagesOf(scene.options, variants, limits, meter);
    writeReport(folder, describeScene(scene, diagnostics, samples, report), report, images);
    if (!scene.options.scene.quiet) printReport(report, scene.references, diagnostics);
    if (interruptRequested()) {
        spdlog::warn("interrupted: {} has the seeds that were whole", folder.string());
        return ExitCode::interrupted;
    }
    const bool silent = scene.device == nullptr || scene.device->validationMessages().empty();
    return diagnostics.clean() && silent ? ExitCode::success : ExitCode::failure;
}

ExitCode measure(ConvergeOptions options) {
    prepare(options);
    const SceneRun run = openScene(options.scene, options.common.methods, kDefaultWidth);
    const std::vector<Variant> variants = parseVariants(options.variants, options.common, run);
    warn(variants, options);
    std::optional<Device> opened;
    if (options.backend == "vulkan") opened.emplace(deviceOptions(options.scene));
    const Device* device = opened ? &*opened : nullptr;
    std::vector<MeasuredVariant> measured =
        prepareVariants(variants, run, device, 1e-3 * options.scene.dispatchMilliseconds);
    const ConvergeLimits limits = limitsOf(options, measured);
    const References references = findReferences(options, run, device, limits);
    if (!references.meter) {
        spdlog::warn("interrupted before the references were whole; nothing was written");
        return ExitCode::interrupted;
    }
    {
        ProgressBar bar("measuring", progressDisplay(options.scene));
        measureVariants(measured, limits, *references.meter, bar);
    }
    return conclude({options, run, device, references}, measured, limits);
}

} // namespace

void addConvergeCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("converge", "Measure error against run time, variant against variant");
    auto options = std::make_shared<ConvergeOptions>();
    addConvergeOptions(*sub, *options);
    sub->footer(
        "Renders every seed of every variant in random order and takes the error at 1, 2, 4, ... samples a pixel and\n"
        "at the end. Writes convergence.csv and .json, the reference, and an image of each variant after equal time.\n"
        "Ctrl-C keeps the seeds that are whole.\n"
        "Exit codes: 0 done, 1 failed or with faulty samples, 2 bad usage or input, 75 try again, 130 interrupted.\n"
        "Examples:\n"
        "  isolux converge scene.glb -o out\n"
        "  isolux converge scene.glb -o out --variant mis --variant 'light:--light-sampling light' --max-spp 256\n"
        "  isolux converge scene.glb -o out --variant plain --variant 'sobol:--pixel-sampler sobol' --max-depth 5\n"
        "  isolux converge scene.glb -o out --variant all --variant 'adaptive:--adaptive 0.05' --max-spp 1024\n"
        "  isolux converge scene.glb -o out --max-time 10 --errors 0.1,0.05 --reference a.exr --reference b.exr\n"
        "  isolux converge --fit measured.csv -o out");
    sub->callback([options, sub, &result] {
        options->commandLine = commandLineOf(*sub);
        if (!options->fit.empty() && !options->scene.file.empty())
            throwBadInput("--fit", "takes no SCENE: nothing is rendered");
        result = options->fit.empty() ? measure(*options) : fit(*options);
    });
}

} // namespace isolux
