// The ways in which the CPU reference finds light agree: on the words they draw, on lights only one of them finds, and
// on the mean.
#include "reference/camera.h"
#include "reference/lights.h"
#include "report/statistics.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

/// The chance that any of a test's comparisons of means fails by accident.
constexpr double kFamilyError = 1e-4;

/// The mean luminance of an image, and the standard error of it.
struct ImageMean {
    double value = 0.0;
    double error = 0.0;
};

ImageMean meanOf(const Film& film) {
    double sum = 0.0, variance = 0.0;
    for (const PixelStatistics& pixel : film.pixels) {
        sum += luminance(pixel.mean);
        variance += pixel.luminanceVariance() / static_cast<double>(pixel.sampleCount);
    }
    const auto pixels = static_cast<double>(film.pixels.size());
    return {sum / pixels, std::sqrt(variance) / pixels};
}

/// Renders by each of the settings with seeds of their own: their means are those of the first, by intervals that all
/// hold together with a probability of 1 - kFamilyError (Bonferroni).
void expectSameMean(const Scene& scene, std::vector<RenderSettings> methods, double largestError) {
    std::vector<ImageMean> means;
    for (RenderSettings& settings : methods) {
        settings.seed += means.size();
        means.push_back(meanOf(render(scene, settings)));
    }
    const auto comparisons = static_cast<double>(methods.size() - 1);
    const double quantile = normalQuantile(1.0 - kFamilyError / (2.0 * comparisons));
    for (std::size_t i = 1; i < means.size(); ++i) {
        const double error = std::hypot(means[0].error, means[i].error);
        EXPECT_NEAR(means[i].value, means[0].value, quantile * error) << "method " << i;
        EXPECT_LT(error, largestError * means[0].value) << "too few samples to tell: method " << i;
    }
}

/// The small room under a sky, with a lamp without extent.
Scene roomWithEveryLight() {
    Scene scene = smallRoom();
    scene.punctualLights.emplace_back();
    scene.punctualLights[0].position = {-1.0, -2.0, 2.0};
    scene.punctualLights[0].intensity = Vec3d(2.0, 1.0, 1.0);
    scene.environment.radiance = Vec3d(0.1, 0.2, 0.3);
    return scene;
}

RenderSettings manySamples() {
    RenderSettings settings = smallSettings(200);
    settings.maxDepth = 3;
    return settings;
}

TEST(ReferenceLightSampling, EveryWayHasTheSameMean) {
    std::vector<RenderSettings> methods(5, manySamples());
    methods[1].misHeuristic = MisHeuristic::balance;
    methods[2].lightSampling = LightSampling::light;
    methods[3].lightSampling = LightSampling::bsdf;
    methods[4].lightSampling = LightSampling::hemisphere;
    expectSameMean(roomWithEveryLight(), methods, 0.02);
}

TEST(ReferenceLightSampling, AnyNumberOfSamplesHasTheSameMean) {
    std::vector<RenderSettings> methods(6, manySamples());
    methods[1].lightSamples = 4;
    methods[2].lightSamples = 3;
    methods[2].lightSampling = LightSampling::light;
    methods[3].lightChoice = LightChoice::all;
    methods[4].lightChoice = LightChoice::all;
    methods[4].lightSamples = 2;
    methods[4].misHeuristic = MisHeuristic::balance;
    methods[5].lightChoice = LightChoice::all;
    methods[5].lightSampling = LightSampling::light;
    expectSameMean(roomWithEveryLight(), methods, 0.02);
}

TEST(ReferenceLightSampling, RouletteOfAnyKindHasTheSameMean) {
    std::vector<RenderSettings> methods(4, manySamples());
    for (RenderSettings& settings : methods) settings.maxDepth = 8;
    methods[0].roulette.kind = Roulette::off;
    methods[1].roulette = {.kind = Roulette::constant, .termination = 0.3, .start = 0};
    methods[2].roulette = {.kind = Roulette::constant, .termination = 0.7, .start = 2};
    methods[3].roulette.start = 1;
    expectSameMean(roomWithEveryLight(), methods, 0.02);
}

TEST(ReferenceLightSampling, ConstantRouletteEndsAsOftenAsItSays) {
    // White walls all around: nothing but roulette ends a path, after 1/P scatterings on average.
    SceneBuilder builder;
    builder.scene.spheres.push_back({"", Vec3d(0.0), 1.0, 0});
    builder.camera({0.1, 0.2, 0.3}, Vec3d(0.0), 1.0);
    RenderSettings settings = smallSettings(64);
    for (const double termination : {0.1, 0.5}) {
        settings.roulette = {.kind = Roulette::constant, .termination = termination, .start = 0};
        const double paths = 64.0 * 24.0 * 17.0;
        const double rays = static_cast<double>(render(builder.scene, settings).rays) / paths;
        const double deviation = std::sqrt(1.0 - termination) / termination; // of a geometric distribution
        EXPECT_NEAR(rays, 1.0 / termination, 4.5 * deviation / std::sqrt(paths)) << "one false alarm in 1e5";
    }
}

