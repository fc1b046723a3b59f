// Stiff transport: furnaces whose walls reflect nearly all, paths of many bounces, roulette of every kind, light
// through a pinhole, and solids that absorb hardly anything or nearly all.
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace isolux {
namespace {

/// An albedo by what it lacks to 1, as single precision holds it: what rounding it costs is no renderer's fault.
double albedoLacking(double gap) { return static_cast<double>(static_cast<float>(1.0 - gap)); }

std::uint32_t rounded(double count) { return static_cast<std::uint32_t>(std::llround(count)); }

/// A closed room whose walls emit 1.
Scene furnaceRoom(double albedo) {
    SceneBuilder builder;
    builder.mesh(roomMesh(builder.material(Vec3d(albedo), Vec3d(1.0), Faces::front)));
    builder.camera({0.1, -0.2, 0.3}, {1.0, 0.5, -1.0}, 1.0);
    return builder.scene;
}

/// The same without corners.
Scene furnaceSphere(double albedo) {
    SceneBuilder builder;
    builder.scene.spheres = {{"", Vec3d(0.0), 1.0, builder.material(Vec3d(albedo), Vec3d(1.0), Faces::both)}};
    builder.camera(Vec3d(0.0), {0.0, 0.0, -1.0}, 1.0);
    return builder.scene;
}

RenderSettings furnaceSettings(std::uint32_t size, std::uint32_t samples, std::uint32_t maxDepth) {
    RenderSettings settings = scatteringAlone(maxDepth);
    settings.width = settings.height = size;
    settings.sampleCount = samples;
    return settings;
}

RenderSettings rouletteSettings(std::uint32_t size, std::uint32_t samples, const RouletteSettings& roulette) {
    RenderSettings settings = furnaceSettings(size, samples, kUnlimitedDepth);
    settings.roulette = roulette;
    return settings;
}

/// Radiance in a furnace after some bounces: the sum of the albedo's powers.
double afterBounces(double albedo, std::uint32_t bounces) {
    const double terms = bounces + 1.0;
    return albedo == 1.0 ? terms : -std::expm1(terms * std::log(albedo)) / (1.0 - albedo);
}

/// No path ends before a 1e-7 of its light is left; every sample is the same.
RenderTrial nearlyWhiteRoom(double gap) {
    const double albedo = albedoLacking(gap);
    const std::uint32_t depth = rounded(std::log(1e-7) / std::log(albedo));
    return expecting(afterBounces(albedo, depth), furnaceRoom(albedo), furnaceSettings(4, 2, depth));
}

/// White walls lose nothing: each bounce adds 1.
RenderTrial whiteRoom(double bounces) {
    RenderSettings settings = furnaceSettings(4, 2, rounded(bounces));
    settings.height = 2; // eight paths at once, which is what a processor's vectors hold
    return expecting(bounces + 1.0, furnaceRoom(1.0), settings);
}

/// Roulette begins once a thousandth of the light is left, so that it can hardly be seen in the noise.
RenderTrial lateRoulette(double gap) {
    const double albedo = albedoLacking(gap);
    RouletteSettings roulette;
    constexpr double kStiffest = 5e-6; // beyond, a third of the light is left to roulette: paths are long enough
    roulette.start = rounded((gap < kStiffest ? 1.0 : 7.0) / gap);
    const bool manyPaths = gap > 5e-3;
    RenderSettings settings = rouletteSettings(manyPaths ? 8 : 4, manyPaths ? 16 : 2, roulette);
    if (gap < kStiffest) settings.height = 2;
    return expecting(1.0 / (1.0 - albedo), furnaceSphere(albedo), settings);
}

RenderTrial earlyRoulette(double start) {
    const double albedo = albedoLacking(0.1);
    RouletteSettings roulette;
    roulette.start = rounded(start);
    return expecting(1.0 / (1.0 - albedo), furnaceSphere(albedo), rouletteSettings(32, 8, roulette));
}

RenderTrial constantRoulette(double termination) {
    const RouletteSettings roulette{Roulette::constant, termination, 1};
    return expecting(2.0, furnaceSphere(0.5), rouletteSettings(16, 8, roulette));
}

/// The square [-1, 1]^2 at z = 0 with a square hole of this half size, in rings, so that no triangle is a sliver.
Mesh wallWithHole(double hole, std::uint32_t material) {
    constexpr std::array<std::array<float, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    Mesh mesh;
    mesh.material = material;
    const auto addRing = [&](double size) {
        for (const auto& [x, y] : kCorners) mesh.positions.push_back(Vec3f(x, y, 0.0f) * static_cast<float>(size));
    };
    double size = hole;
    while (size < 1.0) {
        const auto inner = static_cast<std::uint32_t>(mesh.positions.size());
        addRing(size);
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t next = (i + 1) % 4, outer = inner + 4;
            mesh.triangles.push_back({inner + i, outer + i, outer + next});
            mesh.triangles.push_back({inner + i, outer + next, inner + next});
        }
        size *= 4.0;
    }
    addRing(1.0);
    return mesh;
}

/// The mean over [-x, x] x [-y, y], by five points of Gauss and Legendre along each axis.
template <typename Function> double meanOverRectangle(double x, double y, const Function& f) {
    constexpr std::array<double, 5> kPlaces{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                            0.9061798459386640};
    constexpr std::array<double, 5> kWeights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                             0.4786286704993665, 0.2369268850561891};
    double sum = 0.0;
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j) sum += 0.25 * kWeights[i] * kWeights[j] * f(x * kPlaces[i], y * kPlaces[j]);
    return sum;
}

