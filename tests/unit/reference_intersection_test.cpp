// Rays against triangles, spheres and whole scenes in the CPU reference: no gaps, no false hits; surfaces at hits.
#include "reference/surface.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

template <typename Real> class ReferenceIntersection : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceIntersection, RealTypes);

/// Shoots rays from inside a closed mesh at its vertices and edges; the number that get out.
template <typename Real> int countLeaks(const Mesh& mesh, const Vec3d& offset, double freedom, int rays) {
    SceneBuilder builder;
    builder.mesh(mesh, translation(offset));
    const World<Real> world = flatten<Real>(builder.scene);
    const RayCaster<Real> caster(world);
    Random random(42);
    int leaks = 0;
    for (int i = 0; i < rays; ++i) {
        const auto& p = world.triangles[random.index(world.triangles.size())].positions;
        const double along = i % 2 == 0 ? 0.0 : random.unit();
        const Vec3d target = Vec3d(p[0]) + (Vec3d(p[1]) - Vec3d(p[0])) * along;
        if (!caster.nearest(rayFrom<Real>(offset + random.inCube(freedom), target))) ++leaks;
    }
    return leaks;
}

TYPED_TEST(ReferenceIntersection, ClosedMeshHasNoGapAtEdgesAndVertices) {
    EXPECT_EQ(countLeaks<TypeParam>(icosphere(3, 1.0f), Vec3d(0.0), 0.5, 1000000), 0);
    EXPECT_EQ(countLeaks<TypeParam>(icosahedron(), Vec3d(0.0), 0.0, 100000), 0);
}

TYPED_TEST(ReferenceIntersection, ClosedMeshFarFromTheOriginHasNoGap) {
    EXPECT_EQ(countLeaks<TypeParam>(icosphere(3, 2.0f), {148376.0, 1234.0, -223423.0}, 1.0, 500000), 0);
}

TYPED_TEST(ReferenceIntersection, SharedEdgesCancelExactly) {
    using Real = TypeParam;
    Random random(3);
    for (int i = 0; i < 10000; ++i) {
        const Vec3<Real> p(random.inCube(1.0)), q(random.inCube(1.0));
        ASSERT_EQ(edgeVolume(p, q), -edgeVolume(q, p));
    }
}

TYPED_TEST(ReferenceIntersection, BvhFindsWhatBruteForceFinds) {
    using Real = TypeParam;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const World<Real> world = flatten<Real>(randomSoup(seed));
        const RayCaster<Real> fast(world), plain(world, {Acceleration::none});
        Random random(seed + 100);
        int hits = 0;
        for (int i = 0; i < 5000; ++i) {
            Ray<Real> ray =
                rayFrom<Real>(Vec3d(10.0, -3.0, 0.1) + random.inCube(3.0), Vec3d(10.0, -3.0, 0.1) + random.inCube(2.0));
            if (i % 4 == 0) {
                ray.direction = Vec3<Real>(0);
                ray.direction[i / 4 % 3] = i % 8 == 0 ? Real(1) : Real(-1);
                ray.direction[(i / 4 + 1) % 3] = i % 16 == 0 ? Real(-0.0) : Real(0);
            } else if (i % 4 == 1) { // grazing: within a triangle's plane
                const auto& p = world.triangles[random.index(world.triangles.size())].positions;
                ray.origin = p[0] + (p[0] - p[1]);
                ray.direction = glm::normalize(p[2] - ray.origin);
            }
            const auto a = fast.nearest(ray), b = plain.nearest(ray);
            ASSERT_EQ(a.has_value(), b.has_value()) << "ray " << i;
            ray.tMax = static_cast<Real>(random.between(0.0, 4.0));
            ASSERT_EQ(fast.visibility(ray, 5), plain.visibility(ray, 5)) << "ray " << i;
            if (!a) continue;
            ++hits;
            ASSERT_EQ(a->t, b->t) << "ray " << i;
            ASSERT_EQ(a->primitive, b->primitive) << "ray " << i;
        }
        EXPECT_GT(hits, 1000);
    }
}

