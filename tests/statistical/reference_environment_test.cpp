// Surfaces under an environment and among lights of every kind, against radiance known in closed form.
#include "statistical/reference_estimates.h"

namespace isolux {
namespace {

using namespace test;

const Vec3d kAlbedo(0.2, 0.5, 0.8);
const Vec3d kSky(3.0, 0.5, 1.0);

/// A body in a uniform environment, framed with room around it.
Scene inTheOpen(SceneBuilder builder) {
    builder.scene.materials[0].baseColor = kAlbedo;
    builder.scene.environment.radiance = kSky;
    builder.camera({3.0, 2.0, 4.0}, Vec3d(0.0), 0.7);
    return builder.scene;
}

/// How far a pixel's mean lies from `expected`, squared and in units of its variance.
double squaredDistance(const PixelStatistics& pixel, const Vec3d& expected) {
    const double error = luminance(pixel.mean - expected);
    return error * error * static_cast<double>(pixel.sampleCount) / pixel.luminanceVariance();
}

/// A convex body meets none of its own light: it shows albedo * environment wherever it is seen, and nothing else does.
void expectConvexFurnace(const Scene& scene, const ReferenceOptions& options) {
    RenderSettings settings = squareImage(32, 800);
    settings.seed = 11;
    const Film film = renderReference(scene, settings, options, {});
    EXPECT_TRUE(film.diagnostics.clean());
    PixelStatistics body;
    int covered = 0, empty = 0;
    double distances = 0.0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const std::uint64_t hits = film.aovs[i].hitCount();
        if (hits == 0) {
            ++empty;
            ASSERT_EQ(film.pixels[i].mean, options.precision == Precision::doublePrecision ? kSky : Vec3d(Vec3f(kSky)));
        }
        if (hits != settings.sampleCount) continue;
        ++covered;
        body.merge(film.pixels[i]);
        distances += squaredDistance(film.pixels[i], kAlbedo * kSky);
    }
    EXPECT_GT(covered, 150);
    EXPECT_GT(empty, 150);
    expectRadiance(body, kAlbedo * kSky, 0.004);
    // Mean of `covered` squares of standard normals, variance 2 each (4 with room for the skewness of 800 samples).
    EXPECT_NEAR(distances / covered, 1.0, kSigmas * std::sqrt(4.0 / covered));
}

TEST(ReferenceEnvironment, AConvexBodyShowsItsAlbedo) {
    for (const Precision precision : {Precision::doublePrecision, Precision::singlePrecision}) {
        const ReferenceOptions options{.precision = precision, .aovs = Aovs::on};
        SceneBuilder ball;
        ball.scene.spheres.push_back({"", Vec3d(0.0), 1.0, 0});
        expectConvexFurnace(inTheOpen(ball), options);
        SceneBuilder polyhedron;
        polyhedron.mesh(icosahedron(), scaling(Vec3d(0.6)));
        expectConvexFurnace(inTheOpen(polyhedron), options);
    }
}

TEST(ReferenceEnvironment, DepthZeroLeavesTheBodyBlack) {
    SceneBuilder ball;
    ball.scene.spheres.push_back({"", Vec3d(0.0), 1.0, 0});
    RenderSettings settings = squareImage(16, 4);
    settings.maxDepth = 0;
    const Film film = renderReference(inTheOpen(ball), settings, {}, {});
    EXPECT_EQ(film.at(8, 8).mean, Vec3d(0.0));
    EXPECT_EQ(film.at(0, 0).mean, kSky);
}

/// A square of edge 2 with the normal `up`, seen along it, under the upper half of the sky.
PixelStatistics underTheUpperHalf(const Mat4d& worldFromSquare) {
    SceneBuilder builder;
    builder.scene.materials[0].baseColor = kAlbedo;
    builder.scene.environment = {kSky, EnvironmentExtent::upperHalf};
    builder.mesh(squareMesh(0), worldFromSquare);
    builder.camera(Vec3d(worldFromSquare[2]) * 3.0, Vec3d(0.0), 0.1);
    return renderTotal(builder.scene, squareImage(8, 8000));
}

Mat4d squareFacing(const Vec3d& normal) {
    const Frame<double> frame = frameAbout(normal);
    Mat4d matrix(1.0);
    matrix[0] = glm::dvec4(frame.t, 0.0);
    matrix[1] = glm::dvec4(frame.s, 0.0);
    matrix[2] = glm::dvec4(frame.n, 0.0);
    return matrix;
}

TEST(ReferenceEnvironment, AnUpperHalfLightsFloorsInFullAndWallsByHalf) {
    expectRadiance(underTheUpperHalf(squareFacing({0, 1, 0})), kAlbedo * kSky, 0.006);
    expectRadiance(underTheUpperHalf(squareFacing({1, 0, 0})), kAlbedo * kSky * 0.5, 0.01);
    // A plane tilted by theta sees (1 + cos theta) / 2 of the cosine-weighted upper half.
    expectRadiance(underTheUpperHalf(squareFacing({0, 0.6, -0.8})), kAlbedo * kSky * 0.8, 0.008);
    EXPECT_EQ(underTheUpperHalf(squareFacing({0, -1, 0})).mean, Vec3d(0.0));
}

TEST(ReferenceEnvironment, InterreflectionUnderAnOpenSkyConverges) {
    // Albedo a, emission (1 - a) L and a sky of L show L everywhere, whatever the shapes.
    SceneBuilder builder;
    builder.scene.materials[0] = {"", kAlbedo, (1.0 - kAlbedo) * 2.0, true};
    builder.mesh(icosahedron(), scaling(Vec3d(0.5)));
    builder.mesh(squareMesh(0), translation({0, 0, -1}) * scaling(Vec3d(2.0)));
    builder.scene.spheres.push_back({"", {0.9, 0.3, 0.2}, 0.4, 0});
    builder.scene.environment.radiance = Vec3d(2.0);
    builder.camera({3.0, 2.0, 4.0}, Vec3d(0.0), 0.7);
    for (const Precision precision : {Precision::doublePrecision, Precision::singlePrecision})
        expectRadiance(renderTotal(builder.scene, squareImage(16, 800), precision), Vec3d(2.0), 0.0015);
}

PunctualLight punctual(PunctualKind kind, const Vec3d& position, const Vec3d& intensity) {
    PunctualLight light;
    light.kind = kind;
    light.position = position;
    light.direction = glm::normalize(-position);
    light.intensity = intensity;
    light.cosInner = 0.9;
    light.cosOuter = 0.8;
    return light;
}

/// Radiance of the floor at the origin by one light at `position` that shines on it in full.
Vec3d reflected(const Vec3d& albedo, const PunctualLight& light) {
    const double distance = glm::length(light.position);
    const double falloff = light.kind == PunctualKind::directional ? 1.0 : distance * distance;
    return albedo / kPi * light.intensity * (light.position.z / distance / falloff);
}

TEST(ReferenceDirectLight, LightsOfEveryKindAddUp) {
    const Vec3d albedo(0.3, 0.6, 0.9);
    for (const Precision precision : {Precision::doublePrecision, Precision::singlePrecision}) {
        SceneBuilder builder = floorSeenFromTheSide(albedo);
        // Small, or the disc that lights from afar illuminate would leave hardly a sample to the others.
        builder.scene.instances[0].worldFromObject = translation({0.3, 0.0, 0.0});
        builder.scene.spheres.push_back(
            {"", {0, 0, 4}, 1.0, builder.material(Vec3d(0.0), Vec3d(8.0, 4.0, 2.0), Faces::front)});
        Vec3d expected = albedo * Vec3d(8.0, 4.0, 2.0) / 16.0; // (r/d)^2
        builder.scene.punctualLights = {punctual(PunctualKind::point, {0, 3, 1}, {5, 0, 0}),
                                        punctual(PunctualKind::point, {1, 1, 2}, {1, 2, 3}),
                                        punctual(PunctualKind::spot, {-2, 1, 2}, {9, 9, 1}),
                                        punctual(PunctualKind::directional, {2, -2, 1}, Vec3d(0.01))};
        for (const PunctualLight& light : builder.scene.punctualLights) expected += reflected(albedo, light);
        builder.scene.environment.radiance = Vec3d(0.0, 0.01, 0.02);
        // The environment is seen but where the lamp covers it: 1 - (r/d)^2 of the cosine-weighted hemisphere.
        expected += albedo * builder.scene.environment.radiance * (1.0 - 1.0 / 16.0);
        expectRadiance(renderTotal(builder.scene, onePoint(40000), precision), expected, 0.008);
    }
}

} // namespace
} // namespace isolux
