// What the integrators of the CPU reference measure, and which bounces they count.
#include "core/error.h"
#include "reference/ray_caster.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

/// 4 x 2 units by an orthographic camera at z = 1: a tilted wall at depth 4 on the right of x = 0, nothing on the left.
Scene tiltedWall() {
    SceneBuilder builder;
    builder.scene.materials[0].baseColor = {0.25, 0.5, 0.75};
    Mesh mesh = squareMesh(0);
    mesh.normals.assign(4, Vec3f(3, 0, 4));
    builder.mesh(mesh, translation({4, 0, -3}) * scaling(Vec3d(4.0)));
    builder.scene.environment.radiance = Vec3d(7.0);
    builder.scene.cameras.emplace_back();
    builder.scene.cameras[0].projection = Projection::orthographic;
    builder.scene.cameras[0].position = {0, 0, 1};
    return builder.scene;
}

Film measure(const Scene& scene, Integrator integrator, Precision precision = Precision::doublePrecision) {
    RenderSettings settings = smallSettings(8);
    settings.integrator = integrator;
    return render(scene, settings, {.precision = precision, .signatures = PathSignatures::on, .aovs = Aovs::on});
}

TEST(ReferenceIntegrators, FirstHitsHaveTheirWrittenValues) {
    const std::array<std::pair<Integrator, Vec3d>, 3> expected = {{{Integrator::normals, {0.8, 0.5, 0.9}},
                                                                   {Integrator::albedo, {0.25, 0.5, 0.75}},
                                                                   {Integrator::depth, Vec3d(4.0)}}};
    for (const auto& [integrator, value] : expected) {
        const Film film = measure(tiltedWall(), integrator);
        for (std::uint32_t x = 0; x < film.width; ++x) {
            const bool onWall = x >= film.width / 2;
            const Vec3d difference = film.at(x, 5).mean - (onWall ? value : Vec3d(0.0));
            // Normals are stored in float; the rest is a handful of roundings.
            EXPECT_NEAR(glm::length(difference), 0.0, roundingBound<float>(8)) << "neither lights nor environment";
            EXPECT_EQ(film.at(x, 5).hitCount, onWall ? 8u : 0u);
        }
    }
}

TEST(ReferenceIntegrators, ALoneWallIsOpen) {
    Scene scene = tiltedWall();
    // Directions behind the wall, which the tilted normals let in, count as blocked without a ray.
    const Film tilted = measure(scene, Integrator::ao);
    EXPECT_LT(tilted.rays, 2 * 8u * tilted.pixels.size());
    scene.meshes[0].normals.clear();
    const Film flat = measure(scene, Integrator::ao);
    for (std::uint32_t x = 0; x < flat.width; ++x) EXPECT_EQ(flat.at(x, 5).mean, Vec3d(x < flat.width / 2 ? 0.0 : 1.0));
}

TEST(ReferenceIntegrators, FirstHitsAreThoseOfTheLayers) {
    for (const Precision precision : {Precision::doublePrecision, Precision::singlePrecision}) {
        const Film paths = measure(smallRoom(), Integrator::path, precision);
        const Film normals = measure(smallRoom(), Integrator::normals, precision);
        const Film albedo = measure(smallRoom(), Integrator::albedo, precision);
        const Film depth = measure(smallRoom(), Integrator::depth, precision);
        EXPECT_EQ(depth.rays, 8u * depth.pixels.size()) << "camera rays alone";
        for (std::size_t i = 0; i < paths.pixels.size(); ++i) {
            ASSERT_EQ(paths.aovs[i], normals.aovs[i]);
            const PixelAovs& aovs = paths.aovs[i];
            const auto hits = static_cast<double>(aovs.hitCount());
            // Values of at most 10, eight of them, by some ten roundings each.
            const double tolerance =
                8.0 * 10.0 *
                (precision == Precision::doublePrecision ? roundingBound<double>(10) : roundingBound<float>(10));
            ASSERT_NEAR(glm::length(normals.pixels[i].mean * 8.0 - (aovs.normal + hits) / 2.0), 0.0, tolerance);
            ASSERT_NEAR(glm::length(albedo.pixels[i].mean * 8.0 - aovs.albedo), 0.0, tolerance);
            ASSERT_NEAR(depth.pixels[i].mean.y * 8.0, aovs.depth, tolerance);
        }
    }
}