constexpr double kPatchHalfHeight = 0.1;
constexpr double kPatchHalfWidth = 0.2; // seen at 30 degrees

/// What the patch of floor, a unit below the hole, sees of it: the mean form factor.
double formFactorOfHole(double hole) {
    return 4.0 * hole * hole * meanOverRectangle(kPatchHalfWidth, kPatchHalfHeight, [&](double px, double py) {
               return meanOverRectangle(hole, hole, [&](double x, double y) {
                   const double squared = 1.0 + (x - px) * (x - px) + (y - py) * (y - py);
                   return 1.0 / (kPi * squared * squared);
               });
           });
}

/// A grey floor under a wall with a hole, and close above it a lamp that fills the hole from all of the patch that is
/// seen, and little more: two of three light samples come through. A roof keeps the hole in the middle of the scene.
RenderTrial pinhole(double hole) {
    SceneBuilder builder;
    const double emission = 1.0 / (hole * hole), lampHalf = (1.25 + hole) * hole;
    const std::uint32_t black = builder.material(Vec3d(0.0), Vec3d(0.0), Faces::front);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(emission), Faces::front);
    builder.scene.materials[0].baseColor = Vec3d(0.5);
    builder.mesh(squareMesh(0), translation({0.0, 0.0, -1.0}));
    builder.mesh(wallWithHole(hole, black));
    builder.mesh(squareMesh(lamp), translation({0.0, 0.0, hole}) * scaling({lampHalf, -lampHalf, -1.0}));
    builder.mesh(squareMesh(black), translation({0.0, 0.0, 1.0}));
    const Vec3d patch(0.0, 0.0, -1.0);
    parallelCamera(builder, patch + 2.5 * Vec3d(std::sqrt(0.75), 0.0, 0.5), patch, kPatchHalfHeight);
    RenderSettings settings = directLight();
    settings.sampleCount = hole < 5e-6 ? 256 : 64;
    return expecting(0.5 * emission * formFactorOfHole(hole), builder.scene, settings);
}

/// A slab that reflects and bends nothing, seen straight through against a sky of 1.
RenderTrial slab(double absorption, double thickness) {
    Material material;
    material.transmission = 1.0;
    material.roughness = 0.0;
    material.ior = 1.0;
    material.thickness = 1.0; // above 0: a solid
    material.attenuationColor = Vec3d(std::exp(-1.0));
    material.attenuationDistance = 1.0 / absorption;
    SceneBuilder builder;
    builder.scene.materials[0] = material;
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.mesh(blockMesh(0), scaling({1.0, 1.0, 0.5 * thickness}));
    parallelCamera(builder, {0.0, 0.0, thickness + 1.0}, Vec3d(0.0), 0.5);
    RenderTrial trial;
    trial.scene = builder.scene;
    trial.settings = furnaceSettings(16, 2, 4);
    const double left = std::exp(-absorption * thickness);
    if (left > 0.0)
        trial.expected = left;
    else
        trial.probe = Probe{0.0, 1e-6, Symptom::leak};
    return trial;
}

RenderTrial slabOfDepthOne(double absorption) { return slab(absorption, 1.0 / absorption); }
RenderTrial slabOfDepth(double depth) { return slab(depth, 1.0); }

std::vector<PlannedSweep> furnaceSweeps(Extent extent) {
    const bool full = extent == Extent::full;
    const StressSweep albedo{
        .name = "albedo",
        .title = "A closed room that reflects nearly all, without roulette",
        .axisTitle = "1 - albedo",
        .limit = "u = 2^-24. If all roundings agreed, the throughput would be off by u/(1 - albedo) on average and the "
                 "sum by some 7 u/(1 - albedo): 0.1 % at 5e-4. They do not agree. The albedo itself is taken as single "
                 "precision has it: rounded by u/2 it would change the answer by 3e-8/(1 - albedo)."};
    const StressSweep bounces{.name = "bounces",
                              .title = "Paths in a white room, every bounce adding 1",
                              .axisTitle = "bounces",
                              .limit = "None below 2^24 = 1.7e7 bounces, up to which single precision counts exactly. "
                                       "A path that got lost at an edge would end early."};
    return {{albedo, stepsBy({-1, full ? -4 : -3, -1}, nearlyWhiteRoom)},
            {bounces, stepsBy({1, full ? 5 : 4, 1}, whiteRoom)}};
}

