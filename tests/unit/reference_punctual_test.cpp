// Lights without extent have no noise: what they send to a Lambertian floor is known to the last digits.
#include "reference/punctual_lights.h"
#include "reference/reference.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

const Vec3d kAlbedo(0.25, 0.5, 0.75);
const Vec3d kIntensity(3.0, 2.0, 7.0);

PunctualLight pointLight(const Vec3d& position) {
    PunctualLight light;
    light.position = position;
    light.intensity = kIntensity;
    return light;
}

PunctualLight spotLight(const Vec3d& position, const Vec3d& target, double innerDegrees, double outerDegrees) {
    PunctualLight light = pointLight(position);
    light.kind = PunctualKind::spot;
    light.direction = glm::normalize(target - position);
    light.cosInner = std::cos(innerDegrees * kPi / 180.0);
    light.cosOuter = std::cos(outerDegrees * kPi / 180.0);
    return light;
}

PunctualLight directionalLight(const Vec3d& direction) {
    PunctualLight light;
    light.kind = PunctualKind::directional;
    light.direction = glm::normalize(direction);
    light.intensity = kIntensity;
    return light;
}

/// A floor at z = 0 and a camera that sees nothing of it but the point at the origin, on its second triangle.
constexpr double kFieldOfView = 1e-14;
SceneBuilder floorUnder(const std::vector<PunctualLight>& lights) {
    SceneBuilder builder;
    builder.scene.materials[0].baseColor = kAlbedo;
    builder.mesh(squareMesh(0), translation({0.3, 0.0, 0.0}));
    builder.scene.punctualLights = lights;
    builder.camera({1.0, -2.0, 2.0}, Vec3d(0.0), kFieldOfView);
    return builder;
}

RenderSettings fewSamples() {
    RenderSettings settings;
    settings.width = settings.height = 2;
    settings.sampleCount = 3;
    settings.maxDepth = 1;
    return settings;
}

PixelStatistics renderPixel(const Scene& scene, Precision precision = Precision::doublePrecision) {
    const ReferenceOptions options{.precision = precision, .signatures = PathSignatures::on};
    const Film film = renderReference(scene, fewSamples(), options, {});
    EXPECT_TRUE(film.diagnostics.clean());
    return film.at(1, 0);
}

void expectNear(const Vec3d& actual, const Vec3d& expected, double relative) {
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(actual[channel], expected[channel], relative * expected[channel]) << "channel " << channel;
}

/// The camera is 3 away and the triangle is 3 long, so that the point seen is off by less than 3 (field of view +
/// gamma(13)), once more where rays leave from. The light is at z >= 2, where the gradient of cos / d^2 = z / d^3 is
/// less than four times its value; the rest is fewer than 40 roundings.
template <typename Real> double tolerance() {
    const double displaced = 3.0 * (kFieldOfView + 2.0 * roundingBound<Real>(13));
    return 4.0 * displaced + roundingBound<Real>(40);
}

void expectRadiance(const PunctualLight& light, const Vec3d& expected) {
    const Scene scene = floorUnder({light}).scene;
    expectNear(renderPixel(scene).mean, expected, tolerance<double>());
    expectNear(renderPixel(scene, Precision::singlePrecision).mean, expected, tolerance<float>());
}

TEST(ReferencePunctual, TheToleranceIsThePromisedOne) { EXPECT_LT(tolerance<double>(), 1e-12); }

TEST(ReferencePunctual, APointLightFallsOffWithTheSquareAndTheCosine) {
    expectRadiance(pointLight({0, 0, 2}), kAlbedo / kPi * kIntensity / 4.0);
    expectRadiance(pointLight({3, 0, 4}), kAlbedo / kPi * kIntensity * 0.8 / 25.0);
    expectRadiance(pointLight({-6, 3, 2}), kAlbedo / kPi * kIntensity * (2.0 / 7.0) / 49.0);
}

