// Camera rays of the CPU reference: pinhole and thin lens, and how filters spread samples about pixels.
#include "reference/camera.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

TEST(ReferenceCamera, RaysPassThroughThePixels) {
    Camera camera;
    camera.position = {1, 2, 3};
    camera.worldFromCamera = Mat3d(Vec3d(0, 0, -1), Vec3d(0, 1, 0), Vec3d(1, 0, 0)); // looks along -x
    camera.yfov = kPi / 2;
    RenderSettings settings;
    settings.width = 200;
    settings.height = 100;
    const CameraRays<double> rays(camera, settings);
    EXPECT_NEAR(glm::length(rays.through(100, 50, 0.0, 0.0).direction - Vec3d(-1, 0, 0)), 0.0, 1e-15);
    EXPECT_NEAR(glm::length(rays.through(0, 0, 0.0, 0.0).direction - glm::normalize(Vec3d(-1, 1, 2))), 0.0, 1e-15);
    EXPECT_NEAR(glm::length(rays.through(149, 74, 1.0, 1.0).direction - glm::normalize(Vec3d(-1, -0.5, -1))), 0.0,
                1e-15);
    EXPECT_EQ(rays.through(7, 8, 0.5, 0.5).origin, Vec3d(1, 2, 3));
}

template <typename Real> class ReferenceOrthographic : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceOrthographic, RealTypes);

TYPED_TEST(ReferenceOrthographic, RaysAreParallelFromAGridOnTheImagePlane) {
    using Real = TypeParam;
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.position = {1, 2, 3};
    camera.worldFromCamera = Mat3d(Vec3d(0, 0, -1), Vec3d(0, 1, 0), Vec3d(1, 0, 0)); // looks along -x
    camera.ymag = 4.0;
    RenderSettings settings;
    settings.width = 32;
    settings.height = 16; // pixels of edge 1/2: 8 over 16
    const CameraRays<Real> rays(camera, settings);
    for (std::uint32_t y = 0; y < settings.height; ++y)
        for (std::uint32_t x = 0; x < settings.width; ++x) {
            const Ray<Real> ray = rays.through(x, y, Real(0.25), Real(0.75));
            ASSERT_EQ(ray.direction, Vec3<Real>(-1, 0, 0));
            const double right = (x + 0.25) * 0.5 - 8.0, up = 4.0 - (y + 0.75) * 0.5;
            ASSERT_EQ(Vec3d(ray.origin), Vec3d(1, 2, 3) + Vec3d(0, up, -right)) << "powers of two: exact";
            ASSERT_EQ(ray.tMax, std::numeric_limits<Real>::infinity());
        }
    EXPECT_EQ(rays.depth({Real(-6), 50, 60}), 7) << "along the axis, from the camera's plane";
}

/// A word whose number is u, a multiple of 2^-24.
std::uint32_t wordOf(double u) { return static_cast<std::uint32_t>(u * 0x1p32); }

Camera lensCamera(Projection projection) {
    Camera camera;
    camera.projection = projection;
    camera.position = {1, 2, 3};
    const Frame<double> frame = frameAbout(glm::normalize(Vec3d(1, -2, 2)));
    camera.worldFromCamera = Mat3d(frame.t, frame.s, frame.n);
    camera.ymag = 2.0;
    return camera;
}

/// Where a ray is at a depth along the camera's axis.
template <typename Real> Vec3d atDepth(const Ray<Real>& ray, const Camera& camera, double depth) {
    const Vec3d axis = -camera.worldFromCamera[2], origin(ray.origin), direction(ray.direction);
    return origin + direction * ((depth - glm::dot(origin - camera.position, axis)) / glm::dot(direction, axis));
}

template <typename Real> class ReferenceThinLens : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceThinLens, RealTypes);

TYPED_TEST(ReferenceThinLens, PointsInFocusStayAndOthersSpreadOverTheCircleOfConfusion) {
    using Real = TypeParam;
    RenderSettings settings;
    settings.width = 32;
    settings.height = 16;
    settings.lens = {.aperture = 0.5, .focus = 4.0};
    // Positions of some 10 units, by some 20 roundings of each of the ray's two vectors; slopes are less than 2.
    const double tolerance = 2.0 * 10.0 * roundingBound<Real>(40);
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const Camera camera = lensCamera(projection);
        const CameraRays<Real> rays(camera, settings);
        forEachGridPoint(9, [&](double u, double v) {
            const PhiloxBlock words{wordOf(0.25), wordOf(0.75), wordOf(u), wordOf(v)};
            const Vec2d onLens = 0.25 * Vec2d(sampleDisk(unitReal<double>(words[2]), unitReal<double>(words[3])));
            const Vec3d lens = onLens.x * camera.worldFromCamera[0] + onLens.y * camera.worldFromCamera[1];
            const Ray<Real> ray = rays.sample(5, 11, words);
            const Ray<Real> pinhole = rays.through(5, 11, Real(0.25), Real(0.75));
            ASSERT_NEAR(glm::length(ray.direction), 1, 4 * std::numeric_limits<Real>::epsilon());
            for (const double depth : {0.0, 2.0, 4.0, 7.0}) {
                const Vec3d spread = atDepth(ray, camera, depth) - atDepth(pinhole, camera, depth);
                ASSERT_NEAR(glm::length(spread - lens * (1.0 - depth / 4.0)), 0.0, tolerance) << depth;
            }
        });
    }
}

