// The sampling recipes of the CPU reference and its light sampling.
#include "reference/lights.h"
#include "reference/scattering.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

template <typename Real> class ReferenceSampling : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceSampling, RealTypes);

TYPED_TEST(ReferenceSampling, FrameIsOrthonormalAndRightHanded) {
    using Real = TypeParam;
    std::vector<Vec3d> normals = {{0, 0, 1},    {0, 0, -1},    {1, 0, 0},         {0, -1, 0},
                                  {0, 1e-5, 1}, {1e-5, 0, -1}, {0.5, 0.5, 0.7071}};
    for (const double z : {-0.38, -0.3800001, -0.3799999, -0.99999999, 0.99999999})
        for (const double phi : {0.0, 1.0, 4.0})
            normals.push_back({std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z});
    Random random(1);
    for (int i = 0; i < 10000; ++i) normals.push_back(random.direction());
    const Real tolerance = 6 * std::numeric_limits<Real>::epsilon();
    for (const Vec3d& direction : normals) {
        const Vec3<Real> n = glm::normalize(Vec3<Real>(direction));
        const Frame<Real> frame = frameAbout(n);
        ASSERT_NEAR(glm::dot(frame.t, frame.t), 1, tolerance) << n.x << ' ' << n.y << ' ' << n.z;
        ASSERT_NEAR(glm::dot(frame.s, frame.s), 1, tolerance);
        ASSERT_NEAR(glm::dot(frame.t, frame.s), 0, tolerance);
        ASSERT_NEAR(glm::dot(frame.t, n), 0, tolerance);
        ASSERT_NEAR(glm::dot(frame.s, n), 0, tolerance);
        ASSERT_NEAR(glm::length(glm::cross(frame.t, frame.s) - n), 0, tolerance);
    }
}

TYPED_TEST(ReferenceSampling, CosineHemisphereHasItsMoments) {
    using Real = TypeParam;
    constexpr int kGrid = 400;
    Vec3d mean(0.0), squares(0.0);
    forEachGridPoint(kGrid, [&](double u, double v) {
        const Vec3<Real> w = sampleCosineHemisphere(static_cast<Real>(u), static_cast<Real>(v));
        ASSERT_NEAR(glm::dot(w, w), 1, 4 * std::numeric_limits<Real>::epsilon());
        ASSERT_GE(w.z, 0);
        mean += Vec3d(w) / double(kGrid * kGrid);
        squares += Vec3d(w * w) / double(kGrid * kGrid);
    });
    EXPECT_NEAR(mean.z, 2.0 / 3.0, 1e-4);
    EXPECT_NEAR(squares.z, 0.5, 1e-4);
    EXPECT_NEAR(mean.x, 0.0, 1e-6);
    EXPECT_NEAR(mean.y, 0.0, 1e-6);
    EXPECT_NEAR(squares.x, 0.25, 1e-4);
}

TYPED_TEST(ReferenceSampling, ConcentricMapFollowsTheWrittenCases) {
    using Real = TypeParam;
    const auto expectNear = [](const Vec3<Real>& a, const Vec3d& b) {
        EXPECT_NEAR(glm::length(Vec3d(a) - b), 0.0, 1e-6);
    };
    expectNear(sampleCosineHemisphere<Real>(Real(0.5), Real(0.5)), {0, 0, 1});
    expectNear(sampleCosineHemisphere<Real>(Real(0.75), Real(0.5)), {0.5, 0, std::sqrt(0.75)});
    expectNear(sampleCosineHemisphere<Real>(Real(0.5), Real(0.25)), {0, -0.5, std::sqrt(0.75)});
    expectNear(sampleCosineHemisphere<Real>(Real(0.25), Real(0.625)),
               {-0.5 * std::cos(kPi / 8), 0.5 * std::sin(kPi / 8), std::sqrt(0.75)});
    expectNear(sampleCosineHemisphere<Real>(Real(0), Real(0)),
               {-std::sqrt(0.5), -std::sqrt(0.5), std::sqrt(0x1p-23)}); // the rim is out of reach
}