TEST(ReferenceLightSampling, PunctualLightsAreSeenInEveryWay) {
    SceneBuilder builder;
    builder.mesh(squareMesh(0), scaling({4.0, 4.0, 1.0}));
    builder.scene.punctualLights.emplace_back();
    builder.scene.punctualLights[0].position = {0.0, 0.0, 2.0};
    builder.camera({0.5, -6.0, 2.5}, Vec3d(0.0), 0.6);
    RenderSettings settings = smallSettings(2);
    settings.maxDepth = 1;
    const Film expected = render(builder.scene, settings);
    EXPECT_GT(expected.at(12, 8).mean.x, 0.0);
    for (const LightSampling sampling : {LightSampling::hemisphere, LightSampling::bsdf, LightSampling::light}) {
        settings.lightSampling = sampling;
        EXPECT_EQ(render(builder.scene, settings).pixels, expected.pixels);
    }
    settings.lightChoice = LightChoice::all;
    settings.lightSamples = 5; // of each light that has an extent
    const Film all = render(builder.scene, settings);
    EXPECT_EQ(all.pixels, expected.pixels);
    EXPECT_EQ(all.rays, expected.rays);
}

/// A floor whose origin alone is seen, under two triangles that emit and a sphere.
Scene underThreeLights() {
    SceneBuilder builder;
    builder.mesh(squareMesh(0), scaling({100.0, 100.0, 1.0}));
    const std::uint32_t lamp = builder.material(Vec3d(0.5), Vec3d(2.0, 3.0, 4.0), Faces::front);
    builder.mesh(squareMesh(lamp), translation({0.5, 0.0, 2.0}) * scaling({0.7, -0.7, -1.0}));
    builder.scene.spheres.push_back({"", {-2.0, 0.0, 2.0}, 0.3, lamp});
    builder.camera({3.0, 0.5, 1.0}, Vec3d(0.1, -0.1, 0.0), 1e-9);
    return builder.scene;
}

/// The radiance of one sample by light sampling alone, from the written numbers of the blocks.
Vec3d radianceByHand(const Scene& scene, const RenderSettings& settings) {
    const World<double> world = flatten<double>(scene);
    const CameraRays<double> rays(scene.cameras[0], settings);
    const Lights<double> lights(scene, world, settings);
    const RayCaster<double> caster(world);
    const Ray<double> ray = rays.sample(1, 2, randomBlock(settings.seed, 1, 2, 0, 0));
    const auto hit = caster.nearest(ray);
    if (!hit) return Vec3d(0.0);
    const Surface<double> surface = surfaceAt(world, ray, *hit);
    Vec3d sum(0.0);
    for (std::uint32_t c = 0; c < lights.sampleCount(); ++c) {
        const std::uint32_t block = c == 0 ? 1 : 0x80000000u + c;
        const auto light = lights.sample(surface, randomBlock(settings.seed, 1, 2, 0, block), c);
        if (!light || caster.visibility(light->shadowRay, light->primitive) == Visibility::blocked) continue;
        sum += light->emission * (glm::dot(light->wi, surface.ns) / kPi / light->pdf);
    }
    return sum;
}

TEST(ReferenceLightSampling, SamplesDrawTheWrittenBlocks) {
    RenderSettings settings = smallSettings(1);
    settings.maxDepth = 1;
    settings.lightSampling = LightSampling::light;
    for (const LightChoice choice : {LightChoice::one, LightChoice::all})
        for (const std::uint32_t count : {1u, 2u, 5u}) {
            settings.lightChoice = choice;
            settings.lightSamples = count;
            const Film film = render(underThreeLights(), settings);
            const std::uint32_t each = choice == LightChoice::one ? count : 3 * count;
            EXPECT_EQ(film.rays, (2u + each) * film.pixels.size()) << "camera, shadows, and the scattered ray";
            const Vec3d expected = radianceByHand(underThreeLights(), settings);
            EXPECT_GT(expected.x, 0.0);
            // The same factors in another order: some ten roundings a term, and the sum of up to 15.
            EXPECT_NEAR(glm::length(film.at(1, 2).mean / expected - 1.0), 0.0, 2.0 * roundingBound<double>(30));
        }
}

TEST(ReferenceLightSampling, DensitiesCountTheSamplesOfALight) {
    const Scene scene = underThreeLights();
    const World<double> world = flatten<double>(scene);
    Surface<double> receiver{};
    const PhiloxBlock words{0x12345678u, 0x9ABCDEF0u, 0x40000000u, 0x80000000u};
    const auto pdfOf = [&](LightChoice choice, std::uint32_t samples, std::uint32_t index) {
        RenderSettings settings;
        settings.lightChoice = choice;
        settings.lightSamples = samples;
        return Lights<double>(scene, world, settings).sample(receiver, words, index)->pdf;
    };
    const double one = pdfOf(LightChoice::one, 1, 0);
    EXPECT_DOUBLE_EQ(pdfOf(LightChoice::one, 4, 3), 4.0 * one);
    for (std::uint32_t light = 0; light < 3; ++light) {
        const double alone = pdfOf(LightChoice::all, 1, light);
        EXPECT_DOUBLE_EQ(pdfOf(LightChoice::all, 4, 4 * light), 4.0 * alone);
        EXPECT_DOUBLE_EQ(pdfOf(LightChoice::all, 4, 4 * light + 3), 4.0 * alone);
    }
}

TEST(ReferenceLightSampling, EveryHeuristicIsOneWhereNothingElseFindsTheLight) {
    // Emitters seen by the camera alone count in full in every way.
    RenderSettings settings = smallSettings(4);
    settings.maxDepth = 0;
    const Film expected = render(smallRoom(), settings);
    for (const LightSampling sampling : {LightSampling::hemisphere, LightSampling::bsdf, LightSampling::light}) {
        settings.lightSampling = sampling;
        EXPECT_EQ(render(smallRoom(), settings).pixels, expected.pixels);
    }
}

} // namespace
} // namespace isolux