TYPED_TEST(ReferenceThinLens, WithoutApertureIsAPinhole) {
    using Real = TypeParam;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const CameraRays<Real> rays(lensCamera(projection), {});
        const Ray<Real> ray = rays.sample(5, 11, {wordOf(0.25), wordOf(0.75), wordOf(0.1), wordOf(0.9)});
        const Ray<Real> pinhole = rays.through(5, 11, Real(0.25), Real(0.75));
        EXPECT_EQ(ray.origin, pinhole.origin);
        EXPECT_EQ(ray.direction, pinhole.direction);
    }
}

TEST(ReferenceThinLensFilm, EdgesAreSharpInFocusAndBlurAsFarAsTheCircleOfConfusion) {
    // Columns 0.25 wide, an edge on the boundary of columns 7 and 8, at distance 4; the circle of confusion of a lens
    // of diameter 1.5 focused at 2 has radius 0.75: three columns.
    SceneBuilder builder;
    builder.mesh(squareMesh(0), translation({8, 0, -4}) * scaling({8, 8, 1}));
    builder.scene.cameras.emplace_back();
    builder.scene.cameras[0].projection = Projection::orthographic;
    RenderSettings settings;
    settings.width = 16;
    settings.height = 8;
    settings.sampleCount = 256;
    settings.integrator = Integrator::albedo;
    settings.lens = {.aperture = 1.5, .focus = 4.0};
    const Film sharp = render(builder.scene, settings);
    settings.lens.focus = 2.0;
    const Film blurred = render(builder.scene, settings);
    for (std::uint32_t x = 0; x < 16; ++x) {
        const std::uint64_t hits = blurred.at(x, 3).hitCount;
        if (x == 7 || x == 8) continue; // rounding may move a ray that lands on the edge
        EXPECT_EQ(sharp.at(x, 3).hitCount, x < 8 ? 0u : 256u) << x;
        const bool touched = x >= 5 && x < 11;
        EXPECT_EQ(hits > 0 && hits < 256, touched) << x;
    }
}

/// The variance of a filter of radius 1, by hand.
double filterVariance(PixelFilter filter) {
    switch (filter) {
    case PixelFilter::box: return 1.0 / 3.0;
    case PixelFilter::triangle: return 1.0 / 6.0;
    case PixelFilter::gaussian: { // cut at three standard deviations
        const double density = std::exp(-4.5) / std::sqrt(2.0 * kPi), mass = std::erf(3.0 / std::sqrt(2.0));
        return (1.0 - 6.0 * density / mass) / 9.0;
    }
    case PixelFilter::blackmanHarris: { // the integral of x^2 cos(k pi x) over [-1, 1] is 4 (-1)^k / (k pi)^2
        const auto moment = [](double k) { return 4.0 / (k * k * kPi * kPi); };
        const double sum = 0.35875 * 2.0 / 3.0 - 0.48829 * moment(1) + 0.14128 * moment(2) - 0.01168 * moment(3);
        return sum / (2.0 * 0.35875);
    }
    }
    return 0.0;
}

template <typename Real> class ReferenceFilter : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceFilter, RealTypes);

TYPED_TEST(ReferenceFilter, SpreadsSamplesWithTheVarianceOfTheFilter) {
    using Real = TypeParam;
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.ymag = 8.0; // a pixel is a unit, and the centre of pixel (8, 8) is at (0.5, -0.5)
    for (const PixelFilter filter :
         {PixelFilter::box, PixelFilter::triangle, PixelFilter::gaussian, PixelFilter::blackmanHarris}) {
        RenderSettings settings;
        settings.width = settings.height = 16;
        settings.filter = {filter, filter == PixelFilter::box ? 0.5 : 2.0};
        const double radius = settings.filter.radius;
        const CameraRays<Real> rays(camera, settings);
        constexpr std::uint32_t kSteps = 1u << 14;
        double mean = 0.0, square = 0.0;
        for (std::uint32_t i = 0; i < kSteps; ++i) {
            const std::uint32_t word = (2 * i + 1) << 17;
            const Vec3<Real> origin = rays.sample(8, 8, {word, ~word, 0, 0}).origin;
            const double x = static_cast<double>(origin.x) - 0.5, y = static_cast<double>(origin.y) + 0.5;
            ASSERT_LE(std::max(std::abs(x), std::abs(y)), radius);
            // Filters are symmetric, and downwards is the second axis: the complement of a word is at -x, upwards.
            ASSERT_NEAR(x, y, 3.0 * radius / kSteps + 1e-5 * radius) << word;
            mean += x / kSteps;
            square += x * x / kSteps;
        }
        // Each of the table's cells has the filter's mass between the filter's quantiles, so that cell [a, b] is wrong
        // by less than |b^2 - a^2| / 256: together by 2 r^2 / 256.
        EXPECT_NEAR(square, filterVariance(filter) * radius * radius, 2.0 * radius * radius / 256.0);
        EXPECT_NEAR(mean, 0.0, 1e-5 * radius);
    }
}

TYPED_TEST(ReferenceFilter, IsLinearWithinTheCellsOfItsTable) {
    using Real = TypeParam;
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.ymag = 8.0;
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.filter = {PixelFilter::triangle, 1.0};
    const CameraRays<Real> rays(camera, settings);
    const FilterTable table = buildFilterTable(settings.filter);
    for (const std::uint32_t cell : {0u, 1u, 100u, 128u, 255u})
        for (const double fraction : {0.0, 0.25, 0.75}) {
            const std::uint32_t word = wordOf((cell + fraction) / kFilterCells);
            const double low = table.quantiles[cell], high = table.quantiles[cell + 1];
            const double x = static_cast<double>(rays.sample(8, 8, {word, 0, 0, 0}).origin.x) - 0.5;
            EXPECT_NEAR(x, low + fraction * (high - low), 16.0 * roundingBound<Real>(8)) << cell << ' ' << fraction;
        }
}

} // namespace
} // namespace isolux