TEST(ReferencePrecision, FloatAgreesWithDouble) {
    const Scene scene = randomSoup(9);
    const World<float> single = flatten<float>(scene);
    const World<double> full = flatten<double>(scene);
    const RayCaster<float> casterSingle(single);
    const RayCaster<double> casterFull(full);
    Random random(10);
    int differing = 0, hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Ray<float> ray =
            rayFrom<float>(Vec3d(10.0, -3.0, 0.1) + random.inCube(3.0), Vec3d(10.0, -3.0, 0.1) + random.inCube(2.0));
        const auto a = casterSingle.nearest(ray);
        const auto b = casterFull.nearest({Vec3d(ray.origin), glm::normalize(Vec3d(ray.direction))});
        const bool same = a.has_value() == b.has_value() && (!a || a->primitive == b->primitive);
        if (!same) ++differing;
        if (!same || !a) continue;
        ++hits;
        const Vec3d n = full.isTriangle(a->primitive) ? full.triangles[a->primitive].ng : Vec3d(ray.direction);
        const double cosine = std::max(1e-3, std::abs(glm::dot(n, Vec3d(ray.direction))));
        if (full.isTriangle(a->primitive)) {
            ASSERT_NEAR(a->t, b->t, 1e-5 / cosine);
        }
    }
    EXPECT_GT(hits, 10000);
    EXPECT_LT(differing, 20);
}

TYPED_TEST(ReferenceIntersection, DegenerateTrianglesAreNeverHit) {
    using Real = TypeParam;
    SceneBuilder builder;
    builder.mesh(triangleMesh({-1, -1, 0}, {0, 0, 0}, {2, 2, 0}));
    builder.mesh(triangleMesh({0, 0, 0}, {0, 0, 0}, {0, 0, 0}));
    builder.mesh(triangleMesh({-1, 0, 0}, {1, 0, 0}, {-1, 0, 0}));
    const World<Real> world = flatten<Real>(builder.scene);
    const RayCaster<Real> caster(world, {Acceleration::none});
    Random random(4);
    for (int i = 0; i < 2000; ++i) {
        const double x = random.between(-1, 1);
        const Vec3d target = i % 2 == 0 ? Vec3d(x, x, 0) : Vec3d(i % 4 == 1 ? x : 0.0, 0, 0);
        ASSERT_FALSE(caster.nearest(rayFrom<Real>(target + random.inCube(1.0), target)));
    }
    EXPECT_FALSE(caster.nearest({Vec3<Real>(0, 0, 1), Vec3<Real>(0, 0, -1)}));
}

TYPED_TEST(ReferenceIntersection, TrianglesAreHitFromBothSidesAndOnlyInFront) {
    using Real = TypeParam;
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    const World<Real> world = flatten<Real>(builder.scene);
    const RayCaster<Real> caster(world);
    for (const Real z : {Real(2), Real(-2)}) {
        const Vec3<Real> origin(Real(0.25), Real(0.5), z);
        const auto hit = caster.nearest({origin, Vec3<Real>(0, 0, -z / 2)});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->t, 2);
        EXPECT_FALSE(caster.nearest({origin, Vec3<Real>(0, 0, z / 2)}));
        EXPECT_FALSE(caster.nearest({origin, Vec3<Real>(0, 0, -z / 2), Real(1.5)}));
    }
    EXPECT_FALSE(caster.nearest({Vec3<Real>(3, 0, 0), Vec3<Real>(-1, 0, 0)})) << "within the plane";
}

TYPED_TEST(ReferenceIntersection, SphereFromOutsideInsideTangentAndFar) {
    using Real = TypeParam;
    const WorldSphere<Real> sphere{Vec3<Real>(1, 2, 3), Real(0.5), 0};
    const auto distance = [&](const Vec3<Real>& origin, const Vec3<Real>& direction) {
        return intersectSphere<Real>({origin, direction}, sphere).value_or(Real(-1));
    };
    EXPECT_EQ(distance({1, 2, 5}, {0, 0, -1}), Real(1.5));
    EXPECT_EQ(distance({1, 2, 3}, {0, 1, 0}), Real(0.5));
    EXPECT_EQ(distance({1, 2, Real(3.25)}, {0, 0, 1}), Real(0.25));
    EXPECT_EQ(distance({1, 2, Real(3.25)}, {0, 0, -1}), Real(0.75));
    EXPECT_EQ(distance({1, 2, 5}, {0, 0, 1}), Real(-1));
    EXPECT_EQ(distance({Real(1.5), 2, 5}, {0, 0, -1}), Real(2)) << "tangent";
    EXPECT_EQ(distance({Real(1.5) + 4 * std::numeric_limits<Real>::epsilon(), 2, 5}, {0, 0, -1}), Real(-1));
}

