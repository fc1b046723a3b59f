#include "scene/alias_table.h"

#include "scene/lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace isolux {
namespace {

std::uint32_t word(std::mt19937& random) { return static_cast<std::uint32_t>(random()); }

/// The probabilities that the bins really encode, from their integers.
std::vector<double> encodedProbabilities(const AliasTable& table, std::size_t count) {
    std::vector<long double> shares(count, 0.0L);
    for (std::uint32_t bin = 0; bin < table.bins.size(); ++bin) {
        const auto [threshold, alias] = table.bins[bin];
        const long double own = alias == bin ? 4294967296.0L : threshold;
        if (own > 0) shares[bin] += own;
        if (alias != bin) shares[alias] += 4294967296.0L - own;
    }
    std::vector<double> result;
    for (const long double share : shares)
        result.push_back(static_cast<double>(share / 4294967296.0L / table.bins.size()));
    return result;
}

void expectExact(const std::vector<double>& weights) {
    const AliasTable table = buildAliasTable(weights);
    const std::vector<double> encoded = encodedProbabilities(table, weights.size());
    ASSERT_EQ(table.pdf.size(), weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        EXPECT_EQ(encoded[i], table.pdf[i]) << i;
        EXPECT_EQ(table.pdf[i] > 0.0, weights[i] > 0.0) << i;
    }
    EXPECT_NEAR(std::accumulate(table.pdf.begin(), table.pdf.end(), 0.0), 1.0, 1e-12);
}

TEST(AliasTable, StoredPdfIsExactlyWhatTheBinsEncode) {
    expectExact({1.0});
    expectExact({1.0, 3.0});
    expectExact({0.0, 1.0, 0.0, 2.5, 0.1});
    expectExact({1e-30, 1.0, 1e30});
    expectExact({1e300, 1e300, 1e300});
    std::mt19937 random(1);
    std::vector<double> weights(10'000);
    for (double& weight : weights) weight = std::pow(10.0, std::uniform_real_distribution(-20.0, 0.0)(random));
    expectExact(weights);
}

TEST(AliasTable, ProbabilitiesFollowTheWeights) {
    const std::vector<double> weights{1.0, 2.0, 3.0, 4.0, 0.0};
    const AliasTable table = buildAliasTable(weights);
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(table.pdf[i], weights[i] / 10.0, 1e-9);
}

TEST(AliasTable, OneHotAmongAMillion) {
    std::vector<double> weights(1'000'000, 0.0);
    weights[123'456] = 1.0;
    const AliasTable table = buildAliasTable(weights);
    std::mt19937 random(2);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(sampleAliasTable(table, word(random), word(random)), 123'456u);
    EXPECT_EQ(sampleAliasTable(table, 0xffffffffu, 0xffffffffu), 123'456u);
    EXPECT_EQ(sampleAliasTable(table, 0, 0), 123'456u);
}

TEST(AliasTable, SampledFrequenciesMatch) {
    const std::vector<double> weights{5.0, 1.0, 0.0, 3.0, 1.0, 6.0};
    const AliasTable table = buildAliasTable(weights);
    constexpr int kSamples = 1'000'000;
    std::vector<int> counts(weights.size(), 0);
    std::mt19937 random(3);
    for (int i = 0; i < kSamples; ++i) ++counts[sampleAliasTable(table, word(random), word(random))];
    double chiSquare = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double expected = kSamples * weights[i] / 16.0;
        if (expected == 0.0)
            EXPECT_EQ(counts[i], 0);
        else
            chiSquare += (counts[i] - expected) * (counts[i] - expected) / expected;
    }
    EXPECT_LT(chiSquare, 18.47); // 4 degrees of freedom, p = 0.001
}

TEST(AliasTable, NothingToChoose) {
    EXPECT_TRUE(buildAliasTable({}).bins.empty());
    EXPECT_TRUE(buildAliasTable(std::vector<double>{0.0, 0.0}).bins.empty());
}

TEST(LightTable, ChoosesByPowerAndSkipsWhatHasNoArea) {
    Scene scene;
    scene.materials = {{"wall", Vec3d(0.5), Vec3d(0.0), false},
                       {"lamp", Vec3d(0.0), Vec3d(2.0), false},
                       {"panel", Vec3d(0.0), Vec3d(2.0), true}};
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}}; // the second has no area
    for (std::uint32_t material = 0; material < 3; ++material) {
        mesh.material = material;
        scene.meshes.push_back(mesh);
        scene.instances.push_back({"", material, Mat4d(1.0)});
    }
    scene.spheres.push_back({"bulb", Vec3d(0.0), 1.0, 1});
    const LightTable lights = buildLightTable(scene);
    EXPECT_EQ(lights.lights, (std::vector<Light>{{LightKind::area, 2}, {LightKind::area, 4}, {LightKind::area, 6}}));
    EXPECT_EQ(lights.lightOf, (std::vector<std::uint32_t>{kNoLight, kNoLight, 0, kNoLight, 1, kNoLight, 2}));
    const double total = 0.5 + 1.0 + 4.0 * kPi; // areas, the panel's counted twice
    EXPECT_NEAR(lights.choice.pdf[0], 0.5 / total, 1e-9);
    EXPECT_NEAR(lights.choice.pdf[1], 1.0 / total, 1e-9);
    EXPECT_NEAR(lights.choice.pdf[2], 4.0 * kPi / total, 1e-9);
}

PunctualLight punctual(PunctualKind kind, const Vec3d& intensity) {
    PunctualLight light;
    light.kind = kind;
    light.intensity = intensity;
    light.cosInner = 0.9;
    light.cosOuter = 0.6;
    return light;
}

/// An unlit ball of radius 1: its box has the half diagonal sqrt(3), so a disc of area 3 pi stands for the scene.
Scene ballScene() {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].emission = Vec3d(0.5);
    scene.spheres.push_back({"ball", Vec3d(2.0), 1.0, 0});
    return scene;
}

TEST(LightTable, KnowsThePowerOfEveryKind) {
    Scene scene = ballScene();
    scene.spheres.push_back({"lamp", Vec3d(2.0), 0.5, 1}); // in the ball's box
    scene.punctualLights = {punctual(PunctualKind::spot, Vec3d(2.0)), punctual(PunctualKind::point, {1.0, 0.0, 0.0}),
                            punctual(PunctualKind::directional, Vec3d(3.0))};
    scene.environment = {Vec3d(0.0, 1.0, 0.0), EnvironmentExtent::upperHalf};
    const LightTable lights = buildLightTable(scene);
    EXPECT_EQ(lights.lights, (std::vector<Light>{{LightKind::area, 1},
                                                 {LightKind::punctual, 0},
                                                 {LightKind::punctual, 1},
                                                 {LightKind::punctual, 2},
                                                 {LightKind::environment, 0}}));
    EXPECT_EQ(lights.lightOf, (std::vector<std::uint32_t>{kNoLight, 0}));
    EXPECT_EQ(lights.environment, 4u);
    // All over pi. Lamp: radiance times area. Spot: 2 I (0.1 in full + 0.3 between, of which the mean of t^2 is 1/3).
    // Point: 4 I, red alone. Directional: E times 3. Environment: 2 pi times 3, green alone.
    const std::vector<double> powers = {0.5 * kPi, 2.0 * 2.0 * 0.2, 4.0 * 0.2126, 9.0, 6.0 * kPi * 0.7152};
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    for (std::size_t i = 0; i < powers.size(); ++i) EXPECT_NEAR(lights.choice.pdf[i], powers[i] / total, 1e-9) << i;
    scene.environment.extent = EnvironmentExtent::sphere;
    const double doubled = total + powers[4];
    EXPECT_NEAR(buildLightTable(scene).choice.pdf[4], 2.0 * powers[4] / doubled, 1e-9);
}

TEST(LightTable, LeavesOutWhatSendsNothing) {
    Scene scene = ballScene();
    scene.punctualLights = {punctual(PunctualKind::point, Vec3d(0.0)), punctual(PunctualKind::spot, Vec3d(1.0)),
                            punctual(PunctualKind::directional, Vec3d(0.0))};
    const LightTable lights = buildLightTable(scene);
    EXPECT_EQ(lights.lights, (std::vector<Light>{{LightKind::punctual, 1}}));
    EXPECT_EQ(lights.environment, kNoLight);
    EXPECT_EQ(lights.choice.pdf, std::vector<double>{1.0});
    scene.punctualLights.clear();
    EXPECT_TRUE(buildLightTable(scene).lights.empty());
    EXPECT_TRUE(buildLightTable(scene).choice.bins.empty());
}

TEST(LightTable, LightsFromAfarNeedSomethingToShineOn) {
    Scene scene;
    scene.punctualLights = {punctual(PunctualKind::directional, Vec3d(1.0))};
    scene.environment.radiance = Vec3d(1.0);
    const LightTable lights = buildLightTable(scene);
    EXPECT_TRUE(lights.lights.empty());
    EXPECT_EQ(lights.environment, kNoLight);
    scene.punctualLights.push_back(punctual(PunctualKind::point, Vec3d(1.0)));
    EXPECT_EQ(buildLightTable(scene).lights, (std::vector<Light>{{LightKind::punctual, 1}}));
}

} // namespace
} // namespace isolux
