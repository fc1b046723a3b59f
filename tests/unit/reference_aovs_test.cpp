// What camera rays meet first: albedo, normal, depth and object of known scenes.
#include "reference/reference.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

namespace isolux {
namespace {

using namespace test;

constexpr std::uint32_t kSamples = 8;

RenderSettings aovSettings() {
    RenderSettings settings;
    settings.width = 16;
    settings.height = 8;
    settings.sampleCount = kSamples;
    settings.maxDepth = 2;
    return settings;
}

/// Looks along -z from z = 1; the orthographic one shows [-2, 2] x [-1, 1].
Camera cameraOf(Projection projection) {
    Camera camera;
    camera.projection = projection;
    camera.position = {0, 0, 1};
    camera.yfov = 2.0 * std::atan(0.25);
    camera.ymag = 1.0;
    return camera;
}

/// Left of x = 0 a wall at z = -3 that shows its back, right of it one at z = -5; two instances of one mesh.
Scene twoWalls(Projection projection) {
    SceneBuilder builder;
    builder.scene.materials[0].baseColor = {0.25, 0.5, 0.75};
    builder.scene.materials[0].emission = Vec3d(1.0);
    builder.mesh(squareMesh(0), translation({-8, 0, -3}) * scaling({8, -8, -1}));
    builder.scene.instances.push_back({"", 0, translation({8, 0, -5}) * scaling({8, 8, 1})});
    builder.scene.cameras = {cameraOf(projection)};
    return builder.scene;
}

Film renderAovs(const Scene& scene, const RenderSettings& settings, Precision precision = Precision::doublePrecision) {
    return renderReference(scene, settings, {.precision = precision, .aovs = Aovs::on}, {});
}

TEST(ReferenceAovs, ColourNormalDepthAndObjectOfTwoWalls) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const Film film = renderAovs(twoWalls(projection), aovSettings());
        ASSERT_EQ(film.aovs.size(), film.pixels.size());
        for (std::uint32_t y = 0; y < 8; ++y)
            for (std::uint32_t x = 0; x < 16; ++x) {
                const PixelAovs& aovs = film.aovs[16 * y + x];
                const bool left = x < 8;
                ASSERT_EQ(aovs.objects, (std::vector<PixelAovs::Coverage>{{left ? 0u : 1u, kSamples}}));
                ASSERT_EQ(aovs.albedo, Vec3d(0.25, 0.5, 0.75) * double(kSamples)) << "base colour, though it emits";
                ASSERT_EQ(aovs.normal, Vec3d(0, 0, kSamples)) << "of front and back alike";
                // Of a point of a few units' size, by some ten roundings; along the axis, whatever the ray's slope.
                ASSERT_NEAR(aovs.depth / kSamples, left ? 4.0 : 6.0, 10.0 * roundingBound<double>(10)) << x << ' ' << y;
                ASSERT_EQ(film.at(x, y).hitCount, kSamples);
            }
    }
}

