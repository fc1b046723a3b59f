#include "app/method_options.h"

#include "app/method_names.h"
#include "app/validators.h"
#include "core/error.h"
#include "core/log.h"
#include "scene/pixel_filter.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

namespace isolux {
namespace {

constexpr double kLargestFilterRadius = 16.0; // pixels
constexpr std::uint32_t kLargestLeaf = 8;
constexpr double kWidestLens = 1e6; // distances of focus: beyond it rays run in the lens, as far as rounding can tell

template <typename Enum> CLI::Option* addChoice(CLI::App& command, const std::string& name, Enum& target) {
    std::vector<std::string> words;
    words.reserve(kChoices<Enum>.size());
    for (const NamedChoice<Enum>& choice : kChoices<Enum>) words.emplace_back(choice.name);
    const auto choose = [&target](const std::string& word) {
        for (const NamedChoice<Enum>& choice : kChoices<Enum>)
            if (word == choice.name) target = choice.value;
    };
    return command.add_option_function<std::string>(name, choose)
        ->check(CLI::IsMember(words))
        ->default_str(choiceName(target));
}

CLI::Option* addLength(CLI::App& command, const std::string& name, std::optional<double>& target) {
    return command.add_option(name, target)->check(positiveNumber());
}

void addLightTransport(CLI::App& command, MethodOptions& options) {
    constexpr const char* kGroup = "Light transport";
    RenderSettings& chosen = options.chosen;
    addChoice(command, "--integrator", chosen.integrator)
        ->group(kGroup)
        ->description("What a sample is: light along a path, light of at most one bounce, or of the first hit its "
                      "normal, base colour, depth or ambient occlusion");
    addLength(command, "--ao-distance", options.ambientDistance)
        ->group(kGroup)
        ->description("With --integrator ao: how far occluders matter (default: any distance)");
    addChoice(command, "--light-sampling", chosen.lightSampling)
        ->group(kGroup)
        ->description("How light is found: by uniform directions, by those of the surface, by sampling lights, or by "
                      "the last two weighted (mis)");
    addChoice(command, "--mis-heuristic", chosen.misHeuristic)
        ->group(kGroup)
        ->description("How --light-sampling mis weighs them");
    command.add_option("--light-samples", chosen.lightSamples)
        ->group(kGroup)
        ->description("Shadow rays a hit: in all, or to each area light with --light-choice all")
        ->check(positiveNumber())
        ->capture_default_str();
    addChoice(command, "--light-choice", chosen.lightChoice)
        ->group(kGroup)
        ->description("Lights a hit samples: one by power for each shadow ray, or all");
}

void addPathLength(CLI::App& command, MethodOptions& options) {
    constexpr const char* kGroup = "Light transport";
    RenderSettings& chosen = options.chosen;
    addChoice(command, "--bounces", chosen.bounces)
        ->group(kGroup)
        ->description("Which count: all up to --max-depth, or the last alone");
    addChoice(command, "--light", chosen.light)
        ->group(kGroup)
        ->description("Which light counts: all, of up to one bounce, of two and more");
    command.add_option("--roulette", options.roulette)
        ->group(kGroup)
        ->description("How paths end at random: off (needs --max-depth), constant:P with P the probability of ending, "
                      "0.001 to 0.999, or throughput")
        ->capture_default_str();
    command.add_option("--roulette-start", chosen.roulette.start)
        ->group(kGroup)
        ->description("The first bounce that roulette may prevent")
        ->capture_default_str();
}

void addSampling(CLI::App& command, MethodOptions& options) {
    constexpr const char* kGroup = "Sampling";
    addChoice(command, "--pixel-sampler", options.chosen.sampler)
        ->group(kGroup)
        ->description("Where a sample's random numbers come from");
    addChoice(command, "--pixel-filter", options.chosen.filter.kind)
        ->group(kGroup)
        ->description("How samples are spread about a pixel's centre");
    addLength(command, "--filter-radius", options.filterRadius)
        ->group(kGroup)
        ->description("In pixels, of a filter other than box (default: triangle 1, gaussian and blackman-harris 1.5)")
        ->check(numberThat([](double radius) { return radius <= kLargestFilterRadius; },
                           fmt::format("at most {}", kLargestFilterRadius),
                           fmt::format("<= {}", kLargestFilterRadius)));
}

void addCamera(CLI::App& command, MethodOptions& options) {
    constexpr const char* kGroup = "Camera";
    command.add_option("--aperture", options.aperture)
        ->group(kGroup)
        ->check(nonNegativeNumber())
        ->description("Diameter of a thin lens in the scene's unit; needs --focus (default: 0, a pinhole)");
    addLength(command, "--focus", options.focus)
        ->group(kGroup)
        ->description("Distance along the view at which the lens is sharp");
}

void addIntersection(CLI::App& command, MethodOptions& options) {
    constexpr const char* kGroup = "Intersection";
    IntersectionMethod& chosen = options.chosen.intersection;
    addChoice(command, "--back-faces", options.chosen.backFaces)
        ->group(kGroup)
        ->description("Of surfaces that are not doubleSided: shown, or culled, as rasterisers do: rays pass through "
                      "from behind. What transmits has two sides always");
    addChoice(command, "--accel", chosen.acceleration)
        ->group(kGroup)
        ->description("How rays find primitives: by testing all, or by a BVH split at the mean or by surface area");
    command.add_option("--leaf-size", chosen.maxLeafSize)
        ->group(kGroup)
        ->description("Most primitives in a leaf of the BVH")
        ->check(CLI::Range(1u, kLargestLeaf))
        ->capture_default_str();
    addChoice(command, "--triangle-test", chosen.triangleTest)
        ->group(kGroup)
        ->description("moller-trumbore may let rays through between triangles");
    command.add_flag("--count-tests", options.countTests)
        ->group(kGroup)
        ->description("Count the boxes and primitives that rays are tested against");
}

FilterSettings chosenFilter(const MethodOptions& options) {
    FilterSettings filter = options.chosen.filter;
    if (filter.kind == PixelFilter::box && options.filterRadius)
        throwBadInput("--filter-radius", "the box filter is as wide as a pixel: choose another --pixel-filter");
    filter.radius = options.filterRadius.value_or(defaultRadius(filter.kind));
    return filter;
}

ThinLens chosenLens(const MethodOptions& options) {
    if (options.focus && !options.aperture) throwBadInput("--focus", "needs --aperture: a pinhole is sharp everywhere");
    ThinLens lens;
    lens.aperture = options.aperture.value_or(0.0);
    if (!lens.isPinhole() && !options.focus)
        throwBadInput("--aperture", "needs --focus, the distance at which the image is sharp");
    lens.focus = options.focus.value_or(lens.focus);
    if (!(lens.aperture / lens.focus < kWidestLens))
        throwBadInput("--aperture", fmt::format("must be less than {} times --focus", kWidestLens));
    return lens;
}

// --- Against the rest of the settings ---

void checkDepth(const RenderSettings& settings) {
    if (settings.maxDepth != kUnlimitedDepth) return;
    if (settings.bounces == BounceSelection::last) throwBadInput("--bounces last", "needs --max-depth");
    const bool endless = followsLight(settings) && countedBounces(settings).last == kUnlimitedDepth;
    if (endless && settings.roulette.kind == Roulette::off)
        throwBadInput("--roulette off", "needs --max-depth: no path would end");
}

/// That some bounce is left to count.
void checkBounces(const RenderSettings& settings) {
    const BounceRange range = countedBounces(settings);
    if (range.first <= range.last) return;
    const bool last = settings.bounces == BounceSelection::last && range.first == settings.maxDepth;
    const std::string end = range.last == settings.maxDepth             ? fmt::format("--max-depth {}", range.last)
                            : settings.integrator == Integrator::direct ? "--integrator direct"
                                                                        : "--light direct";
    throwBadInput(last ? "--bounces last" : "--light indirect",
                  fmt::format("counts from bounce {} on, and {} ends at bounce {}: nothing is left", range.first, end,
                              range.last));
}

/// Every pixel takes a part of one sequence of 2^32 points, 16 times over (sobolBlueNoiseBlock).
void checkBlueNoise(const RenderSettings& settings) {
    if (settings.sampler != PixelSampler::sobolBlueNoise) return;
    const auto pixelBits =
        2 * static_cast<std::uint32_t>(std::bit_width(std::max(settings.width, settings.height) - 1));
    const std::uint64_t samples = std::uint64_t{settings.firstSample} + settings.sampleCount;
    if (pixelBits + cellBitsOf(settings) <= 32) return;
    throwBadInput(
        "--spp", fmt::format("--pixel-sampler sobol-blue-noise has {} samples for each of {} x {} pixels, and "
                             "samples up to {} are asked for: give a lower --spp, or a smaller image",
                             std::uint64_t{kReplicates} << (32 - pixelBits), settings.width, settings.height, samples));
}

/// Options that say nothing beside the others.
std::vector<std::string> idleMethods(const RenderSettings& settings, const Scene& scene) {
    std::vector<std::string> idle;
    const bool followed = followsLight(settings);
    // Scattered rays find all other lights: there is nothing to sample.
    const bool sampled = settings.lightSampling == LightSampling::mis ||
                         settings.lightSampling == LightSampling::light || !scene.punctualLights.empty();
    const auto says = [&](const std::string& option) {
        if (option == "light-sampling" || option == "bounces" || option == "light" || option == "roulette")
            return followed;
        if (option == "light-samples" || option == "light-choice") return followed && sampled;
        if (option == "mis-heuristic") return followed && settings.lightSampling == LightSampling::mis;
        if (option == "roulette-start") return followed && settings.roulette.kind != Roulette::off;
        return option != "leaf-size" || settings.intersection.acceleration != Acceleration::none;
    };
    for (const MethodChoice& method : methodsOf(settings))
        if (!says(method.option)) idle.push_back("--" + method.option);
    return idle;
}

} // namespace

void addMethodOptions(CLI::App& command, MethodOptions& options) {
    addLightTransport(command, options);
    addPathLength(command, options);
    addSampling(command, options);
    addCamera(command, options);
    addIntersection(command, options);
}

RenderSettings chosenMethods(const MethodOptions& options) {
    RenderSettings settings = options.chosen;
    const std::uint32_t start = settings.roulette.start;
    settings.roulette = parseRoulette(options.roulette);
    settings.roulette.start = start;
    settings.filter = chosenFilter(options);
    settings.lens = chosenLens(options);
    if (!options.ambientDistance) return settings;
    if (settings.integrator != Integrator::ao) throwBadInput("--ao-distance", "needs --integrator ao");
    settings.ambientDistance = *options.ambientDistance;
    return settings;
}

void checkMethods(const RenderSettings& settings, const Scene& scene) {
    checkDepth(settings);
    checkBounces(settings);
    checkBlueNoise(settings);
    const std::vector<std::string> idle = idleMethods(settings, scene);
    if (!idle.empty()) spdlog::warn("{}: without effect beside the other options", fmt::join(idle, ", "));
    const bool culls = std::any_of(scene.materials.begin(), scene.materials.end(),
                                   [](const Material& material) { return material.isSingleSided(); });
    if (settings.backFaces == BackFaces::culled && !culls)
        spdlog::warn("--back-faces culled: without effect, every material is double-sided or transmits");
}

} // namespace isolux
