// Roughness from mirrors to chalk, indices of refraction from 1 on, and total reflection at its edge: in white
// furnaces, where nothing may be lost, and where a surface reflects a lamp.
#include "core/error.h"
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace isolux {
namespace {

/// How well the tables of albedos make up for what rough lobes lose (host/scene/README.md, "Albedo tables").
constexpr double kCompensation = 5e-3;

/// Longer than paths in glass of any index here are.
constexpr std::uint32_t kLongPaths = 1000;

Material metalOf(double alpha) {
    Material material;
    material.metallic = 1.0;
    material.roughness = std::sqrt(alpha);
    return material;
}

Material solidGlass(double ior, double alpha) {
    Material material;
    material.ior = ior;
    material.roughness = std::sqrt(alpha);
    material.transmission = 1.0;
    material.thickness = 1.0;
    return material;
}

/// A sphere that fills the image, in a world of radiance 1.
Scene sphereInFurnace(const Material& material) {
    SceneBuilder builder;
    builder.scene.materials[0] = material;
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.scene.spheres = {{"", Vec3d(0.0), 1.0, 0}};
    builder.camera({0.0, 0.0, 10.0}, Vec3d(0.0), 0.14);
    return builder.scene;
}

RenderTrial metalInFurnace(double alpha) {
    RenderTrial trial = expecting(1.0, sphereInFurnace(metalOf(alpha)), scatteringAlone(1));
    trial.expectedUncertainty = kCompensation;
    return trial;
}

/// White metal in whose mirror direction there is a lamp of radiance 1, wide enough for all of a narrow lobe.
RenderTrial lampInMetal(double alpha) {
    SceneBuilder builder;
    builder.scene.materials[0] = metalOf(alpha);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(1.0), Faces::both);
    builder.mesh(squareMesh(0));
    builder.mesh(squareMesh(lamp), translation({-2.0, 0.0, 2.0}));
    parallelCamera(builder, {2.0, 0.0, 2.0}, Vec3d(0.0), 0.1);
    RenderTrial trial = expecting(1.0, builder.scene, directLight());
    trial.expectedUncertainty = kCompensation;
    constexpr double kNarrow = 1.5e-3; // 0.01 % of the lobe lies beyond the lamp
    if (alpha > kNarrow) trial.expected.reset();
    return trial;
}

/// Whatever way a path takes, radiance shrinks by the square of the index as it enters and grows by it as it leaves.
/// One that gets out through a gap has not grown again.
RenderTrial clearSphere(double ior) {
    RenderTrial trial = expecting(1.0, sphereInFurnace(solidGlass(ior, 0.0)), scatteringAlone(kLongPaths));
    const double lost = 1.0 - 1.0 / (ior * ior);
    if (lost > 0.1) trial.probe = Probe{1.0, lost, Symptom::leak};
    return trial;
}

RenderTrial roughSphere(double alpha) {
    RenderTrial trial = expecting(1.0, sphereInFurnace(solidGlass(1.5, alpha)), scatteringAlone(64));
    trial.expectedUncertainty = kCompensation;
    return trial;
}

/// A thin wall of rough glass with a share of metal in it, all white.
RenderTrial metalInGlass(double metallic) {
    Material material = solidGlass(1.5, 0.25);
    material.thickness = 0.0;
    material.specular = 1.0;
    material.metallic = metallic;
    RenderTrial trial = expecting(1.0, sphereInFurnace(material), scatteringAlone(64));
    trial.expectedUncertainty = kCompensation;
    return trial;
}

constexpr double kGlassIndex = 1.5;

/// Exact, unpolarised; eta: the index beyond over that on the side of the cosine.
double fresnel(double cosine, double eta) {
    const double squared = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    if (squared <= 0.0) return 1.0;
    const double beyond = std::sqrt(squared);
    const double parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
    const double perpendicular = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

enum class GlassFaces { up, down };

/// A face of glass at y = 0, seen from within it at an angle to its normal. Only the sky, y > 0, has light: beyond
/// glass that faces up, and behind the camera in glass that faces down.
Scene glassFromInside(double angle, GlassFaces faces) {
    const double outward = faces == GlassFaces::up ? 1.0 : -1.0;
    Mat4d pose(0.0);
    pose[0][0] = 10.0;
    pose[1][2] = -10.0 * outward;
    pose[2][1] = outward;
    pose[3][3] = 1.0;
    SceneBuilder builder;
    builder.scene.materials[0] = solidGlass(kGlassIndex, 0.0);
    builder.mesh(squareMesh(0), pose);
    builder.scene.environment = {Vec3d(1.0), EnvironmentExtent::upperHalf};
    const Vec3d towards(std::sin(angle), outward * std::cos(angle), 0.0);
    parallelCamera(builder, -towards, Vec3d(0.0), 0.1);
    return builder.scene;
}

double criticalAngle() { return std::asin(1.0 / kGlassIndex); }

/// Many samples: near the edge few get out.
RenderTrial transmittedShortOf(double edge) {
    const double angle = criticalAngle() - edge;
    const double reflected = fresnel(std::cos(angle), 1.0 / kGlassIndex);
    RenderSettings settings = scatteringAlone(1);
    settings.sampleCount = 32;
    return expecting(kGlassIndex * kGlassIndex * (1.0 - reflected), glassFromInside(angle, GlassFaces::up), settings);
}

RenderTrial reflectedBeyond(double edge) {
    RenderTrial trial = expecting(1.0, glassFromInside(criticalAngle() + edge, GlassFaces::down), scatteringAlone(1));
    constexpr double kAngleIsKnown = 5e-7; // nearer to the edge rounding may take a ray to its other side
    if (edge > kAngleIsKnown) trial.probe = Probe{1.0, 1.0, Symptom::leak};
    return trial;
}

/// No renderer is asked: what they read must not contain such a surface.
Trial refused(double ior) {
    return trialBy([ior](const StressBench&) {
        StressFigures figures;
        figures.renderer = kStressDevice;
        figures.faults.tried = 1;
        figures.failure = fmt::format("an index of refraction of {} was not refused", ior);
        try {
            validate(sphereInFurnace(solidGlass(ior, 0.0)));
        } catch (const Error& error) {
            if (std::string_view(error.what()).find("index of refraction") != std::string_view::npos)
                figures.failure.clear();
        }
        return std::vector<StressFigures>{figures};
    });
}

std::vector<PlannedSweep> roughnessSweeps(Extent extent) {
    const StressSweep metal{
        "metal",
        "A sphere of white metal in a white furnace",
        "alpha",
        StressAxis::logarithmic,
        "None: the distribution squares no cosine, and the weight of a sampled direction has no density in it. Lobes "
        "below 1e-5 are mirrors. What rough lobes lose between microfacets is made up for from tables, to 0.15 %.",
        {}};
    const StressSweep lamp{
        "metal lamp",
        "A lamp reflected in white metal",
        "alpha",
        StressAxis::logarithmic,
        "A direction to a light names its microfacet to some u/alpha, u = 2^-24, in units of the lobe's width: values "
        "of light samples err as much in a lobe as narrow as 1e-5, by 1 %. There scattering finds the lamp and has "
        "nearly all the weight.",
        {}};
    const StressSweep glass{
        "rough glass",
        "A sphere of rough glass in a white furnace",
        "alpha",
        StressAxis::logarithmic,
        "As metal; the tables make up for losses to 0.13 % seen from outside and to 0.42 % from inside. Below "
        "alpha * (ior - 1) = 1e-5 glass is smooth.",
        {}};
    std::vector<PlannedStep> metals = thinned(stepsBy({0, -5, -1}, metalInFurnace), extent);
    constexpr double kOffTheAxis = 1e-6; // has no place for 0; and a mirror needs a kernel of its own
    if (extent == Extent::full) metals.push_back({kOffTheAxis, "0", trialOf([] { return metalInFurnace(0.0); })});
    return {{metal, std::move(metals)},
            {lamp, thinned(stepsBy({0, -5, -1}, lampInMetal), extent)},
            {glass, thinned(stepsBy({0, -5, -1}, roughSphere), extent)}};
}

PlannedStep clearStep(double difference, std::string label) {
    const double ior = 1.0 + difference;
    constexpr double kOffTheAxis = 1e-8; // stands for 0
    return {difference > 0.0 ? difference : kOffTheAxis, std::move(label), trialOf([ior] { return clearSphere(ior); })};
}

PlannedSweep indexSweep(Extent extent) {
    const StressSweep about{
        "index",
        "A sphere of clear glass in a white furnace",
        "index of refraction - 1 (1e-8 stands for 0)",
        StressAxis::logarithmic,
        "Below 1 + u, u = 2^-24, the index is 1. Fresnel's terms are differences that cancel as they should: what is "
        "not reflected goes on. Beyond, paths bounce (index + 1)^2/(4 index) times inside.",
        {}};
    std::vector<PlannedStep> steps{clearStep(0.0, "1"),      clearStep(1e-7, "1 + 1e-7"), clearStep(1e-5, "1 + 1e-5"),
                                   clearStep(1e-3, "1.001"), clearStep(0.1, "1.1"),       clearStep(0.5, "1.5"),
                                   clearStep(1.5, "2.5"),    clearStep(9.0, "10"),        clearStep(99.0, "100")};
    return {about, thinned(std::move(steps), extent)};
}

std::vector<PlannedSweep> totalReflectionSweeps(Extent extent) {
    constexpr const char* kAxis = "angle to the critical one, rad";
    const StressSweep below{
        "critical",
        "What gets out of glass short of the critical angle",
        kAxis,
        StressAxis::logarithmic,
        "The squared cosine beyond, 2.2 angles to the edge, is a difference of numbers near 1, known to some 3 u, u = "
        "2^-24; what gets out goes with its root and errs by 4e-8/angle: 0.1 % at 4e-5.",
        {},
        4e-5};
    const StressSweep beyond{
        "total reflection",
        "Glass seen from within beyond the critical angle",
        kAxis,
        StressAxis::logarithmic,
        "The cosine of the view is known to u/2, u = 2^-24: an angle further than some u beyond the critical one "
        "reflects all. Every ray that gets out before is counted.",
        {}};
    return {{below, thinned(stepsBy({-1, -7, -1}, transmittedShortOf), extent)},
            {beyond, thinned(stepsBy({-1, -7, -1}, reflectedBeyond), extent)}};
}

PlannedSweep mixtureSweep(Extent extent) {
    const StressSweep about{"mixture",
                            "A thin wall of rough glass with a share of metal, in a white furnace",
                            "share of metal",
                            StressAxis::logarithmic,
                            "The share of glass, 1 - metal, is rounded to u/2, u = 2^-24, and so is what it leaves; "
                            "metal is what is left of "
                            "the rest. Shares below u are none.",
                            {}};
    std::vector<PlannedStep> steps{{0.9, "0.9", trialOf([] { return metalInGlass(0.9); })}};
    for (PlannedStep& step : stepsBy({-1, -7, -1}, metalInGlass)) steps.push_back(std::move(step));
    return {about, thinned(std::move(steps), extent)};
}

PlannedSweep refusedSweep(Extent extent) {
    const StressSweep about{"below 1",          "Indices of refraction below 1 are refused", "index of refraction",
                            StressAxis::linear, "Nothing is rendered; checked in double.",   {}};
    std::vector<PlannedStep> steps;
    for (const double ior : {-1.0, 0.0, 0.5, 0.999}) steps.push_back({ior, fmt::format("{}", ior), refused(ior)});
    steps.push_back({1.0 - 1e-7, "1 - 1e-7", refused(1.0 - 1e-7)});
    return {about, thinned(std::move(steps), extent)};
}

} // namespace

std::vector<PlannedSweep> surfaceSweeps(Extent extent) {
    std::vector<PlannedSweep> sweeps = roughnessSweeps(extent);
    sweeps.push_back(indexSweep(extent));
    for (PlannedSweep& sweep : totalReflectionSweeps(extent)) sweeps.push_back(std::move(sweep));
    sweeps.push_back(mixtureSweep(extent));
    sweeps.push_back(refusedSweep(extent));
    return sweeps;
}

} // namespace isolux