TYPED_TEST(ReferenceSampling, UniformHemisphereHasItsMoments) {
    using Real = TypeParam;
    constexpr int kGrid = 400;
    Vec3d mean(0.0), squares(0.0);
    forEachGridPoint(kGrid, [&](double u, double v) {
        const Vec3<Real> w = sampleUniformHemisphere(static_cast<Real>(u), static_cast<Real>(v));
        ASSERT_NEAR(glm::dot(w, w), 1, 8 * std::numeric_limits<Real>::epsilon());
        mean += Vec3d(w) / double(kGrid * kGrid);
        squares += Vec3d(w * w) / double(kGrid * kGrid);
    });
    EXPECT_NEAR(glm::length(mean - Vec3d(0.0, 0.0, 0.5)), 0.0, 1e-6);
    // Midpoints integrate z^2 = u^2 to 2/(24 * 400^2).
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(squares[axis], 1.0 / 3.0, 2.0 / (24.0 * 400 * 400) + 1e-6);
    EXPECT_EQ(sampleUniformHemisphere(Real(0), Real(0)), Vec3<Real>(1, 0, 0));
    EXPECT_NEAR(glm::length(sampleUniformHemisphere(Real(0.6), Real(0.25)) - Vec3<Real>(0, Real(0.8), Real(0.6))), 0,
                4 * std::numeric_limits<Real>::epsilon());
}

TYPED_TEST(ReferenceSampling, ScatteredDirectionsCarryTheirDensityAndWeight) {
    using Real = TypeParam;
    constexpr int kGrid = 200;
    Surface<Real> surface{};
    surface.ns = glm::normalize(Vec3<Real>(1, 2, -2));
    double uniform = 0.0;
    forEachGridPoint(kGrid, [&](double u, double v) {
        const PhiloxBlock words{static_cast<std::uint32_t>(u * 0x1p32), static_cast<std::uint32_t>(v * 0x1p32), 0, 0};
        const auto flat = scatterUniformly(surface, words), lobe = scatterByCosine(surface, words);
        ASSERT_NEAR(flat.pdf, 0.5 / kPi, 1e-7);
        // Lambert's cos/pi over the density, whichever way.
        ASSERT_NEAR(flat.weight, glm::dot(flat.wi, surface.ns) / static_cast<Real>(kPi) / flat.pdf, 1e-6);
        ASSERT_NEAR(lobe.pdf, glm::dot(lobe.wi, surface.ns) / static_cast<Real>(kPi), 1e-7);
        ASSERT_EQ(lobe.weight, 1);
        uniform += double(flat.weight) / (kGrid * kGrid);
    });
    EXPECT_NEAR(uniform, 1.0, 1e-5) << "a white surface reflects everything";
    EXPECT_GE(scatterUniformly(surface, {0, 0, 0, 0}).weight, 0) << "in the horizon";
}

TYPED_TEST(ReferenceSampling, DiskSamplesAreUniform) {
    using Real = TypeParam;
    constexpr int kGrid = 400;
    Vec2d mean(0.0), squares(0.0);
    forEachGridPoint(kGrid, [&](double u, double v) {
        const Vec2<Real> p = sampleDisk(static_cast<Real>(u), static_cast<Real>(v));
        ASSERT_LE(glm::dot(p, p), 1 + 4 * std::numeric_limits<Real>::epsilon());
        mean += Vec2d(p) / double(kGrid * kGrid);
        squares += Vec2d(p * p) / double(kGrid * kGrid);
    });
    EXPECT_NEAR(glm::length(mean), 0.0, 1e-6);
    EXPECT_NEAR(squares.x, 0.25, 1e-4);
    EXPECT_NEAR(squares.y, 0.25, 1e-4);
}

TYPED_TEST(ReferenceSampling, TriangleSamplesAreUniform) {
    using Real = TypeParam;
    constexpr int kGrid = 400;
    Vec3d mean(0.0), squares(0.0);
    forEachGridPoint(kGrid, [&](double u, double v) {
        const Vec3<Real> b = sampleTriangle(static_cast<Real>(u), static_cast<Real>(v));
        ASSERT_GE(std::min(b.x, std::min(b.y, b.z)), 0);
        mean += Vec3d(b) / double(kGrid * kGrid);
        squares += Vec3d(b * b) / double(kGrid * kGrid);
    });
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(mean[i], 1.0 / 3.0, 1e-5);
        EXPECT_NEAR(squares[i], 1.0 / 6.0, 1e-5);
    }
    EXPECT_EQ(sampleTriangle(Real(0.5), Real(0.75)), Vec3<Real>(0.25, 0.5, 0.25));
    EXPECT_EQ(sampleTriangle(Real(0.75), Real(0.5)), Vec3<Real>(0.5, 0.25, 0.25));
}