std::vector<PlannedSweep> rouletteSweeps(Extent extent) {
    const bool full = extent == Extent::full;
    const StressSweep late{.name = "late roulette",
                           .title = "A closed sphere that reflects nearly all, roulette starting late",
                           .axisTitle = "1 - albedo",
                           .limit =
                               "A path that survives with the probability of its albedo keeps its throughput: nothing "
                               "is rounded any more, and its length is geometric. Before that, with 1 - albedo = 17 u "
                               "(1e-6, u = 2^-24), a product loses some whole number of last places, 9 to 17, rounded "
                               "by up to 6 % either way: the throughput strays by up to 0.14 %, the sum by 0.02 %."};
    const StressSweep early{.name = "early roulette",
                            .title = "Roulette by throughput from some bounce on, albedo 0.9",
                            .axisTitle = "first bounce that may be prevented",
                            .limit = "None: what survives is divided by the probability with which it did. Noise alone "
                                     "grows as roulette starts early."};
    const StressSweep constant{.name = "constant roulette",
                               .title = "Roulette of a constant probability, albedo 0.5",
                               .axisTitle = "probability of ending",
                               .limit = "Not rounding: the throughput is divided by 1 - termination a bounce, and the "
                                        "variance is finite below 1 - albedo^2 = 0.75 alone."};
    std::vector<PlannedStep> lateSteps = stepsBy({-1, full ? -4 : -3, -1}, lateRoulette);
    if (full) lateSteps.push_back(stepsBy({-6, -6, -1}, lateRoulette).front());
    return {{late, std::move(lateSteps)},
            {early, thinned(stepsAt({32, 16, 8, 4, 1}, earlyRoulette), extent)},
            {constant, thinned(stepsAt({0.001, 0.01, 0.1, 0.3, 0.6}, constantRoulette), extent)}};
}

PlannedSweep pinholeSweep(Extent extent) {
    const StressSweep about{
        .name = "pinhole",
        .title = "A floor lit through a hole in a wall",
        .axisTitle = "the hole's size over the wall's",
        .limit = "From every point of the floor the hole's edges lie off by some u/2 of their "
                 "distance, u = 2^-24, to either side: rounding decides about a share u/size of "
                 "the light, 6 % at 1e-6, of which not all cancels: measured is 0.9 %, and 0.1 % at 1e-5.",
        .promisedFrom = 1e-5};
    if (extent == Extent::quick) return {about, stepsBy({-1, -5, -2}, pinhole)};
    return {about, stepsBy({-1, -6, -1}, pinhole)};
}

std::vector<PlannedSweep> absorptionSweeps(Extent extent) {
    const StressSweep absorption{.name = "absorption",
                                 .title = "A slab that leaves 1/e of the light, however thin or thick",
                                 .axisTitle = "absorption per width of the slab",
                                 .limit =
                                     "The way inside is known to some 4 u, u = 2^-24, of itself, where the slab's "
                                     "faces lie about the middle of the scene; elsewhere to 4 u of its coordinates."};
    const StressSweep depth{.name = "optical depth",
                            .title = "A slab that absorbs more and more",
                            .axisTitle = "optical depth",
                            .limit = "The exponent is known to some 6 u of itself, u = 2^-24: 0.1 % of the light at a "
                                     "depth of 2800. Light ends before: past 87 it is below 2^-126 of the sky, the "
                                     "least normal number, and devices may round that to nothing.",
                            .promisedTo = 87.0};
    std::vector<double> depths{1e-6, 1e-3, 1.0, 10.0, 80.0, 100.0, 1e3, 1e6};
    if (extent == Extent::quick) depths = {1e-6, 80.0, 1e6};
    return {{absorption, thinned(stepsBy({-6, 6, 2}, slabOfDepthOne), extent)}, {depth, stepsAt(depths, slabOfDepth)}};
}

} // namespace

std::vector<PlannedSweep> transportSweeps(Extent extent) {
    std::vector<PlannedSweep> sweeps = furnaceSweeps(extent);
    for (PlannedSweep& sweep : rouletteSweeps(extent)) sweeps.push_back(std::move(sweep));
    sweeps.push_back(pinholeSweep(extent));
    for (PlannedSweep& sweep : absorptionSweeps(extent)) sweeps.push_back(std::move(sweep));
    return sweeps;
}

} // namespace isolux