TEST(ReferencePunctual, ADirectionalLightDoesNotFallOff) {
    expectRadiance(directionalLight({0, 0, -1}), kAlbedo / kPi * kIntensity);
    expectRadiance(directionalLight({3, 0, -4}), kAlbedo / kPi * kIntensity * 0.8);
}

TEST(ReferencePunctual, ASpotShinesInItsConesAlone) {
    // Seen from the light at (0, 3, 4), the origin is at the angle off the axis by which the axis is turned.
    const Vec3d full = kAlbedo / kPi * kIntensity * 0.8 / 25.0;
    const auto turned = [](double degrees) {
        const double angle = degrees * kPi / 180.0;
        const Vec3d axis = glm::normalize(Vec3d(0, -3, -4)), aside(1, 0, 0);
        const Vec3d position(0, 3, 4);
        return spotLight(position, position + axis * std::cos(angle) + aside * std::sin(angle), 20.0, 40.0);
    };
    expectRadiance(turned(0.0), full);
    expectRadiance(turned(19.0), full);
    for (const double degrees : {25.0, 30.0, 35.0}) {
        const auto cosine = [](double of) { return std::cos(of * kPi / 180.0); };
        const double t = (cosine(degrees) - cosine(40.0)) / (cosine(20.0) - cosine(40.0));
        const Scene scene = floorUnder({turned(degrees)}).scene;
        // t is a difference of cosines, divided by another of 0.17; an error of it counts twice in t^2, relative to t.
        const double loss = 2.0 * (1.0 / 0.17) / t;
        expectNear(renderPixel(scene).mean, full * (t * t), loss * tolerance<double>());
        expectNear(renderPixel(scene, Precision::singlePrecision).mean, full * (t * t), loss * tolerance<float>());
    }
    for (const double degrees : {41.0, 90.0, 180.0}) expectRadiance(turned(degrees), Vec3d(0.0));
}

TEST(ReferencePunctual, LightFromBelowAndBehindBlockersDoesNotArrive) {
    expectRadiance(pointLight({0, 0, -2}), Vec3d(0.0));
    expectRadiance(directionalLight({0, 0, 1}), Vec3d(0.0));
    for (const PunctualLight& light : {pointLight({0, 0, 2}), directionalLight({0, 0, -1})}) {
        SceneBuilder builder = floorUnder({light});
        builder.mesh(squareMesh(0), translation({0, 0, 1.9}));
        EXPECT_EQ(renderPixel(builder.scene).mean, Vec3d(0.0));
    }
}

TEST(ReferencePunctual, ShadowRaysEndAtAPointLightAndNowhereElse) {
    const auto withRoof = [](const PunctualLight& light) {
        SceneBuilder builder = floorUnder({light});
        builder.mesh(squareMesh(0), translation({0, 0, 2.0001}));
        return renderPixel(builder.scene).mean;
    };
    expectNear(withRoof(pointLight({0, 0, 2})), kAlbedo / kPi * kIntensity / 4.0, tolerance<double>());
    expectNear(withRoof(spotLight({0, 0, 2}, {0, 0, 0}, 10, 20)), kAlbedo / kPi * kIntensity / 4.0,
               tolerance<double>());
    EXPECT_EQ(withRoof(directionalLight({0, 0, -1})), Vec3d(0.0));
}

TEST(ReferencePunctual, SignaturesTellReachedBlockedAndNoRay) {
    const auto hash = [](std::initializer_list<std::uint32_t> words) {
        std::uint32_t h = 2166136261u;
        for (const std::uint32_t word : words) h = (h ^ word) * 16777619u;
        return h;
    };
    const std::uint32_t samples = fewSamples().sampleCount;
    const auto expectWord = [&](const Scene& scene, std::uint32_t word) {
        EXPECT_EQ(renderPixel(scene).pathSignature, samples * hash({1, word, kNoPrimitive})) << word;
    };
    expectWord(floorUnder({pointLight({0, 0, 2})}).scene, 1);
    expectWord(floorUnder({pointLight({0, 0, -2})}).scene, 2);
    expectWord(floorUnder({spotLight({0, 0, 2}, {0, 9, 2}, 10, 20)}).scene, 2);
    expectWord(floorUnder({directionalLight({0, 0, -1})}).scene, 1);
    // Small, so that no scattered ray meets it.
    SceneBuilder builder = floorUnder({pointLight({0, 0, 2})});
    builder.mesh(triangleMesh({-0.01f, -0.01f, 1.9f}, {0.01f, -0.01f, 1.9f}, {0, 0.01f, 1.9f}));
    expectWord(builder.scene, 0);
}

