// The words of the command line for the choices of RenderSettings, both ways: options, reports and metadata agree.
#pragma once

#include "report/run_report.h"
#include "scene/render_settings.h"

#include <array>
#include <string>
#include <vector>

namespace isolux {

template <typename Enum> struct NamedChoice {
    const char* name;
    Enum value;
};

/// Every value of an enumeration with its word, in the order in which help lists them.
template <typename Enum> inline constexpr std::array<NamedChoice<Enum>, 0> kChoices{};

template <>
inline constexpr auto kChoices<Integrator> = std::to_array<NamedChoice<Integrator>>({{"path", Integrator::path},
                                                                                     {"direct", Integrator::direct},
                                                                                     {"normals", Integrator::normals},
                                                                                     {"albedo", Integrator::albedo},
                                                                                     {"depth", Integrator::depth},
                                                                                     {"ao", Integrator::ao}});
template <>
inline constexpr auto
    kChoices<LightSampling> = std::to_array<NamedChoice<LightSampling>>({{"hemisphere", LightSampling::hemisphere},
                                                                         {"bsdf", LightSampling::bsdf},
                                                                         {"light", LightSampling::light},
                                                                         {"mis", LightSampling::mis}});
template <>
inline constexpr auto kChoices<MisHeuristic> =
    std::to_array<NamedChoice<MisHeuristic>>({{"power", MisHeuristic::power}, {"balance", MisHeuristic::balance}});
template <>
inline constexpr auto kChoices<LightChoice> = std::to_array<NamedChoice<LightChoice>>({{"one", LightChoice::one},
                                                                                       {"all", LightChoice::all}});
template <>
inline constexpr auto kChoices<BounceSelection> = std::to_array<NamedChoice<BounceSelection>>(
    {{"accumulate", BounceSelection::accumulate}, {"last", BounceSelection::last}});
template <>
inline constexpr auto kChoices<LightPart> = std::to_array<NamedChoice<LightPart>>({{"all", LightPart::all},
                                                                                   {"direct", LightPart::direct},
                                                                                   {"indirect", LightPart::indirect}});
template <>
inline constexpr auto kChoices<PixelSampler> =
    std::to_array<NamedChoice<PixelSampler>>({{"independent", PixelSampler::independent},
                                              {"stratified", PixelSampler::stratified},
                                              {"sobol", PixelSampler::sobol},
                                              {"sobol-blue-noise", PixelSampler::sobolBlueNoise}});
template <>
inline constexpr auto
    kChoices<PixelFilter> = std::to_array<NamedChoice<PixelFilter>>({{"box", PixelFilter::box},
                                                                     {"triangle", PixelFilter::triangle},
                                                                     {"gaussian", PixelFilter::gaussian},
                                                                     {"blackman-harris", PixelFilter::blackmanHarris}});
template <>
inline constexpr auto kChoices<Acceleration> = std::to_array<NamedChoice<Acceleration>>(
    {{"none", Acceleration::none}, {"mean-split", Acceleration::meanSplit}, {"sah", Acceleration::sah}});
template <>
inline constexpr auto kChoices<TriangleTest> = std::to_array<NamedChoice<TriangleTest>>(
    {{"watertight", TriangleTest::watertight}, {"moller-trumbore", TriangleTest::mollerTrumbore}});

template <>
inline constexpr auto kChoices<BackFaces> = std::to_array<NamedChoice<BackFaces>>({{"shown", BackFaces::shown},
                                                                                   {"culled", BackFaces::culled}});

template <typename Enum> [[nodiscard]] std::string choiceName(Enum value) {
    for (const NamedChoice<Enum>& choice : kChoices<Enum>)
        if (choice.value == value) return choice.name;
    return "";
}

/// "off", "constant:0.3", "throughput"
[[nodiscard]] std::string rouletteName(const RouletteSettings& roulette);

/// The inverse. Throws Error (bad input) that names --roulette.
[[nodiscard]] RouletteSettings parseRoulette(const std::string& text);

/// The methods that differ from those of RenderSettings{}, as options without their dashes.
[[nodiscard]] std::vector<MethodChoice> methodsOf(const RenderSettings& settings);

} // namespace isolux
