// The environment: its sampling recipes and densities, and where the camera sees it. Radiance that surfaces reflect is
// in tests/statistical.
#include "reference/lights.h"
#include "reference/reference.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

constexpr auto kSphere = EnvironmentExtent::sphere;
constexpr auto kUpperHalf = EnvironmentExtent::upperHalf;

PhiloxBlock lightWords(double u, double v) {
    const auto word = [](double x) { return static_cast<std::uint32_t>(x * 4294967296.0); };
    return {0, 0, word(u), word(v)};
}

template <typename Real> class EnvironmentSample : public ::testing::Test {};
TYPED_TEST_SUITE(EnvironmentSample, RealTypes);

TYPED_TEST(EnvironmentSample, DirectionsFollowTheRecipes) {
    using Real = TypeParam;
    const Real tolerance = 8 * std::numeric_limits<Real>::epsilon();
    const auto expectNear = [&](const Vec3<Real>& a, const Vec3<Real>& b) {
        EXPECT_NEAR(glm::length(a - b), 0, tolerance) << a.x << ' ' << a.y << ' ' << a.z;
    };
    const Real root = std::sqrt(Real(0.75));
    expectNear(sampleSphereAboutY<Real>(0, 0), {0, 1, 0});
    expectNear(sampleSphereAboutY<Real>(Real(0.25), 0), {root, Real(0.5), 0});
    expectNear(sampleSphereAboutY<Real>(Real(0.75), Real(0.25)), {0, Real(-0.5), root});
    expectNear(sampleUpperHalf<Real>(0, 0), {0, 1, 0});
    expectNear(sampleUpperHalf<Real>(Real(0.5), Real(0.5)), {-root, Real(0.5), 0});
    EXPECT_GT(sampleUpperHalf<Real>(unitReal<Real>(0xFFFFFFFFu), 0).y, 0) << "never from the horizon itself";
}

TYPED_TEST(EnvironmentSample, DirectionsAreUnitAndUniform) {
    using Real = TypeParam;
    constexpr int kGrid = 200;
    Vec3d mean(0.0), squares(0.0), upperMean(0.0), upperSquares(0.0);
    forEachGridPoint(kGrid, [&](double u, double v) {
        const Vec3<Real> w = sampleSphereAboutY(static_cast<Real>(u), static_cast<Real>(v));
        const Vec3<Real> up = sampleUpperHalf(static_cast<Real>(u), static_cast<Real>(v));
        ASSERT_NEAR(glm::dot(w, w), 1, 8 * std::numeric_limits<Real>::epsilon());
        ASSERT_NEAR(glm::dot(up, up), 1, 8 * std::numeric_limits<Real>::epsilon());
        mean += Vec3d(w) / double(kGrid * kGrid);
        squares += Vec3d(w * w) / double(kGrid * kGrid);
        upperMean += Vec3d(up) / double(kGrid * kGrid);
        upperSquares += Vec3d(up * up) / double(kGrid * kGrid);
    });
    // Midpoints of 200 cells integrate the square of y, a polynomial of second order in u, to 1/(12 * 200^2) times its
    // second derivative, which is at most 8; float adds some 1e-6.
    const double tolerance = 8.0 / (12.0 * kGrid * kGrid) + 3e-6;
    EXPECT_NEAR(glm::length(mean), 0.0, tolerance);
    EXPECT_NEAR(glm::length(upperMean - Vec3d(0.0, 0.5, 0.0)), 0.0, tolerance);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(squares[axis], 1.0 / 3.0, tolerance);
        EXPECT_NEAR(upperSquares[axis], 1.0 / 3.0, tolerance);
    }
}

/// A sphere that does not emit, a point light and an environment.
Scene litByBoth(EnvironmentExtent extent) {
    SceneBuilder builder;
    builder.scene.spheres.push_back({"", Vec3d(0.0), 1.0, 0});
    builder.scene.punctualLights.emplace_back();
    builder.scene.punctualLights[0].position = {0, 5, 0};
    builder.scene.punctualLights[0].intensity = Vec3d(10.0);
    builder.scene.environment = {Vec3d(1.0, 2.0, 3.0), extent};
    return builder.scene;
}

