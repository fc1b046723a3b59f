// How rays of the CPU reference find primitives changes nothing but what the search costs.
#include "reference/ray_caster.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

namespace isolux {
namespace {

using namespace test;

constexpr std::array kTriangleTests = {TriangleTest::watertight, TriangleTest::mollerTrumbore};

template <typename Real> class ReferenceAcceleration : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceAcceleration, RealTypes);

template <typename Real> bool sameHit(const std::optional<Hit<Real>>& a, const std::optional<Hit<Real>>& b) {
    if (!a || !b) return a.has_value() == b.has_value();
    return a->t == b->t && a->primitive == b->primitive && a->barycentric == b->barycentric;
}

TYPED_TEST(ReferenceAcceleration, EveryOneFindsTheSameHitsBitByBit) {
    using Real = TypeParam;
    const World<Real> world = flatten<Real>(randomSoup(21));
    for (const TriangleTest test : kTriangleTests) {
        const RayCaster<Real> plain(world, {Acceleration::none, 4, test});
        for (const Acceleration acceleration : {Acceleration::meanSplit, Acceleration::sah})
            for (const std::uint32_t leafSize : {1u, 3u, 8u}) {
                const RayCaster<Real> caster(world, {acceleration, leafSize, test});
                Random random(22);
                int hits = 0;
                for (int i = 0; i < 2000; ++i) {
                    const Vec3d center(10.0, -3.0, 0.1);
                    Ray<Real> ray = rayFrom<Real>(center + random.inCube(3.0), center + random.inCube(2.0));
                    const auto hit = plain.nearest(ray);
                    if (hit) ++hits;
                    ASSERT_TRUE(sameHit(hit, caster.nearest(ray))) << "ray " << i;
                    ray.tMax = static_cast<Real>(random.between(0.0, 4.0));
                    ASSERT_EQ(plain.visibility(ray, 5), caster.visibility(ray, 5)) << "ray " << i;
                }
                EXPECT_GT(hits, 500);
            }
    }
}

/// What `intersectWatertight` and `intersectMollerTrumbore` find may differ by their rounding: some forty roundings of
/// products of the triangle's sides and its distance, divided by the determinant.
template <typename Real> Real conditionOf(const Ray<Real>& ray, const WorldTriangle<Real>& triangle) {
    Real size = 0, distance = 0;
    for (const Vec3<Real>& p : triangle.positions) {
        size = std::max(size, glm::length(p - triangle.positions[0]));
        distance = std::max(distance, glm::length(p - ray.origin));
    }
    const Real determinant = 2 * triangle.area * std::abs(glm::dot(triangle.ng, ray.direction));
    return distance * (size + distance) / determinant;
}

TYPED_TEST(ReferenceAcceleration, MollerTrumboreIsTheWatertightTestAwayFromEdges) {
    using Real = TypeParam;
    Random random(31);
    int hits = 0, misses = 0;
    for (int i = 0; i < 20000; ++i) {
        SceneBuilder builder;
        const auto corner = [&] { return Vec3f(random.inCube(1.0)); };
        const Vec3f a = corner(), b = corner();
        builder.mesh(triangleMesh(a, b, corner()));
        const WorldTriangle<Real> triangle = flatten<Real>(builder.scene).triangles[0];
        const Vec3d weights(random.between(-0.5, 1.0), random.between(-0.5, 1.0), 0.0);
        const Vec3d barycentric(weights.x, weights.y, 1.0 - weights.x - weights.y);
        Vec3d target(0.0);
        for (int k = 0; k < 3; ++k) target += barycentric[k] * Vec3d(triangle.positions[static_cast<std::size_t>(k)]);
        const Ray<Real> ray = rayFrom<Real>(random.inCube(2.0), target);
        const Real tolerance = roundingBound<Real>(40) * conditionOf(ray, triangle);
        const double toEdge = std::min(barycentric.x, std::min(barycentric.y, barycentric.z));
        if (!(std::abs(toEdge) > tolerance)) continue;
        const auto expected = intersectWatertight(RayView<Real>(ray), triangle);
        const auto hit = intersectMollerTrumbore(ray, triangle);
        ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
        ASSERT_EQ(hit.has_value(), toEdge > 0.0) << i;
        ++(hit ? hits : misses);
        if (!hit) continue;
        ASSERT_NEAR(glm::length(hit->barycentric - expected->barycentric), 0, tolerance) << i;
        ASSERT_NEAR(hit->t, expected->t, tolerance) << i;
        ASSERT_FALSE(intersectMollerTrumbore<Real>({ray.origin, -ray.direction}, triangle)) << "behind";
    }
    EXPECT_GT(hits, 2000);
    EXPECT_GT(misses, 5000);
}

TYPED_TEST(ReferenceAcceleration, MollerTrumboreMissesWhatIsParallelOrWithoutArea) {
    using Real = TypeParam;
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    builder.mesh(triangleMesh({-1, -1, 0}, {0, 0, 0}, {2, 2, 0}));
    const World<Real> world = flatten<Real>(builder.scene);
    EXPECT_FALSE(intersectMollerTrumbore<Real>({{3, 0, 0}, {-1, 0, 0}}, world.triangles[0]));
    EXPECT_FALSE(intersectMollerTrumbore<Real>({{3, 0, 1}, {-1, 0, 0}}, world.triangles[0]));
    EXPECT_FALSE(intersectMollerTrumbore<Real>({{0, 0, 1}, {0, 0, -1}}, world.triangles[2]));
    for (const Real z : {Real(1), Real(-1)})
        EXPECT_TRUE(intersectMollerTrumbore<Real>({{Real(0.5), Real(-0.25), z}, {0, 0, -z}}, world.triangles[0]));
}

Film renderBy(const IntersectionMethod& method, std::uint32_t maxDepth) {
    RenderSettings settings = smallSettings(4);
    settings.intersection = method;
    settings.maxDepth = maxDepth;
    return render(smallRoom(), settings, {.signatures = PathSignatures::on, .counts = TraversalCounts::on});
}

TEST(ReferenceAccelerationFilm, IsTheSameByEveryMethod) {
    for (const TriangleTest test : kTriangleTests) {
        const Film plain = renderBy({Acceleration::none, 4, test}, kUnlimitedDepth);
        for (const Acceleration acceleration : {Acceleration::meanSplit, Acceleration::sah}) {
            const Film film = renderBy({acceleration, 2, test}, kUnlimitedDepth);
            EXPECT_EQ(film.pixels, plain.pixels);
            EXPECT_EQ(film.rays, plain.rays);
        }
    }
}

TEST(ReferenceAccelerationFilm, CountsTests) {
    const Scene scene = smallRoom();
    const Film plain = renderBy({Acceleration::none}, 0);
    EXPECT_EQ(plain.boxTests, 0u);
    EXPECT_EQ(plain.primitiveTests, plain.rays * primitiveCount(scene)) << "rays for the nearest hit ask every one";
    const Film largeLeaves = renderBy({Acceleration::meanSplit, 8}, 0);
    EXPECT_LE(largeLeaves.primitiveTests, plain.primitiveTests);
    const Film film = renderBy({Acceleration::meanSplit, 1}, 0);
    EXPECT_LT(film.primitiveTests, largeLeaves.primitiveTests);
    EXPECT_GT(film.boxTests, largeLeaves.boxTests);
    EXPECT_EQ((film.boxTests - film.rays) % 2, 0u) << "the root, then children in pairs";
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    const Film alone = renderBy({Acceleration::meanSplit, 1}, 0);
    EXPECT_EQ(alone.boxTests, film.boxTests);
    EXPECT_EQ(alone.primitiveTests, film.primitiveTests);
    const Film uncounted = render(scene, smallSettings(1));
    EXPECT_EQ(uncounted.boxTests + uncounted.primitiveTests, 0u);
}

TEST(ReferenceAccelerationFilm, ShadowRaysStopAtTheFirstBlocker) {
    const Film nearest = renderBy({Acceleration::none}, 0), direct = renderBy({Acceleration::none}, 1);
    const std::uint64_t further = direct.rays - nearest.rays;
    EXPECT_LT(direct.primitiveTests - nearest.primitiveTests, further * primitiveCount(smallRoom()));
}

} // namespace
} // namespace isolux
