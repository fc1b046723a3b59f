#include "app/feature_options.h"

#include "shared/interface.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>

namespace isolux {
namespace {

constexpr const char* kLightChoice = "light-choice";

/// A feature that the kernels reach through another alone.
struct Requirement {
    bool SceneFeatures::*feature;
    bool SceneFeatures::*needed;
};

/// In such an order that one pass meets the needs of needs.
constexpr auto kRequirements =
    std::to_array<Requirement>({{&SceneFeatures::environmentMap, &SceneFeatures::environment},
                                {&SceneFeatures::roughSpecular, &SceneFeatures::specular},
                                {&SceneFeatures::absorption, &SceneFeatures::solids},
                                {&SceneFeatures::solids, &SceneFeatures::glass},
                                {&SceneFeatures::roughGlass, &SceneFeatures::glass}});

/// A constant of the kernel that follows from the options.
struct MethodFeature {
    std::uint32_t constant;
    const char* name;
    const char* present; ///< why it is compiled in, where it is
    const char* absent;
};

constexpr auto kMethods = std::to_array<MethodFeature>({
    {shared::kSpecIntegrator, "first-hit-integrators", "--integrator shows the first hit", "light is followed"},
    {shared::kSpecBounceRange, "bounce-range", "the first bounces do not count", "every bounce counts"},
    {shared::kSpecBalanceHeuristic, "balance-heuristic", "--mis-heuristic balance", "the power heuristic weighs"},
    {shared::kSpecLightLoop, "light-loop", "a hit takes several light samples", "a hit takes one light sample at most"},
    {shared::kSpecAllLights, "all-lights", "--light-choice all", "a light is chosen for each sample"},
    {shared::kSpecSampler, "pixel-samplers", "--pixel-sampler", "samples are independent"},
    {shared::kSpecKeepSamples, "replicates", "samples depend on each other", "samples are independent"},
    {shared::kSpecPixelFilter, "pixel-filter", "--pixel-filter", "the filter is a box"},
    {shared::kSpecThinLens, "thin-lens", "--aperture", "the camera is a pinhole"},
    {shared::kSpecEveryPrimitive, "every-primitive", "--accel none", "rays walk the BVH"},
    {shared::kSpecMollerTrumbore, "moller-trumbore", "--triangle-test moller-trumbore", "the watertight test is used"},
    {shared::kSpecAovs, "aovs", "--aov asks for layers of the first hit", "no layer needs them"},
    {shared::kSpecTraversalCounts, "traversal-counts", "--count-tests", "nothing counts tests"},
    {shared::kSpecPathSignatures, "path-signatures", "paths are compared", "only verify compares paths"},
});

std::vector<std::string> featureNames() {
    std::vector<std::string> names{kLightChoice};
    for (const NamedFeature& named : namedFeatures()) names.emplace_back(named.name);
    return names;
}

/// All that a kernel of these settings may hold: how paths end decides about the image, and an environment that is
/// compiled in would be seen where no light is followed.
SceneFeatures everyFeature(const SceneFeatures& needed, const RenderSettings& settings) {
    SceneFeatures all;
    all.roulette = settings.roulette.kind;
    if (followsLight(settings)) return all;
    all.environment = needed.environment;
    all.environmentMap = needed.environmentMap;
    return all;
}

/// Whether the kernels have the feature of this name.
bool isCompiled(const std::string& name, const SceneFeatures& features) {
    for (const NamedFeature& named : namedFeatures())
        if (named.name == name) return features.*named.flag;
    return name == kLightChoice ? features.lights == LightCount::many : features.roulette != Roulette::off;
}

} // namespace

void addFeatureOptions(CLI::App& command, FeatureOptions& options) {
    constexpr const char* kGroup = "Diagnostics";
    command.add_option("--features", options.base)
        ->group(kGroup)
        ->check(CLI::IsMember({"needed", "all"}))
        ->capture_default_str()
        ->description("What the kernels are compiled with: what the scene needs, or everything; the image is the same");
    command.add_option("--with", options.with)
        ->group(kGroup)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("FEATURE,...")
        ->check(CLI::IsMember(featureNames()).description(""))
        ->description("Compile these in although the scene does not need them (`isolux scene` lists them)");
}

std::optional<SceneFeatures> chosenFeatures(const FeatureOptions& options, const Scene& scene,
                                            const RenderSettings& settings) {
    if (options.base == "needed" && options.with.empty()) return std::nullopt;
    SceneFeatures features = findFeatures(scene, settings);
    const SceneFeatures all = everyFeature(features, settings);
    if (options.base == "all") return all;
    const auto asked = [&](std::string_view name) {
        return std::find(options.with.begin(), options.with.end(), name) != options.with.end();
    };
    for (const NamedFeature& named : namedFeatures())
        if (asked(named.name)) features.*named.flag = all.*named.flag;
    if (asked(kLightChoice)) features.lights = all.lights;
    for (const Requirement& requirement : kRequirements)
        if (features.*requirement.feature) features.*requirement.needed = all.*requirement.needed;
    return features;
}

std::vector<FeatureUse> explainScene(const Scene& scene, const RenderSettings& settings,
                                     const SceneFeatures& compiled) {
    std::vector<FeatureUse> uses;
    for (const FeatureNote& note : explainFeatures(scene, settings)) {
        const bool there = isCompiled(note.name, compiled);
        const char* addition = there && !note.used ? "; compiled in all the same" : "";
        uses.push_back({note.name, there, note.reason + addition});
    }
    return uses;
}

std::vector<FeatureUse> explainMethods(const Specialization& specialization) {
    std::vector<FeatureUse> uses;
    for (const MethodFeature& method : kMethods) {
        const auto found = specialization.find(method.constant);
        if (found == specialization.end()) continue;
        const bool used = found->second != 0;
        uses.push_back({method.name, used, used ? method.present : method.absent});
    }
    return uses;
}

} // namespace isolux