TEST(ReferencePunctual, DepthZeroAndDarkLightsLeaveTheFloorBlack) {
    Scene scene = floorUnder({pointLight({0, 0, 2})}).scene;
    RenderSettings settings = fewSamples();
    settings.maxDepth = 0;
    EXPECT_EQ(renderReference(scene, settings, {}, {}).at(0, 0).mean, Vec3d(0.0));
    scene.punctualLights[0].intensity = Vec3d(0.0);
    const Film film = renderReference(scene, fewSamples(), {}, {});
    EXPECT_EQ(film.at(0, 0).mean, Vec3d(0.0));
    EXPECT_EQ(film.rays, 2u * 12u) << "camera and scattered rays, no shadow rays";
}

template <typename Real> class PunctualSample : public ::testing::Test {};
TYPED_TEST_SUITE(PunctualSample, RealTypes);

TYPED_TEST(PunctualSample, IsOneDirectionToTheLightsPosition) {
    using Real = TypeParam;
    const Vec3<Real> origin(1, 2, 3);
    const auto sample = samplePunctualLight(pointLight({4, 2, 7}), origin);
    ASSERT_TRUE(sample);
    const Real epsilon = std::numeric_limits<Real>::epsilon();
    EXPECT_NEAR(glm::length(sample->wi - Vec3<Real>(Real(0.6), 0, Real(0.8))), 0, 4 * epsilon);
    EXPECT_EQ(sample->pdf, 1);
    EXPECT_EQ(sample->measure, Measure::discrete);
    EXPECT_EQ(sample->primitive, kNoPrimitive);
    EXPECT_EQ(sample->shadowRay.origin, origin);
    EXPECT_EQ(sample->shadowRay.direction, sample->wi);
    // Short of the light by 64 roundings of the largest coordinates, 7 and 3.
    EXPECT_NEAR(sample->shadowRay.tMax, 5 - 32 * epsilon * (7 + 3), 16 * epsilon);
    EXPECT_NEAR(glm::length(Vec3d(sample->emission) - kIntensity / 25.0), 0.0, 10.0 * epsilon);
    EXPECT_FALSE(samplePunctualLight(pointLight({1, 2, 3}), origin)) << "no direction leads to the point itself";
}

TYPED_TEST(PunctualSample, OfADirectionalLightComesFromInfinitelyFar) {
    using Real = TypeParam;
    const auto sample = samplePunctualLight(directionalLight({0, -2, 0}), Vec3<Real>(5, 6, 7));
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->wi, Vec3<Real>(0, 1, 0));
    EXPECT_EQ(sample->emission, Vec3<Real>(kIntensity));
    EXPECT_EQ(sample->shadowRay.tMax, std::numeric_limits<Real>::infinity());
    EXPECT_EQ(sample->measure, Measure::discrete);
}

TYPED_TEST(PunctualSample, OfAPencilThinSpotIsDarkOrNone) {
    using Real = TypeParam;
    PunctualLight light = spotLight({0, 0, 2}, {0, 0, 0}, 0.0, 1e-4);
    EXPECT_FALSE(samplePunctualLight(light, Vec3<Real>(Real(0.1), 0, 0)));
    // Float cannot tell its cones apart: then there is no light, but nothing that is not a number either.
    const auto sample = samplePunctualLight(light, Vec3<Real>(0));
    EXPECT_EQ(sample.has_value(), (std::is_same_v<Real, double>));
}

} // namespace
} // namespace isolux
