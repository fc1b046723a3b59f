// What to render: the part of the options that decides the image, the same for every backend. README.md of this folder
// says what each choice means to the last random number.
#pragma once

#include "core/sample_sequence.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace isolux {

inline constexpr std::uint32_t kUnlimitedDepth = std::numeric_limits<std::uint32_t>::max();

/// Roulette by throughput lets no path live with a higher probability than the larger of this, 1 - 2^-10, and the share
/// of its throughput that the last bounce left: a path that loses less than it is ended for would grow without bound,
/// and its variance with it. A bounce that leaves more than kLossless loses nothing, so that every path ends.
inline constexpr double kMaxSurvival = 1.0 - 1.0 / 1024.0;
inline constexpr double kLossless = 1.0 - 1.0 / 2097152.0;

/// Whether PixelStatistics::pathSignature is filled (README.md, path signature).
enum class PathSignatures { off, on };

/// Whether Film::aovs is filled: what camera rays meet first.
enum class Aovs { off, on };

/// Whether Film::boxTests and Film::primitiveTests are counted.
enum class TraversalCounts { off, on };

/// What a sample's value is: light along a path, or something about the first hit.
enum class Integrator { path, direct, normals, albedo, depth, ao };

/// How light is found: by uniform directions, by directions as the surface scatters, by sampling lights, by the last
/// two.
enum class LightSampling { hemisphere, bsdf, light, mis };

/// How `LightSampling::mis` weighs the two (Veach 1997, 9.2.2).
enum class MisHeuristic { power, balance };

/// Which lights a shading point samples: some chosen by power, or every one.
enum class LightChoice { one, all };

/// Which bounces are counted: all up to the last, or the last alone.
enum class BounceSelection { accumulate, last };

/// Which light is counted: all, that of 0 and 1 bounces, that of 2 and more.
enum class LightPart { all, direct, indirect };

/// The probability with which a path goes on: 1, a constant, or what it still carries.
enum class Roulette { off, constant, throughput };

/// Where the random numbers of a sample come from.
enum class PixelSampler { independent, stratified, sobol, sobolBlueNoise };

/// How samples are spread about a pixel's centre.
enum class PixelFilter { box, triangle, gaussian, blackmanHarris };

/// How rays find primitives.
enum class Acceleration { none, meanSplit, sah };

enum class TriangleTest { watertight, mollerTrumbore };

/// Whether surfaces that are not double-sided have a back. `culled`: they are not there for rays that meet it.
enum class BackFaces { shown, culled };

struct RouletteSettings {
    Roulette kind = Roulette::throughput;
    double termination = 0.3; ///< of Roulette::constant: the probability of ending, in [0.001, 0.999]
    std::uint32_t start = 4;  ///< the first bounce that roulette may prevent
};

struct ThinLens {
    double aperture = 0.0; ///< diameter of the lens, a length in the world; 0: a pinhole
    double focus = 1.0;    ///< distance along the camera's axis at which points are sharp

    [[nodiscard]] bool isPinhole() const { return aperture == 0.0; }
};

struct FilterSettings {
    PixelFilter kind = PixelFilter::box;
    double radius = 0.5; ///< pixels; the box's is always 0.5
};

/// How rays find what they meet. Acceleration never changes what that is, but for surfaces at exactly equal distances.
struct IntersectionMethod {
    Acceleration acceleration = Acceleration::sah;
    std::uint32_t maxLeafSize = 4; ///< primitives in a leaf of the BVH, 1 ... 8
    TriangleTest triangleTest = TriangleTest::watertight;
};

struct RenderSettings {
    std::uint32_t width = 512;
    std::uint32_t height = 384;
    std::uint32_t camera = 0; ///< index into Scene::cameras
    ThinLens lens;
    FilterSettings filter;
    std::uint64_t seed = 0;
    PixelSampler sampler = PixelSampler::independent;
    std::uint32_t firstSample = 0;            ///< samples firstSample ... firstSample + sampleCount - 1 are rendered
    std::uint32_t sampleCount = 64;           ///< samples a pixel; the most, if something else may stop it earlier
    std::uint32_t plannedSamples = 0;         ///< samples that samplers prepare for; 0: firstSample + sampleCount
    std::uint32_t maxDepth = kUnlimitedDepth; ///< bounces: 0 emitted light alone, 1 direct light, ...
    Integrator integrator = Integrator::path;
    BounceSelection bounces = BounceSelection::accumulate; ///< `last` needs a maxDepth
    LightPart light = LightPart::all;
    LightSampling lightSampling = LightSampling::mis;
    MisHeuristic misHeuristic = MisHeuristic::power;
    LightChoice lightChoice = LightChoice::one;
    std::uint32_t lightSamples =
        1;                     ///< shadow rays a shading point: in all if lights are chosen, else to each area light
    RouletteSettings roulette; ///< `off` needs a maxDepth
    double ambientDistance = std::numeric_limits<double>::infinity(); ///< Integrator::ao: how far occluders matter
    BackFaces backFaces = BackFaces::shown;
    IntersectionMethod intersection;
};

/// The bounces whose light counts, both included. Bounce 0 is light that the camera sees being emitted.
struct BounceRange {
    std::uint32_t first = 0;
    std::uint32_t last = kUnlimitedDepth;
};

[[nodiscard]] inline BounceRange countedBounces(const RenderSettings& settings) {
    BounceRange range{0, settings.maxDepth};
    if (settings.bounces == BounceSelection::last) range.first = settings.maxDepth;
    if (settings.light == LightPart::indirect) range.first = std::max(range.first, 2u);
    const bool direct = settings.light == LightPart::direct || settings.integrator == Integrator::direct;
    if (direct) range.last = std::min(range.last, 1u);
    return range;
}

/// Whether light is carried along paths at all.
[[nodiscard]] inline bool followsLight(const RenderSettings& settings) {
    return settings.integrator == Integrator::path || settings.integrator == Integrator::direct;
}

/// SequencePlan::cellBits of a render.
[[nodiscard]] inline std::uint32_t cellBitsOf(const RenderSettings& settings) {
    const std::uint64_t samples = std::uint64_t{settings.firstSample} + settings.sampleCount;
    return cellBitsFor(settings.plannedSamples == 0 ? samples : settings.plannedSamples);
}

/// Whether samples depend on each other, so that variance comes from the means of kReplicates replicates.
[[nodiscard]] inline bool usesReplicates(PixelSampler sampler) { return sampler != PixelSampler::independent; }

} // namespace isolux
