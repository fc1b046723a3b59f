#include "support/methods.h"

#include "load/gltf.h"
#include "scene/pixel_filter.h"
#include "support/scenes.h"

#include <cmath>

namespace isolux::test {
namespace {

using enum Expectation;

void addIntegrators(std::vector<Method>& methods) {
    const std::vector<std::pair<std::string, Integrator>> integrators{{"Direct", Integrator::direct},
                                                                      {"Normals", Integrator::normals},
                                                                      {"Albedo", Integrator::albedo},
                                                                      {"Depth", Integrator::depth},
                                                                      {"Ambient", Integrator::ao}};
    for (const auto& named : integrators)
        methods.push_back({named.first, another, [kind = named.second](RenderSettings& s) { s.integrator = kind; }});
    methods.push_back({"AmbientNearby", another, [](RenderSettings& s) {
                           s.integrator = Integrator::ao;
                           s.ambientDistance = 0.4;
                       }});
}

void addLightSampling(std::vector<Method>& methods) {
    const std::vector<std::pair<std::string, LightSampling>> samplings{{"Hemisphere", LightSampling::hemisphere},
                                                                       {"Bsdf", LightSampling::bsdf},
                                                                       {"LightSampling", LightSampling::light}};
    for (const auto& named : samplings)
        methods.push_back({named.first, same, [kind = named.second](RenderSettings& s) { s.lightSampling = kind; }});
    methods.push_back({"BalanceHeuristic", same, [](RenderSettings& s) { s.misHeuristic = MisHeuristic::balance; }});
    methods.push_back({"FourLightSamples", same, [](RenderSettings& s) { s.lightSamples = 4; }});
    methods.push_back({"AllLights", same, [](RenderSettings& s) { s.lightChoice = LightChoice::all; }});
    methods.push_back({"AllLightsThrice", same, [](RenderSettings& s) {
                           s.lightChoice = LightChoice::all;
                           s.lightSamples = 3;
                       }});
    methods.push_back({"LightSamplingOfAllLights", same, [](RenderSettings& s) {
                           s.lightSampling = LightSampling::light;
                           s.lightChoice = LightChoice::all;
                           s.lightSamples = 2;
                       }});
    methods.push_back({"HemisphereOfAllLights", same, [](RenderSettings& s) {
                           s.lightSampling = LightSampling::hemisphere;
                           s.lightChoice = LightChoice::all;
                       }});
}

void addBounces(std::vector<Method>& methods) {
    methods.push_back({"DirectLight", another, [](RenderSettings& s) { s.light = LightPart::direct; }});
    methods.push_back({"IndirectLight", another, [](RenderSettings& s) { s.light = LightPart::indirect; }});
    for (const std::uint32_t depth : {0u, 1u, 3u})
        methods.push_back({"Bounce" + std::to_string(depth) + "Alone", another, [depth](RenderSettings& s) {
                               s.bounces = BounceSelection::last;
                               s.maxDepth = depth;
                           }});
}

/// The albedos of the scene are below 0.75: its square stays below the constant probability of going on.
void addRoulette(std::vector<Method>& methods) {
    methods.push_back({"RouletteOff", another, [](RenderSettings& s) {
                           s.roulette.kind = Roulette::off;
                           s.maxDepth = 6;
                       }});
    methods.push_back({"ConstantRoulette", same, [](RenderSettings& s) { s.roulette = {Roulette::constant, 0.3, 2}; }});
    methods.push_back({"EarlyRoulette", same, [](RenderSettings& s) { s.roulette.start = 1; }});
}

void addSamplers(std::vector<Method>& methods) {
    const std::vector<std::pair<std::string, PixelSampler>> samplers{{"Stratified", PixelSampler::stratified},
                                                                     {"Sobol", PixelSampler::sobol},
                                                                     {"SobolBlueNoise", PixelSampler::sobolBlueNoise}};
    for (const auto& named : samplers)
        methods.push_back({named.first, same, [kind = named.second](RenderSettings& s) { s.sampler = kind; }});
    methods.push_back({"SobolWithLightSamples", same, [](RenderSettings& s) {
                           s.sampler = PixelSampler::sobol;
                           s.lightSamples = 4;
                       }});
}

void addIntersection(std::vector<Method>& methods) {
    methods.push_back(
        {"EveryPrimitive", same, [](RenderSettings& s) { s.intersection.acceleration = Acceleration::none; }});
    methods.push_back({"MeanSplit", same, [](RenderSettings& s) { s.intersection = {Acceleration::meanSplit, 8}; }});
    methods.push_back({"SmallLeaves", same, [](RenderSettings& s) { s.intersection.maxLeafSize = 1; }});
    methods.push_back({"MollerTrumbore", same,
                       [](RenderSettings& s) { s.intersection.triangleTest = TriangleTest::mollerTrumbore; }});
}

void addCamera(std::vector<Method>& methods) {
    methods.push_back({"ThinLens", another, [](RenderSettings& s) { s.lens = {0.2, 2.0}; }});
    const std::vector<std::pair<std::string, PixelFilter>> filters{
        {"TriangleFilter", PixelFilter::triangle},
        {"GaussianFilter", PixelFilter::gaussian},
        {"BlackmanHarrisFilter", PixelFilter::blackmanHarris}};
    for (const auto& named : filters)
        methods.push_back({named.first, another, [kind = named.second](RenderSettings& s) {
                               s.filter = {kind, defaultRadius(kind)};
                           }});
}

} // namespace

PunctualLight punctualLight(PunctualKind kind, const Vec3d& position, const Vec3d& intensity) {
    PunctualLight light;
    light.name = "light";
    light.kind = kind;
    light.position = position;
    light.direction = glm::normalize(Vec3d(0.2, -1.0, -0.3));
    light.intensity = intensity;
    light.cosInner = std::cos(0.3);
    light.cosOuter = std::cos(0.7);
    return light;
}

std::vector<Method> allMethods() {
    std::vector<Method> methods;
    addIntegrators(methods);
    addLightSampling(methods);
    addBounces(methods);
    addRoulette(methods);
    addSamplers(methods);
    addIntersection(methods);
    addCamera(methods);
    return methods;
}

Scene mixedLightsScene() {
    Scene scene = loadScene(projectScene("cornell_spheres"));
    // From everywhere: at the edge of half a sky rounding decides whether a direction meets it, as it once did here.
    scene.environment = {Vec3d(0.2, 0.3, 0.4), EnvironmentExtent::sphere};
    scene.punctualLights = {punctualLight(PunctualKind::point, Vec3d(-0.6, 0.9, 0.5), Vec3d(0.5)),
                            punctualLight(PunctualKind::spot, Vec3d(0.5, 1.9, 0.0), Vec3d(4.0, 1.0, 1.0)),
                            punctualLight(PunctualKind::directional, Vec3d(0.0), Vec3d(0.5, 0.5, 0.8)),
                            punctualLight(PunctualKind::point, Vec3d(0.0, 1.0, 0.0), Vec3d(0.0))};
    return scene;
}

} // namespace isolux::test
