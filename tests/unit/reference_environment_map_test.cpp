// Environment maps of the CPU reference: where texels lie, what is between them, and how directions are sampled.
#include "reference/environment_map.h"
#include "reference/lights.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

template <typename Real> class ReferenceEnvironmentMap : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceEnvironmentMap, RealTypes);

Environment mapped(std::uint32_t width, std::uint32_t height, std::vector<Vec3f> texels) {
    Environment environment;
    environment.radiance = Vec3d(1.0);
    environment.map = std::make_shared<EnvironmentMap>(EnvironmentMap{"map", width, height, std::move(texels)});
    return environment;
}

/// Black but for a texel.
Environment oneTexel(std::uint32_t width, std::uint32_t height, std::uint32_t column, std::uint32_t row) {
    std::vector<Vec3f> texels(std::size_t{width} * height, Vec3f(0.0f));
    texels[std::size_t{row} * width + column] = Vec3f(1.0f, 2.0f, 4.0f);
    return mapped(width, height, std::move(texels));
}

Environment randomMap(std::uint32_t width, std::uint32_t height) {
    Random random(6);
    std::vector<Vec3f> texels;
    for (std::uint32_t i = 0; i < width * height; ++i)
        texels.push_back(Vec3f(Vec3d(random.unit(), random.unit(), std::pow(random.unit(), 8.0) * 30.0)));
    return mapped(width, height, std::move(texels));
}

TYPED_TEST(ReferenceEnvironmentMap, TexelsLieWhereTheConventionsSay) {
    using Real = TypeParam;
    const auto at = [](const Environment& environment, const Vec3d& direction) {
        return MappedEnvironment<Real>(environment).radiance(Vec3<Real>(glm::normalize(direction))).x;
    };
    // Four columns: behind to the left (-x+z), in front to the left, in front to the right, behind to the right.
    EXPECT_NEAR(at(oneTexel(4, 1, 2, 0), {1, 0, -1}), 1, 1e-6);
    EXPECT_NEAR(at(oneTexel(4, 1, 1, 0), {-1, 0, -1}), 1, 1e-6);
    EXPECT_NEAR(at(oneTexel(4, 1, 0, 0), {-1, 0, 1}), 1, 1e-6);
    EXPECT_NEAR(at(oneTexel(4, 1, 3, 0), {1, 0, 1}), 1, 1e-6);
    // The middle of a row is -z: half-way between two columns.
    EXPECT_NEAR(at(oneTexel(4, 1, 1, 0), {0, 0, -1}), 0.5, 1e-6);
    EXPECT_NEAR(at(oneTexel(4, 1, 2, 0), {0, 0, -1}), 0.5, 1e-6);
    EXPECT_NEAR(at(oneTexel(4, 1, 3, 0), {0, 0, 1}), 0.5, 1e-6) << "columns are wrapped";
    // Row 0 is +y.
    EXPECT_NEAR(at(oneTexel(1, 4, 0, 0), {0, 1, 0}), 1, 1e-6);
    EXPECT_NEAR(at(oneTexel(1, 4, 0, 3), {0, -1, 0}), 1, 1e-6);
    EXPECT_NEAR(at(oneTexel(1, 4, 0, 1), {1, 0, 0}), 0.5, 1e-6);
    EXPECT_NEAR(at(oneTexel(1, 4, 0, 0), {0, std::cos(kPi / 4), std::sin(kPi / 4)}), 0.5, 1e-6);
}

TYPED_TEST(ReferenceEnvironmentMap, RotationTurnsItCounterClockwiseSeenFromAbove) {
    using Real = TypeParam;
    Environment environment = oneTexel(8, 1, 4, 0); // its centre is 22.5 degrees to the right of -z
    environment.rotation = 1.0 / 16 + 1.0 / 4;      // to -z, and on to -x
    const MappedEnvironment<Real> map(environment);
    EXPECT_NEAR(map.radiance({-1, 0, 0}).x, 1, 1e-5);
    for (const double turns : {-3.0, 2.0, 1000.0}) {
        environment.rotation = turns + 5.0 / 16;
        EXPECT_NEAR(MappedEnvironment<Real>(environment).radiance({-1, 0, 0}).x, 1, 1e-3) << turns;
    }
}

TYPED_TEST(ReferenceEnvironmentMap, RadianceIsScaledByTheFactor) {
    Environment environment = oneTexel(1, 1, 0, 0);
    environment.radiance = {2.0, 3.0, 0.5};
    const auto radiance = MappedEnvironment<TypeParam>(environment).radiance({0, 0, -1});
    EXPECT_EQ(radiance, Vec3<TypeParam>(2, 6, 2));
}