TYPED_TEST(ReferenceIntersection, SmallSphereFarAwayIsHitWithinItsRadius) {
    using Real = TypeParam;
    Random random(5);
    for (const double ratio : {1e-2, 1e-4, 1e-6}) {
        int wrong = 0;
        for (int i = 0; i < 2000; ++i) {
            // Aimed at 0.8 and at 1.2 radii from the centre: rounding of the direction moves a ray by 1e-7 of the
            // distance.
            const Vec3d way = random.direction();
            const Vec3d aside = frameAbout(way).t * ratio * (i % 2 == 0 ? 0.8 : 1.2);
            const WorldSphere<Real> sphere{Vec3<Real>(way), static_cast<Real>(ratio), 0};
            const auto t = intersectSphere<Real>({Vec3<Real>(0), glm::normalize(Vec3<Real>(way + aside))}, sphere);
            if (t.has_value() != (i % 2 == 0)) ++wrong;
            if (t) {
                ASSERT_NEAR(*t, 1.0, 1.1 * ratio + 4 * std::numeric_limits<Real>::epsilon());
            }
        }
        EXPECT_EQ(wrong, 0) << ratio;
    }
}

/// Hits the world's primitives from everywhere and starts a ray in a random direction on the near side of each.
template <typename Real> int countFalseHits(const Scene& scene, const Vec3d& center, double size, int rays) {
    const World<Real> world = flatten<Real>(scene);
    const RayCaster<Real> caster(world);
    Random random(6);
    int falseHits = 0, hits = 0;
    for (int i = 0; i < rays; ++i) {
        const Ray<Real> ray =
            rayFrom<Real>(center + random.direction() * (3.0 * size), center + random.inCube(0.6 * size));
        const auto hit = caster.nearest(ray);
        if (!hit) continue;
        ++hits;
        const Surface<Real> surface = surfaceAt(world, ray, *hit);
        Vec3<Real> away(random.direction());
        if (i % 3 == 0) away = surface.facing;
        if (glm::dot(away, surface.facing) < 0) away = -away;
        if (glm::dot(away, surface.facing) > Real(1e-4) && caster.nearest({surface.origin, away})) ++falseHits;
    }
    EXPECT_GT(hits, rays / 4);
    return falseHits;
}

TYPED_TEST(ReferenceIntersection, RaysLeavingASurfaceDoNotMeetItAgain) {
    for (const double size : {1e-3, 1.0, 1e4})
        for (const double shift : {0.0, 1.0, 1e3}) {
            const Vec3d center = Vec3d(0.7, -0.3, 0.5) * (shift * size);
            SceneBuilder plane;
            Mat4d tilt = translation(center) * scaling(Vec3d(size));
            tilt[2] += tilt[0] * 0.3 + tilt[1] * 0.7;
            tilt[0] += tilt[2] * 0.4;
            plane.mesh(squareMesh(0), tilt);
            EXPECT_EQ(countFalseHits<TypeParam>(plane.scene, center, size, 20000), 0) << size << ' ' << shift;
            SceneBuilder ball;
            ball.scene.spheres.push_back({"", center, size, 0});
            EXPECT_EQ(countFalseHits<TypeParam>(ball.scene, center, size, 20000), 0) << size << ' ' << shift;
        }
}

