// Known answers for every method: a closed box whose walls reflect and emit has the same radiance in every direction,
// however light is found, paths end, random numbers come about and pixels are filtered.
#include "statistical/reference_estimates.h"

#include <array>
#include <string>
#include <vector>

namespace isolux {
namespace {

using namespace test;

constexpr std::uint32_t kBounces = 5;
const Vec3d kBoxAlbedo(0.2, 0.5, 0.8);
const Vec3d kBoxEmission(3.0, 0.5, 1.0);
const Vec3d kBoxRadiance = kBoxEmission * (1.0 - glm::pow(kBoxAlbedo, Vec3d(kBounces + 1.0))) / (1.0 - kBoxAlbedo);

struct Method {
    std::string name;
    RenderSettings settings;
};

RenderSettings boxSettings() {
    RenderSettings settings = squareImage(16, 256);
    settings.maxDepth = kBounces;
    settings.roulette.start = 2;
    return settings;
}

/// Every way to find light with every kind of roulette, by a sampler, a filter, a number of light samples and a way to
/// find primitives that change from one to the next.
std::vector<Method> everyMethod() {
    constexpr std::array kRoulettes = {Roulette::off, Roulette::constant, Roulette::throughput};
    std::vector<Method> methods;
    std::uint32_t n = 0;
    for (const LightSampling sampling :
         {LightSampling::hemisphere, LightSampling::bsdf, LightSampling::light, LightSampling::mis})
        for (const Roulette roulette : kRoulettes) {
            RenderSettings settings = boxSettings();
            settings.lightSampling = sampling;
            settings.roulette.kind = roulette;
            settings.sampler = static_cast<PixelSampler>(n % 4);
            settings.filter.kind = static_cast<PixelFilter>(n / 3 % 4);
            settings.misHeuristic = n % 2 == 0 ? MisHeuristic::power : MisHeuristic::balance;
            settings.lightSamples = 1 + n % 3;
            settings.lightChoice = n % 5 == 0 ? LightChoice::all : LightChoice::one;
            settings.lens = {.aperture = 0.1 * (n % 2), .focus = 1.0};
            settings.intersection.acceleration = static_cast<Acceleration>(n % 3);
            methods.push_back({"method " + std::to_string(n), settings});
            ++n;
        }
    return methods;
}

TEST(ReferenceMethods, EveryOneHasTheRadianceOfTheSeries) {
    for (const Method& method : everyMethod()) {
        SCOPED_TRACE(method.name);
        expectRadiance(renderTotal(furnaceBox(Mat4d(1.0)), method.settings), kBoxRadiance, 0.02);
    }
}

TEST(ReferenceMethods, EveryBounceHasItsTermOfTheSeries) {
    RenderSettings settings = boxSettings();
    settings.bounces = BounceSelection::last;
    settings.roulette.kind = Roulette::off;
    for (const LightSampling sampling : {LightSampling::hemisphere, LightSampling::mis}) {
        settings.lightSampling = sampling;
        for (settings.maxDepth = 0; settings.maxDepth <= 3; ++settings.maxDepth) {
            const Vec3d term = kBoxEmission * glm::pow(kBoxAlbedo, Vec3d(settings.maxDepth));
            expectRadiance(renderTotal(furnaceBox(Mat4d(1.0)), settings), term, 0.02);
        }
    }
}

TEST(ReferenceMethods, PartsOfLightHaveTheirTerms) {
    RenderSettings settings = boxSettings();
    settings.light = LightPart::direct;
    const Vec3d direct = kBoxEmission * (1.0 + kBoxAlbedo);
    expectRadiance(renderTotal(furnaceBox(Mat4d(1.0)), settings), direct, 0.02);
    settings.light = LightPart::indirect;
    expectRadiance(renderTotal(furnaceBox(Mat4d(1.0)), settings), kBoxRadiance - direct, 0.02);
}

} // namespace
} // namespace isolux