TYPED_TEST(EnvironmentSample, BothWaysToADirectionAgreeOnItsDensityAndRadiance) {
    using Real = TypeParam;
    for (const EnvironmentExtent extent : {kSphere, kUpperHalf}) {
        const Scene scene = litByBoth(extent);
        const World<Real> world = flatten<Real>(scene);
        const Lights<Real> lights(scene, world);
        ASSERT_TRUE(lights.containsEnvironment());
        Random random(5);
        Surface<Real> receiver{};
        receiver.origin = {0, 2, 0};
        std::map<Measure, int> counts;
        double choice = 0.0;
        for (int i = 0; i < 4000; ++i) {
            PhiloxBlock words = lightWords(random.unit(), random.unit());
            for (std::size_t word = 0; word < 2; ++word)
                words[word] = static_cast<std::uint32_t>(random.index(1ull << 32));
            const auto sample = lights.sample(receiver, words);
            ASSERT_TRUE(sample) << "both lights reach the receiver";
            ++counts[sample->measure];
            if (sample->measure == Measure::discrete) {
                choice = static_cast<double>(sample->pdf);
                continue;
            }
            ASSERT_EQ(sample->pdf, lights.pdfOfEnvironment());
            ASSERT_EQ(sample->emission, environmentRadiance(scene.environment, sample->wi));
            ASSERT_EQ(sample->emission, Vec3<Real>(1, 2, 3));
            ASSERT_EQ(sample->shadowRay.tMax, std::numeric_limits<Real>::infinity());
            ASSERT_EQ(sample->primitive, kNoPrimitive);
            const Real scattering = std::abs(sample->wi.y) / static_cast<Real>(kPi);
            ASSERT_NEAR(powerHeuristic(sample->pdf, scattering) + powerHeuristic(scattering, sample->pdf), 1,
                        8 * std::numeric_limits<Real>::epsilon());
        }
        EXPECT_EQ(counts.size(), 2u);
        // All densities together are one: the point light's choice, and the environment's over its directions.
        EXPECT_NEAR(choice + lights.pdfOfEnvironment() * scene.environment.solidAngle(), 1.0,
                    8.0 * std::numeric_limits<Real>::epsilon());
    }
}

RenderSettings wideSettings() {
    RenderSettings settings;
    settings.width = 24;
    settings.height = 16;
    settings.sampleCount = 5;
    return settings;
}

/// Level, along -z: the upper half of the image shows directions with y > 0.
Camera levelCamera() {
    Camera camera;
    camera.yfov = 1.0;
    return camera;
}

TEST(ReferenceEnvironment, FillsAnImageWithoutSurfaces) {
    Scene scene;
    scene.cameras = {levelCamera()};
    scene.environment.radiance = {1.0, 2.0, 3.0};
    ASSERT_NO_THROW(validate(scene));
    for (const Precision precision : {Precision::singlePrecision, Precision::doublePrecision})
        for (const std::uint32_t depth : {0u, 1u, kUnlimitedDepth}) {
            RenderSettings settings = wideSettings();
            settings.maxDepth = depth;
            const Film film = renderReference(scene, settings, {.precision = precision, .aovs = Aovs::on}, {});
            for (const PixelStatistics& pixel : film.pixels) {
                ASSERT_EQ(pixel.mean, Vec3d(1.0, 2.0, 3.0));
                ASSERT_EQ(pixel.hitCount, 5u);
            }
            for (const PixelAovs& aovs : film.aovs) ASSERT_EQ(aovs, PixelAovs{}) << "nothing was hit";
        }
}

TEST(ReferenceEnvironment, AnUpperHalfEndsAtTheHorizon) {
    Scene scene;
    scene.cameras = {levelCamera()};
    scene.environment = {Vec3d(1.0, 2.0, 3.0), kUpperHalf};
    const Film film = renderReference(scene, wideSettings(), {}, {});
    for (std::uint32_t y = 0; y < film.height; ++y)
        for (std::uint32_t x = 0; x < film.width; ++x) {
            const bool above = y < film.height / 2;
            ASSERT_EQ(film.at(x, y).mean, above ? Vec3d(1.0, 2.0, 3.0) : Vec3d(0.0)) << x << ' ' << y;
            ASSERT_EQ(film.at(x, y).hitCount, above ? 5u : 0u);
        }
}

TEST(ReferenceEnvironment, IsSeenBehindSurfacesAndNotThroughThem) {
    SceneBuilder builder;
    builder.scene.materials[0].baseColor = Vec3d(0.0);
    builder.mesh(squareMesh(0), translation({0, 0, -4}));
    builder.scene.cameras = {levelCamera()};
    builder.scene.environment.radiance = Vec3d(2.0);
    const Film film = renderReference(builder.scene, wideSettings(), {.aovs = Aovs::on}, {});
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const double missed = 5.0 - static_cast<double>(film.aovs[i].hitCount());
        ASSERT_NEAR(film.pixels[i].mean.x, 2.0 * missed / 5.0, 2.0 * roundingBound<double>(15));
        ASSERT_EQ(film.pixels[i].hitCount, 5u);
    }
    EXPECT_EQ(film.at(12, 8).mean, Vec3d(0.0));
    EXPECT_EQ(film.at(0, 0).mean, Vec3d(2.0));
}

TEST(ReferenceEnvironment, IsFoundByScatteringAloneWhereItIsNoLight) {
    // All vertices in one point: a scene without extent, whose disc the environment cannot illuminate.
    SceneBuilder builder;
    builder.mesh(triangleMesh({0, 0, -1}, {0, 0, -1}, {0, 0, -1}));
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.scene.cameras = {levelCamera()};
    ASSERT_NO_THROW(validate(builder.scene));
    const World<double> world = flatten<double>(builder.scene);
    const Lights<double> lights(builder.scene, world);
    EXPECT_EQ(lights.sampleCount(), 0u);
    EXPECT_FALSE(lights.containsEnvironment());
    for (const PixelStatistics& pixel : renderReference(builder.scene, wideSettings(), {}, {}).pixels)
        ASSERT_EQ(pixel.mean, Vec3d(1.0));
}

} // namespace
} // namespace isolux
