#include "app/converge_variants.h"

#include "core/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace isolux {
namespace {

/// Roulette by throughput that begins so late seldom ends a path that still matters.
constexpr std::uint32_t kReferenceRouletteStart = 8;

/// Where some pixels stop early others may take so many times as many samples as the average at which a render ends.
constexpr std::uint32_t kAdaptiveFactor = 16;

std::string contextOf(const Variant& variant) { return fmt::format("--variant '{}'", variant.name); }

/// "NAME:OPTIONS"
Variant splitText(const std::string& text) {
    const std::size_t colon = text.find(':');
    Variant variant;
    variant.name = text.substr(0, colon);
    if (colon != std::string::npos) variant.options = text.substr(colon + 1);
    if (variant.name.empty()) throwBadInput("--variant", fmt::format("'{}' has no name: give NAME:OPTIONS", text));
    return variant;
}

/// An option that changes what the image converges to, and whether two settings differ in it.
struct ImageOption {
    const char* name;
    bool (*differs)(const RenderSettings& a, const RenderSettings& b);
};

constexpr std::array<ImageOption, 8> kImageOptions{{
    {"--max-depth", [](const RenderSettings& a, const RenderSettings& b) { return a.maxDepth != b.maxDepth; }},
    {"--integrator", [](const RenderSettings& a, const RenderSettings& b) { return a.integrator != b.integrator; }},
    {"--ao-distance",
     [](const RenderSettings& a, const RenderSettings& b) { return a.ambientDistance != b.ambientDistance; }},
    {"--bounces", [](const RenderSettings& a, const RenderSettings& b) { return a.bounces != b.bounces; }},
    {"--light", [](const RenderSettings& a, const RenderSettings& b) { return a.light != b.light; }},
    {"--back-faces", [](const RenderSettings& a, const RenderSettings& b) { return a.backFaces != b.backFaces; }},
    {"--pixel-filter",
     [](const RenderSettings& a, const RenderSettings& b) {
         return a.filter.kind != b.filter.kind || a.filter.radius != b.filter.radius;
     }},
    {"--aperture",
     [](const RenderSettings& a, const RenderSettings& b) {
         return a.lens.aperture != b.lens.aperture || (!a.lens.isPinhole() && a.lens.focus != b.lens.focus);
     }},
}};

void checkSameImage(const Variant& variant, const RenderSettings& common) {
    for (const ImageOption& option : kImageOptions)
        if (option.differs(variant.settings, common))
            throwBadInput(
                contextOf(variant),
                fmt::format("{} changes the image itself: give it outside of --variant, for all of them", option.name));
}

/// The words of a command line; what is wrong with them is said with the variant's name.
void parseOptions(const Variant& variant, CLI::App& app) {
    try {
        app.parse(variant.options);
    } catch (const CLI::ParseError& error) {
        throwBadInput(contextOf(variant),
                      fmt::format("{} (there are the method and stopping options of render)", error.what()));
    }
}

/// The variant's part of the settings is what its options and the common ones choose; the image's is the run's.
RenderSettings settingsOf(const MethodOptions& methods, const RenderSettings& image) {
    RenderSettings settings = chosenMethods(methods);
    settings.width = image.width;
    settings.height = image.height;
    settings.camera = image.camera;
    settings.maxDepth = image.maxDepth;
    settings.sampleCount = settings.plannedSamples = image.sampleCount;
    return settings;
}

void completeVariant(Variant& variant, const CommonMethods& common, const SceneRun& run) {
    CLI::App app;
    app.set_help_flag();
    CommonMethods chosen = common;
    addMethodOptions(app, chosen.methods);
    app.remove_option(app.get_option("--count-tests"));
    addStoppingOptions(app, chosen.stopping);
    std::optional<std::uint32_t> maxDepth;
    app.add_option("--max-depth", maxDepth);
    parseOptions(variant, app);
    if (chosen.stopping.seconds)
        throwBadInput(contextOf(variant), "--time depends on the machine: --max-time limits all variants alike");
    try {
        variant.settings = settingsOf(chosen.methods, run.settings);
        if (maxDepth) variant.settings.maxDepth = *maxDepth;
        checkSameImage(variant, run.settings);
        checkMethods(variant.settings, run.scene);
        variant.stopping = stoppingRule(chosen.stopping);
        if (variant.stopping.adaptive) variant.settings.sampleCount *= kAdaptiveFactor;
    } catch (const Error& error) {
        const bool named = std::string_view(error.what()).starts_with("--variant");
        if (named) throw;
        throwBadInput(contextOf(variant), error.what());
    }
}

} // namespace

std::vector<Variant> parseVariants(const std::vector<std::string>& texts, const CommonMethods& common,
                                   const SceneRun& run) {
    std::vector<Variant> variants;
    for (const std::string& text : texts.empty() ? std::vector<std::string>{"default"} : texts) {
        Variant variant = splitText(text);
        const auto sameName = [&](const Variant& other) { return other.name == variant.name; };
        if (std::any_of(variants.begin(), variants.end(), sameName))
            throwBadInput(contextOf(variant), "another variant has this name");
        completeVariant(variant, common, run);
        variants.push_back(std::move(variant));
    }
    return variants;
}

RenderSettings referenceSettings(const RenderSettings& settings) {
    const RenderSettings usual;
    RenderSettings reference = settings; // what is not named below may change the image
    reference.seed = usual.seed;
    reference.sampler = usual.sampler;
    reference.firstSample = usual.firstSample;
    reference.sampleCount = usual.sampleCount;
    reference.plannedSamples = usual.plannedSamples;
    reference.lightSampling = usual.lightSampling;
    reference.misHeuristic = usual.misHeuristic;
    reference.lightChoice = usual.lightChoice;
    reference.lightSamples = usual.lightSamples;
    reference.roulette = usual.roulette;
    reference.roulette.start = kReferenceRouletteStart;
    reference.intersection = usual.intersection;
    return reference;
}

} // namespace isolux