TYPED_TEST(ReferenceIntersection, RaysInsideASphereStayInside) {
    using Real = TypeParam;
    for (const Vec3d& center : {Vec3d(0.0), Vec3d(148376.0, 1234.0, -223423.0)}) {
        SceneBuilder builder;
        builder.scene.spheres.push_back({"", center, 2.0, 0});
        const World<Real> world = flatten<Real>(builder.scene);
        const RayCaster<Real> caster(world);
        Random random(7);
        Ray<Real> ray{Vec3<Real>(center), Vec3<Real>(0, 0, 1)};
        for (int i = 0; i < 100000; ++i) {
            const auto hit = caster.nearest(ray);
            ASSERT_TRUE(hit) << "bounce " << i;
            const Surface<Real> surface = surfaceAt(world, ray, *hit);
            ASSERT_EQ(surface.side(), Side::back) << "bounce " << i;
            const Vec3<Real> local =
                sampleCosineHemisphere(static_cast<Real>(random.unit()), static_cast<Real>(random.unit()));
            ray = {surface.origin, glm::normalize(frameAbout(surface.facing).toWorld(local))};
        }
    }
}

Surface<double> surfaceSeen(const Scene& scene, const Vec3d& origin, const Vec3d& target) {
    const World<double> world = flatten<double>(scene);
    const Ray<double> ray = rayFrom<double>(origin, target);
    const auto hit = RayCaster<double>(world).nearest(ray);
    EXPECT_TRUE(hit);
    return hit ? surfaceAt(world, ray, *hit) : Surface<double>{};
}

TEST(ReferenceSurface, NegativeDeterminantFlipsTheFront) {
    for (const double sign : {1.0, -1.0}) {
        SceneBuilder builder;
        builder.mesh(squareMesh(0), translation({0, 0, 1}) * scaling({sign, 1.0, 1.0}));
        const Surface<double> above = surfaceSeen(builder.scene, {0.1, 0.2, 3}, {0.1, 0.2, 1});
        // Mirroring x leaves the object's +z side its front (glTF 2.0, 3.7.4), though the vertices now run clockwise.
        EXPECT_EQ(above.side(), Side::front) << sign;
        EXPECT_EQ(above.ng, Vec3d(0, 0, 1));
        const Surface<double> below = surfaceSeen(builder.scene, {0.1, 0.2, -3}, {0.1, 0.2, 1});
        EXPECT_EQ(below.side(), Side::back);
        EXPECT_EQ(below.facing, Vec3d(0, 0, -1));
        EXPECT_LT(below.origin.z, 1.0);
        EXPECT_GT(below.origin.z, 1.0 - 1e-13);
    }
}

TEST(ReferenceSurface, ShadingNormalsAreTransformedByTheInverseTranspose) {
    SceneBuilder builder;
    Mesh mesh = squareMesh(0);
    mesh.normals.assign(4, glm::normalize(Vec3f(1, 0, 1)));
    builder.mesh(mesh, scaling({2.0, 1.0, 1.0}));
    const Vec3d expected = glm::normalize(Vec3d(0.5, 0.0, 1.0));
    const Surface<double> above = surfaceSeen(builder.scene, {0.1, 0.2, 3}, {0.1, 0.2, 0});
    EXPECT_NEAR(glm::length(above.ns - expected), 0.0, 1e-7);
    const Surface<double> below = surfaceSeen(builder.scene, {0.1, 0.2, -3}, {0.1, 0.2, 0});
    EXPECT_NEAR(glm::length(below.ns + expected), 0.0, 1e-7);
}

TEST(ReferenceSurface, ShadingNormalsAreInterpolatedAndMayCancel) {
    SceneBuilder builder;
    Mesh mesh = triangleMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.normals = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    builder.mesh(mesh);
    mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 0}};
    builder.mesh(mesh, translation({5, 0, 0}));
    const Surface<double> corner = surfaceSeen(builder.scene, {0.5, 0.25, 1}, {0.5, 0.25, 0});
    EXPECT_NEAR(glm::length(corner.ns - glm::normalize(Vec3d(0.5, 0.25, 0.25))), 0.0, 1e-12);
    const Surface<double> cancelled = surfaceSeen(builder.scene, {5.5, 0, 1}, {5.5, 0, 0});
    EXPECT_EQ(cancelled.ns, cancelled.ng);
}

} // namespace
} // namespace isolux