TEST(ReferenceIntegrators, FirstHitsTakeOneWordOfSignatureAndAmbientRaysAnother) {
    Scene scene = tiltedWall();
    scene.meshes[0].normals.clear();
    const std::uint32_t start = 2166136261u;
    const auto with = [](std::uint32_t h, std::uint32_t word) { return (h ^ word) * 16777619u; };
    for (const Integrator integrator : {Integrator::normals, Integrator::albedo, Integrator::depth, Integrator::ao}) {
        const Film film = measure(scene, integrator);
        const std::uint32_t onWall = with(start, 1); // upper left: the square's second triangle
        EXPECT_EQ(film.at(2, 5).pathSignature, 8u * with(start, kNoPrimitive));
        EXPECT_EQ(film.at(13, 1).pathSignature, 8u * (integrator == Integrator::ao ? with(onWall, 1) : onWall));
    }
}

/// Ambient occlusion of the world's origin on a floor, and its standard error.
struct Openness {
    double value;
    double error;
};
Openness opennessUnder(const Mat4d& ceiling, double distance) {
    SceneBuilder builder;
    builder.mesh(squareMesh(0), scaling({100.0, 100.0, 1.0}));
    builder.mesh(squareMesh(0), ceiling);
    builder.camera({3.0, 0.0, 0.2}, Vec3d(0.0), 1e-6);
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.sampleCount = 100;
    settings.integrator = Integrator::ao;
    settings.ambientDistance = distance;
    PixelStatistics total;
    for (const PixelStatistics& pixel : render(builder.scene, settings).pixels) total.merge(pixel);
    return {total.mean.x, std::sqrt(total.luminanceVariance() / static_cast<double>(total.sampleCount))};
}

TEST(ReferenceIntegrators, AmbientOcclusionHasItsAnalyticValues) {
    constexpr double kSigmas = 4.5; // two comparisons, each a false alarm in 1e5
    // A square [-1, 1]^2 at height 1: four times configuration B-4 of Howell's catalogue.
    const double root = std::sqrt(2.0);
    const double formFactor = 4.0 / kPi * (1.0 / root) * std::atan(1.0 / root);
    const Openness square = opennessUnder(translation({0, 0, 1}), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(square.value, 1.0 - formFactor, kSigmas * square.error);
    // A ceiling without end at height 1 is nearer than D where cos > 1/D: a share of 1 - 1/D^2 of cosine-distributed
    // directions.
    const Mat4d endless = translation({0, 0, 1}) * scaling({1000.0, 1000.0, 1.0});
    const Openness cap = opennessUnder(endless, 2.0);
    EXPECT_NEAR(cap.value, 0.25, kSigmas * cap.error);
    EXPECT_LT(cap.error, 0.003);
    EXPECT_EQ(opennessUnder(endless, 0.999).value, 1.0);
    EXPECT_EQ(opennessUnder(endless, 100.0).value, opennessUnder(endless, 99.0).value) << "all but some 1e-4 blocked";
}

RenderSettings withoutRoulette(std::uint32_t maxDepth) {
    RenderSettings settings = smallSettings(8);
    settings.roulette.kind = Roulette::off;
    settings.maxDepth = maxDepth;
    return settings;
}

/// The same terms added in another order. None is negative, so no sample exceeds the sum of all eight; each of eight
/// steps of the mean rounds four times, each path adds up to some twelve terms, and the parts are added at last.
void expectSameSum(const std::vector<Film>& parts, const Film& whole) {
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
        Vec3d sum(0.0);
        for (const Film& part : parts) sum += part.pixels[i].mean;
        const Vec3d& expected = whole.pixels[i].mean;
        for (int channel = 0; channel < 3; ++channel)
            ASSERT_NEAR(sum[channel], expected[channel], 8.0 * roundingBound<double>(64) * expected[channel]);
    }
}

