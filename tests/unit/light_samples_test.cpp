// Which lights a shading point samples, and how often, under each choice of the settings.
#include "core/error.h"
#include "scene/lights.h"

#include <gtest/gtest.h>

#include <numeric>

namespace isolux {
namespace {

/// Two lamps (spheres 1 and 2), two point lights of positive power between which lies a dark one, an environment.
Scene mixedScene() {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].emission = Vec3d(0.5);
    scene.spheres = {{"ball", Vec3d(0.0), 1.0, 0}, {"lamp", Vec3d(3.0), 0.5, 1}, {"large lamp", Vec3d(-3.0), 1.0, 1}};
    for (const double intensity : {1.0, 0.0, 2.0}) {
        PunctualLight light;
        light.kind = PunctualKind::point;
        light.intensity = Vec3d(intensity);
        scene.punctualLights.push_back(light);
    }
    scene.environment.radiance = Vec3d(0.25);
    return scene;
}

RenderSettings sampling(LightChoice choice, std::uint32_t samples) {
    RenderSettings settings;
    settings.lightChoice = choice;
    settings.lightSamples = samples;
    return settings;
}

double total(const LightTable& table) { return std::accumulate(table.samplesOf.begin(), table.samplesOf.end(), 0.0); }

TEST(LightSamples, OneChoosesByPower) {
    for (const std::uint32_t samples : {1u, 4u}) {
        const LightTable table = buildLightTable(mixedScene(), sampling(LightChoice::one, samples));
        EXPECT_EQ(table.sampleCount, samples);
        ASSERT_EQ(table.samplesOf.size(), 5u);
        for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(table.samplesOf[i], samples * table.choice.pdf[i]) << i;
        EXPECT_NEAR(total(table), samples, 1e-12);
    }
}

TEST(LightSamples, AllVisitEachLightAsOftenAsExpected) {
    for (const std::uint32_t samples : {1u, 3u, 16u}) {
        const LightTable table = buildLightTable(mixedScene(), sampling(LightChoice::all, samples));
        EXPECT_EQ(table.areaCount, 2u);
        EXPECT_EQ(table.punctualCount, 2u);
        EXPECT_EQ(table.environment, 4u);
        EXPECT_EQ(table.sampleCount, 3 * samples + 2);
        EXPECT_EQ(total(table), table.sampleCount);
        std::vector<double> visits(table.lights.size(), 0.0);
        std::uint32_t before = 0;
        for (std::uint32_t i = 0; i < table.sampleCount; ++i) {
            const std::uint32_t light = table.lightOfSample(i);
            ASSERT_LT(light, table.lights.size());
            EXPECT_GE(light, before) << "in the table's order";
            before = light;
            ++visits[light];
        }
        EXPECT_EQ(visits, table.samplesOf);
        EXPECT_EQ(visits, (std::vector<double>{1.0 * samples, 1.0 * samples, 1.0, 1.0, 1.0 * samples}));
    }
}

TEST(LightSamples, AllOfOneKindAlone) {
    Scene lamps = mixedScene();
    lamps.punctualLights.clear();
    lamps.environment.radiance = Vec3d(0.0);
    const LightTable area = buildLightTable(lamps, sampling(LightChoice::all, 2));
    EXPECT_EQ(area.sampleCount, 4u);
    EXPECT_EQ(area.lightOfSample(1), 0u);
    EXPECT_EQ(area.lightOfSample(2), 1u);
    Scene sky = mixedScene();
    sky.punctualLights.clear();
    sky.materials[1].emission = Vec3d(0.0);
    const LightTable environment = buildLightTable(sky, sampling(LightChoice::all, 5));
    EXPECT_EQ(environment.sampleCount, 5u);
    for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(environment.lightOfSample(i), environment.environment);
}

TEST(LightSamples, ScatteringLeavesPunctualLightsAlone) {
    for (const LightSampling strategy : {LightSampling::hemisphere, LightSampling::bsdf})
        for (const LightChoice choice : {LightChoice::one, LightChoice::all}) {
            RenderSettings settings = sampling(choice, 3);
            settings.lightSampling = strategy;
            const LightTable table = buildLightTable(mixedScene(), settings);
            EXPECT_EQ(table.lights, (std::vector<Light>{{LightKind::punctual, 0}, {LightKind::punctual, 2}}));
            EXPECT_EQ(table.lightOf, std::vector<std::uint32_t>(3, kNoLight));
            EXPECT_EQ(table.environment, kNoLight);
            EXPECT_EQ(table.areaCount, 0u);
            EXPECT_EQ(table.sampleCount, choice == LightChoice::one ? 3u : 2u);
            EXPECT_NEAR(table.choice.pdf[1], 2.0 / 3.0, 1e-9);
        }
    RenderSettings light;
    light.lightSampling = LightSampling::light;
    EXPECT_EQ(buildLightTable(mixedScene(), light).lights.size(), 5u);
}

TEST(LightSamples, OnlyWhereLightIsFollowed) {
    for (const Integrator integrator : {Integrator::normals, Integrator::albedo, Integrator::depth, Integrator::ao}) {
        RenderSettings settings;
        settings.integrator = integrator;
        const LightTable table = buildLightTable(mixedScene(), settings);
        EXPECT_TRUE(table.lights.empty());
        EXPECT_EQ(table.sampleCount, 0u);
        EXPECT_EQ(table.lightOf, std::vector<std::uint32_t>(3, kNoLight));
    }
    RenderSettings direct;
    direct.integrator = Integrator::direct;
    EXPECT_EQ(buildLightTable(mixedScene(), direct).lights.size(), 5u);
}

TEST(LightSamples, WithoutALightThereAreNone) {
    Scene scene = mixedScene();
    scene.materials[1].emission = Vec3d(0.0);
    scene.punctualLights.clear();
    scene.environment.radiance = Vec3d(0.0);
    for (const LightChoice choice : {LightChoice::one, LightChoice::all}) {
        const LightTable table = buildLightTable(scene, sampling(choice, 7));
        EXPECT_EQ(table.sampleCount, 0u);
        EXPECT_TRUE(table.samplesOf.empty());
    }
}

TEST(LightSamples, MoreThanCanBeNumberedAreRefused) {
    constexpr std::uint32_t kMost = 0x7FFFFFFFu;
    EXPECT_EQ(buildLightTable(mixedScene(), sampling(LightChoice::one, kMost)).sampleCount, kMost);
    EXPECT_THROW((void)buildLightTable(mixedScene(), sampling(LightChoice::one, kMost + 1)), Error);
    // All: 3 N + 2 with three lights of N samples.
    const std::uint32_t most = (kMost - 2) / 3;
    EXPECT_EQ(buildLightTable(mixedScene(), sampling(LightChoice::all, most)).sampleCount, 3 * most + 2);
    EXPECT_THROW((void)buildLightTable(mixedScene(), sampling(LightChoice::all, most + 1)), Error);
    EXPECT_THROW((void)buildLightTable(mixedScene(), sampling(LightChoice::all, 0xFFFFFFFFu)), Error);
}

} // namespace
} // namespace isolux