TYPED_TEST(ReferenceSampling, ConesAndSpheresAreUniform) {
    using Real = TypeParam;
    for (const double height : {1e-6, 0.3, 1.0}) {
        double meanHeight = 0.0;
        Vec3d mean(0.0);
        forEachGridPoint(200, [&](double u, double v) {
            const Vec3<Real> cone = sampleCone(static_cast<Real>(height), static_cast<Real>(u), static_cast<Real>(v));
            meanHeight += (double(cone.x) * cone.x + double(cone.y) * cone.y) / (1.0 + cone.z) / 40000.0; // 1 - cos
            mean += Vec3d(sampleSphere(static_cast<Real>(u), static_cast<Real>(v))) / 40000.0;
        });
        EXPECT_NEAR(meanHeight / height, 0.5, 1e-5);
        EXPECT_NEAR(glm::length(mean), 0.0, 1e-5);
    }
}

TYPED_TEST(ReferenceSampling, ConeHeightDoesNotCancel) {
    using Real = TypeParam;
    for (const double ratio : {1e-9, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99}) {
        const Real radius = static_cast<Real>(ratio);
        const long double square = static_cast<long double>(radius) * radius;
        const long double series =
            square / 2 + square * square / 8 + square * square * square / 16; // where even this precision cancels
        const long double expected = ratio < 1e-2 ? series : 1.0L - std::sqrt(1.0L - square);
        EXPECT_NEAR(static_cast<double>(coneHeight(radius * radius, Real(1)) / expected), 1.0,
                    40 * std::numeric_limits<Real>::epsilon())
            << ratio;
    }
}

TYPED_TEST(ReferenceSampling, HeuristicsSumToOneAtTheEndsOfTheRange) {
    using Real = TypeParam;
    const std::array<double, 7> exponents = {-38, -20, -1, 0, 1, 20, 38};
    for (const double f : exponents)
        for (const double g : exponents) {
            const Real a = static_cast<Real>(std::pow(10.0, f)), b = static_cast<Real>(std::pow(10.0, g));
            EXPECT_NEAR(powerHeuristic(a, b) + powerHeuristic(b, a), 1, 1e-6) << f << ' ' << g;
            EXPECT_NEAR(balanceHeuristic(a, b) + balanceHeuristic(b, a), 1, 1e-6) << f << ' ' << g;
        }
    EXPECT_NEAR(powerHeuristic(Real(1), Real(2)), 0.2, 1e-7);
    EXPECT_EQ(powerHeuristic(Real(3), Real(0)), 1);
    EXPECT_EQ(powerHeuristic(Real(0), Real(3)), 0);
    EXPECT_NEAR(balanceHeuristic(Real(1), Real(2)), 1.0 / 3.0, 1e-7);
    EXPECT_EQ(balanceHeuristic(Real(3), Real(1)), Real(0.75));
    EXPECT_EQ(balanceHeuristic(Real(3), Real(0)), 1);
    EXPECT_EQ(balanceHeuristic(Real(0), Real(3)), 0);
}

template <typename Real> class ReferenceLights : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceLights, RealTypes);

PhiloxBlock lightWords(double u, double v) {
    const auto word = [](double x) { return static_cast<std::uint32_t>(x * 4294967296.0); };
    return {0, 0, word(u), word(v)};
}

Scene sphereLight(const Vec3d& center, double radius) {
    SceneBuilder builder;
    builder.scene.spheres.push_back({"", center, radius, builder.material(Vec3d(0.5), Vec3d(1.0), Faces::both)});
    return builder.scene;
}

/// The mean of 1/pdf over light samples is the measure of the directions they cover.
template <typename Real> double sampledSolidAngle(const Scene& scene, const Vec3d& origin, int grid) {
    const World<Real> world = flatten<Real>(scene);
    const Lights<Real> lights(scene, world);
    Surface<Real> receiver{};
    receiver.origin = Vec3<Real>(origin);
    double sum = 0.0;
    forEachGridPoint(grid, [&](double u, double v) {
        if (const auto sample = lights.sample(receiver, lightWords(u, v)))
            sum += 1.0 / static_cast<double>(sample->pdf);
    });
    return sum / (grid * grid);
}