PhiloxBlock randomWords(Random& random) {
    PhiloxBlock words{};
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random.index(1ull << 32));
    return words;
}

TYPED_TEST(ReferenceEnvironmentMap, DensityOfASampleIsThatOfItsDirection) {
    using Real = TypeParam;
    Environment environment = randomMap(12, 7);
    environment.rotation = 0.3;
    const MappedEnvironment<Real> map(environment);
    Random random(2);
    int other = 0;
    for (int i = 0; i < 20000; ++i) {
        const LightSample<Real> sample = map.sample(Vec3<Real>(0), randomWords(random));
        ASSERT_NEAR(glm::length(sample.wi), 1, 1e-6);
        ASSERT_EQ(sample.emission, map.radiance(sample.wi));
        // Rounding may take a direction at a cell's edge to the neighbour.
        if (std::abs(map.pdf(sample.wi) / sample.pdf - 1) > 1e-6) ++other;
    }
    EXPECT_LE(other, sizeof(Real) == 4 ? 5 : 0);
}

TYPED_TEST(ReferenceEnvironmentMap, DensityIntegratesToOneAndSamplesEstimateTheFlux) {
    using Real = TypeParam;
    Environment environment = randomMap(16, 8);
    environment.rotation = 0.125;
    const MappedEnvironment<Real> map(environment);
    // Uniform directions through the grid's midpoints, whose cells fill the map's exactly in azimuth.
    double total = 0.0, flux = 0.0;
    constexpr int kGrid = 1024;
    for (int row = 0; row < kGrid; ++row) {
        const double theta = kPi * (row + 0.5) / kGrid;
        const double ring = 2 * kPi * kPi / kGrid * std::sin(theta) / 64;
        for (int column = 0; column < 64; ++column) {
            const double phi = 2 * kPi * (column + 0.5) / 64;
            const Vec3<Real> direction(
                Vec3d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
            total += static_cast<double>(map.pdf(direction)) * ring;
            flux += luminance(Vec3d(map.radiance(direction))) * ring;
        }
    }
    EXPECT_NEAR(total, 1.0, 1e-5);
    Random random(3);
    double sum = 0.0, squares = 0.0;
    constexpr int kSamples = 40000;
    for (int i = 0; i < kSamples; ++i) {
        const LightSample<Real> sample = map.sample(Vec3<Real>(0), randomWords(random));
        const double value = luminance(Vec3d(sample.emission)) / static_cast<double>(sample.pdf);
        sum += value / kSamples;
        squares += value * value / kSamples;
    }
    const double error = std::sqrt((squares - sum * sum) / kSamples);
    EXPECT_NEAR(sum, flux, 4.5 * error);
    EXPECT_LT(error, 0.01 * flux);
    EXPECT_NEAR(buildEnvironmentTable(*environment.map).flux / flux, 1.0, 1e-3);
}

TYPED_TEST(ReferenceEnvironmentMap, LightSamplingChoosesItByItsOwnWords) {
    using Real = TypeParam;
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    builder.scene.environment = randomMap(8, 4);
    builder.scene.environment.radiance = Vec3d(0.5);
    const World<Real> world = flatten<Real>(builder.scene);
    RenderSettings settings;
    settings.lightSamples = 3;
    const Lights<Real> lights(builder.scene, world, settings);
    ASSERT_TRUE(lights.hasMap());
    const MappedEnvironment<Real> map(builder.scene.environment);
    Random random(8);
    for (int i = 0; i < 100; ++i) {
        const PhiloxBlock cellWords = randomWords(random);
        const auto sample = lights.sample({}, randomWords(random), 0, cellWords);
        const LightSample<Real> expected = map.sample(Vec3<Real>(0), cellWords);
        ASSERT_TRUE(sample);
        ASSERT_EQ(sample->wi, expected.wi);
        ASSERT_EQ(sample->pdf, 3 * expected.pdf);
        ASSERT_NEAR(lights.pdfOfEnvironment(sample->wi) / sample->pdf, 1, 1e-5);
    }
}

TYPED_TEST(ReferenceEnvironmentMap, ABlackOneIsNoLight) {
    using Real = TypeParam;
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    builder.scene.environment = mapped(2, 1, {Vec3f(0.0f), Vec3f(0.0f)});
    const World<Real> world = flatten<Real>(builder.scene);
    const Lights<Real> lights(builder.scene, world);
    EXPECT_EQ(lights.sampleCount(), 0u);
    EXPECT_EQ(lights.radianceOfEnvironment({0, 1, 0}), Vec3<Real>(0));
}

} // namespace
} // namespace isolux