TEST(ReferenceBounces, AloneTheyAddUpToAllOfThem) {
    for (const LightSampling sampling :
         {LightSampling::hemisphere, LightSampling::bsdf, LightSampling::light, LightSampling::mis}) {
        RenderSettings settings = withoutRoulette(5);
        settings.lightSampling = sampling;
        const Film whole = render(smallRoom(), settings);
        settings.bounces = BounceSelection::last;
        std::vector<Film> parts;
        for (settings.maxDepth = 0; settings.maxDepth <= 5; ++settings.maxDepth)
            parts.push_back(render(smallRoom(), settings));
        expectSameSum(parts, whole);
        EXPECT_LE(parts[5].rays, whole.rays) << "no shadow rays before the last bounce";
    }
}

TEST(ReferenceBounces, DirectAndIndirectAddUpToAll) {
    RenderSettings settings = smallSettings(8);
    settings.lightSamples = 2;
    const Film all = render(smallRoom(), settings);
    settings.light = LightPart::indirect;
    const Film indirect = render(smallRoom(), settings);
    settings.light = LightPart::direct;
    const Film direct = render(smallRoom(), settings);
    expectSameSum({direct, indirect}, all);
    settings.light = LightPart::all;
    settings.integrator = Integrator::direct;
    EXPECT_EQ(render(smallRoom(), settings).pixels, direct.pixels);
    settings.integrator = Integrator::path;
    settings.maxDepth = 1;
    EXPECT_EQ(render(smallRoom(), settings).pixels, direct.pixels);
    settings.light = LightPart::indirect;
    for (const PixelStatistics& pixel : render(smallRoom(), settings).pixels) ASSERT_EQ(pixel.mean, Vec3d(0.0));
}

TEST(ReferenceBounces, NoLightIsSampledBeforeTheFirstThatCounts) {
    SceneBuilder builder;
    builder.mesh(squareMesh(builder.material(Vec3d(0.5), Vec3d(1.0), Faces::front)));
    builder.camera({0.5, -0.25, 3}, {0.5, -0.25, 0}, 0.01);
    const auto hash = [](std::initializer_list<std::uint32_t> words) {
        std::uint32_t h = 2166136261u;
        for (const std::uint32_t word : words) h = (h ^ word) * 16777619u;
        return h;
    };
    RenderSettings settings = smallSettings(1);
    const ReferenceOptions on{.signatures = PathSignatures::on};
    settings.maxDepth = 2;
    EXPECT_EQ(render(builder.scene, settings, on).at(3, 3).pathSignature, hash({0, 2, kNoPrimitive}));
    settings.lightSamples = 3; // each triangle in the other's plane: no ray
    EXPECT_EQ(render(builder.scene, settings, on).at(3, 3).pathSignature, hash({0, 2, 2, 2, kNoPrimitive}));
    settings.lightChoice = LightChoice::all;
    EXPECT_EQ(render(builder.scene, settings, on).at(3, 3).pathSignature, hash({0, 2, 2, 2, 2, 2, 2, kNoPrimitive}));
    settings.bounces = BounceSelection::last;
    const Film film = render(builder.scene, settings, on);
    EXPECT_EQ(film.at(3, 3).pathSignature, hash({0, kNoPrimitive}));
    EXPECT_EQ(film.at(3, 3).mean, Vec3d(0.0)) << "it is seen emitting, which is no second bounce";
}

TEST(ReferenceBounces, EndlessPathsAreRefused) {
    RenderSettings settings = withoutRoulette(kUnlimitedDepth);
    EXPECT_THROW((void)render(smallRoom(), settings), Error);
    settings.integrator = Integrator::direct;
    EXPECT_NO_THROW((void)render(smallRoom(), settings));
}

} // namespace
} // namespace isolux