TYPED_TEST(ReferenceLights, SphereSamplesCoverItsSolidAngle) {
    const Vec3d origin(0.3, -0.2, 0.1);
    for (const double distance : {1.0 + 1e-5, 1.1, 2.0, 100.0, 1e6}) {
        const Scene scene = sphereLight(origin + Vec3d(0.6, 0.0, -0.8) * distance, 1.0);
        const double ratio = 1.0 / distance;
        const double expected = 2.0 * kPi * ratio * ratio / (1.0 + std::sqrt(1.0 - ratio * ratio));
        EXPECT_NEAR(sampledSolidAngle<TypeParam>(scene, origin, 8) / expected, 1.0, distance < 1.01 ? 1e-3 : 2e-6)
            << distance;
    }
    for (const double distance : {0.0, 0.3, 0.9}) {
        const Scene scene = sphereLight(origin + Vec3d(0.0, 0.6, -0.8) * distance, 1.0);
        EXPECT_NEAR(sampledSolidAngle<TypeParam>(scene, origin, 300) / (4.0 * kPi), 1.0, 1e-3) << distance;
    }
}

TYPED_TEST(ReferenceLights, TriangleSamplesCoverItsSolidAngle) {
    SceneBuilder builder;
    // An octant as seen from the origin: a triangle through the three axes.
    const std::uint32_t material = builder.material(Vec3d(0.5), Vec3d(1.0), Faces::both);
    builder.mesh(triangleMesh({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, material));
    EXPECT_NEAR(sampledSolidAngle<TypeParam>(builder.scene, Vec3d(0.0), 300), kPi / 2, 1e-4);
}

TYPED_TEST(ReferenceLights, BothWaysToADirectionAgreeOnItsDensity) {
    using Real = TypeParam;
    SceneBuilder builder;
    const std::uint32_t material = builder.material(Vec3d(0.5), Vec3d(2.0), Faces::both);
    builder.mesh(squareMesh(material), translation({0, 0, -2}));
    builder.scene.spheres = {
        {"", {3, 0, 0}, 1.0, material}, {"", {0, 3, 0}, 1e-3, material}, {"", {0, 0, 0}, 20.0, material}};
    const World<Real> world = flatten<Real>(builder.scene);
    const Lights<Real> lights(builder.scene, world);
    const RayCaster<Real> caster(world);
    Random random(8);
    Surface<Real> receiver{};
    std::map<std::uint32_t, int> compared;
    for (int i = 0; i < 20000; ++i) {
        receiver.origin = Vec3<Real>(random.inCube(1.0));
        PhiloxBlock words = lightWords(random.unit(), random.unit());
        for (std::size_t word = 0; word < 2; ++word) words[word] = static_cast<std::uint32_t>(random.index(1ull << 32));
        const auto sample = lights.sample(receiver, words);
        if (!sample) continue;
        const Ray<Real> ray{receiver.origin, sample->wi};
        const auto hit = caster.nearest(ray);
        if (!hit || hit->primitive != sample->primitive) continue;
        ++compared[sample->primitive];
        ASSERT_NEAR(lights.pdf(receiver.origin, surfaceAt(world, ray, *hit)) / sample->pdf, 1, 1e-3)
            << sample->primitive;
        ASSERT_EQ(caster.visibility(sample->shadowRay, sample->primitive), Visibility::clear);
    }
    EXPECT_GE(compared.size(), 4u);
}

TYPED_TEST(ReferenceLights, ALightIsNotHiddenByItsNeighboursOrItself) {
    using Real = TypeParam;
    SceneBuilder builder;
    Mesh mesh = icosphere(2, 1.0f);
    mesh.material = builder.material(Vec3d(0.5), Vec3d(1.0), Faces::front);
    builder.mesh(mesh, translation({3, 50, 7}));
    const World<Real> world = flatten<Real>(builder.scene);
    const Lights<Real> lights(builder.scene, world);
    const RayCaster<Real> caster(world);
    Random random(11);
    Surface<Real> receiver{};
    int seen = 0;
    for (int i = 0; i < 50000; ++i) {
        receiver.origin = Vec3<Real>(Vec3d(3, 50, 7) + random.direction() * 3.0);
        PhiloxBlock words = lightWords(random.unit(), i % 2 == 0 ? 0.0 : random.unit()); // half of them on edges
        for (std::size_t word = 0; word < 2; ++word) words[word] = static_cast<std::uint32_t>(random.index(1ull << 32));
        const auto sample = lights.sample(receiver, words);
        if (!sample || -glm::dot(sample->wi, world.triangles[sample->primitive].ng) < Real(0.05)) continue;
        ++seen;
        ASSERT_EQ(caster.visibility(sample->shadowRay, sample->primitive), Visibility::clear) << i;
    }
    EXPECT_GT(seen, 10000);
}

} // namespace
} // namespace isolux