TEST(ReferenceAovs, EdgesCountEachObjectAndMisses) {
    // The orthographic image's columns are 0.25 wide: a strip from x = 0.125 covers half of column 8 and all of 9.
    SceneBuilder builder;
    builder.mesh(squareMesh(0), translation({0.3125, 0, 0}) * scaling({0.1875, 2, 1}));
    builder.scene.spheres.push_back({"", {-1.5, 0, -2}, 0.5, 0});
    builder.scene.cameras = {cameraOf(Projection::orthographic)};
    RenderSettings settings = aovSettings();
    settings.sampleCount = 400;
    const Film film = renderAovs(builder.scene, settings);
    for (std::uint32_t y = 0; y < 8; ++y) {
        const PixelAovs& edge = film.aovs[16 * y + 8];
        ASSERT_EQ(edge.objects.size(), 1u);
        EXPECT_EQ(edge.objects[0].object, 0u);
        EXPECT_NEAR(static_cast<double>(edge.objects[0].samples), 200.0, 5.0 * std::sqrt(400.0 * 0.25));
        EXPECT_EQ(edge.hitCount(), film.at(8, y).hitCount) << "no environment: met is hit";
        EXPECT_EQ(edge.albedo, Vec3d(1.0) * static_cast<double>(edge.hitCount()));
        EXPECT_EQ(film.aovs[16 * y + 9].hitCount(), 400u);
        EXPECT_EQ(film.aovs[16 * y + 6], PixelAovs{});
    }
    std::uint64_t onSphere = 0;
    for (const PixelAovs& aovs : film.aovs)
        for (const PixelAovs::Coverage& coverage : aovs.objects)
            if (coverage.object == 1) onSphere += coverage.samples;
    // A disc of radius 1/2 in an image of 4 x 2, in 16 x 8 x 400 samples.
    const double share = kPi * 0.25 / 8.0, count = 16.0 * 8.0 * 400.0;
    EXPECT_NEAR(static_cast<double>(onSphere), share * count, 5.0 * std::sqrt(share * (1.0 - share) * count));
}

TEST(ReferenceAovs, SphereNormalsFaceTheCameraFromInsideToo) {
    for (const double z : {-4.0, 1.0}) { // before the camera, and around it
        SceneBuilder builder;
        builder.scene.spheres.push_back({"", {0, 0, z}, 3.0, 0});
        builder.scene.cameras = {cameraOf(Projection::perspective)};
        RenderSettings settings = aovSettings();
        settings.sampleCount = 1;
        const Film film = renderAovs(builder.scene, settings);
        for (const PixelAovs& aovs : film.aovs) {
            ASSERT_EQ(aovs.hitCount(), 1u);
            ASSERT_NEAR(glm::length(aovs.normal), 1.0, roundingBound<double>(16));
            ASSERT_GT(aovs.normal.z, 0.0);
        }
    }
}

TEST(ReferenceAovs, NormalsAreTheShadingNormals) {
    SceneBuilder builder;
    Mesh mesh = squareMesh(0);
    mesh.normals.assign(4, glm::normalize(Vec3f(3, 0, 4)));
    builder.mesh(mesh, scaling(Vec3d(8.0)));
    builder.scene.cameras = {cameraOf(Projection::orthographic)};
    RenderSettings settings = aovSettings();
    settings.sampleCount = 1;
    for (const PixelAovs& aovs : renderAovs(builder.scene, settings).aovs)
        ASSERT_NEAR(glm::length(aovs.normal - Vec3d(0.6, 0.0, 0.8)), 0.0, 2.0 * roundingBound<float>(3));
}

TEST(ReferenceAovs, ComeOnlyWhenAskedForAndChangeNothing) {
    const Scene scene = twoWalls(Projection::perspective);
    const Film without = renderReference(scene, aovSettings(), {}, {});
    EXPECT_TRUE(without.aovs.empty());
    EXPECT_EQ(without.pixels, renderAovs(scene, aovSettings()).pixels);
}

TEST(ReferenceAovs, DoNotDependOnThreadsAndRegions) {
    const Scene scene = twoWalls(Projection::perspective);
    for (const Precision precision : {Precision::singlePrecision, Precision::doublePrecision}) {
        const Film film = renderAovs(scene, aovSettings(), precision);
        const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(film.aovs, renderAovs(scene, aovSettings(), precision).aovs);
        const ReferenceOptions options{.precision = precision, .aovs = Aovs::on};
        const Film part = renderReferenceRegion(scene, aovSettings(), options, {6, 2, 4, 3}, {});
        for (std::uint32_t y = 0; y < 3; ++y)
            for (std::uint32_t x = 0; x < 4; ++x)
                EXPECT_EQ(part.aovs[4 * y + x], film.aovs[std::size_t{16} * (2 + y) + 6 + x]);
    }
}

} // namespace
} // namespace isolux
