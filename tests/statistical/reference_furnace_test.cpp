// The CPU reference against radiance known in closed form. Every check is an interval made from the film's own
// variance, together with a limit on how wide that may be.
#include "statistical/reference_estimates.h"

namespace isolux {
namespace {

using namespace test;

/// Late roulette: most of the variance of a furnace is roulette's, so a tight interval costs least without.
RenderSettings lateRoulette(std::uint32_t samples) {
    RenderSettings settings = squareImage(16, samples);
    settings.roulette.start = 24;
    return settings;
}

TEST(ReferenceFurnace, BoxHasTheRadianceOfTheSeries) {
    expectRadiance(renderTotal(furnaceBox(Mat4d(1.0)), lateRoulette(800)), kFurnace, 0.0015);
}

TEST(ReferenceFurnace, MirroredShearedBoxFarAwayInFloat) {
    Mat4d place = translation({300.0, -20.0, 55.0}) * scaling({-3.0, 1.0, 2.0});
    place[1] += place[0] * 0.3;
    expectRadiance(renderTotal(furnaceBox(place), lateRoulette(800), Precision::singlePrecision), kFurnace, 0.0015);
}

TEST(ReferenceFurnace, DepthCutsTheSeries) {
    RenderSettings settings = squareImage(16, 1000);
    for (const std::uint32_t depth : {0u, 1u, 2u, 5u}) {
        settings.maxDepth = depth;
        const Vec3d rest = glm::pow(kAlbedo, Vec3d(depth + 1.0));
        expectRadiance(renderTotal(furnaceBox(Mat4d(1.0)), settings), kFurnace * (1.0 - rest), 0.003);
    }
}

TEST(ReferenceFurnace, RouletteDoesNotChangeTheMean) {
    RenderSettings settings = squareImage(16, 1000);
    settings.roulette.start = 1;
    const PixelStatistics early = renderTotal(furnaceBox(Mat4d(1.0)), settings);
    settings.roulette.start = 60; // 0.8^60 = 1.5e-6 of the energy
    settings.sampleCount = 300;
    const PixelStatistics late = renderTotal(furnaceBox(Mat4d(1.0)), settings);
    expectRadiance(early, kFurnace, 0.005);
    expectRadiance(late, kFurnace, 0.005);
    for (int channel = 0; channel < 3; ++channel) {
        const double interval = kSigmas * std::hypot(standardError(early, channel), standardError(late, channel));
        EXPECT_NEAR(early.mean[channel], late.mean[channel], interval);
    }
}

TEST(ReferenceFurnace, InsideADoubleSidedSphereLight) {
    for (const Precision precision : {Precision::doublePrecision, Precision::singlePrecision}) {
        SceneBuilder builder;
        builder.scene.spheres.push_back({"", {5.0, -2.0, 1.0}, 3.0, builder.material(kAlbedo, kEmission, Faces::both)});
        builder.camera({6.0, -2.5, 1.5}, {5.0, -2.0, 1.0}, 1.2);
        expectRadiance(renderTotal(builder.scene, squareImage(16, 2000), precision), kFurnace, 0.003);
    }
}

/// Form factor from a point to the square [-a, a]^2 at height h above it (Howell, configuration B-4, four times).
double squareFormFactor(double a, double h) {
    const double x = a / h;
    const double r = std::sqrt(1.0 + x * x);
    return 4.0 / (2.0 * kPi) * 2.0 * (x / r) * std::atan(x / r);
}

TEST(ReferenceDirectLight, FloorUnderASquare) {
    const Vec3d albedo(0.3, 0.6, 0.9), emission(10.0, 5.0, 1.0);
    for (const double halfSize : {0.01, 0.5, 3.0}) {
        SceneBuilder builder = floorSeenFromTheSide(albedo);
        builder.mesh(squareMesh(builder.material(Vec3d(0.5), emission, Faces::front)),
                     translation({0, 0, 1}) * scaling({halfSize, -halfSize, -1.0}));
        const Vec3d expected = albedo * emission * squareFormFactor(halfSize, 1.0);
        expectRadiance(renderTotal(builder.scene, onePoint(20000)), expected, 0.004);
    }
}

TEST(ReferenceDirectLight, FloorUnderASphere) {
    const Vec3d albedo(0.3, 0.6, 0.9), emission(10.0, 5.0, 1.0);
    for (const double ratio : {1e-5, 0.1, 0.5, 0.99}) { // radius over the height of the centre
        SceneBuilder builder = floorSeenFromTheSide(albedo);
        builder.scene.spheres.push_back(
            {"", {0, 0, 2}, 2.0 * ratio, builder.material(Vec3d(0.5), emission, Faces::front)});
        expectRadiance(renderTotal(builder.scene, onePoint(20000)), albedo * emission * (ratio * ratio), 0.004);
    }
}

TEST(ReferenceDirectLight, LightsAddUpAndBlockersShadow) {
    const Vec3d albedo(0.5);
    SceneBuilder builder = floorSeenFromTheSide(albedo);
    const std::uint32_t dim = builder.material(Vec3d(0.0), Vec3d(1.0, 2.0, 3.0), Faces::front);
    const std::uint32_t bright = builder.material(Vec3d(0.0), Vec3d(100.0), Faces::front);
    const std::uint32_t hidden = builder.material(Vec3d(0.0), Vec3d(2.0), Faces::front);
    builder.scene.spheres = {{"", {0, 0, 4}, 1.0, hidden}, {"", {0, 3, 3}, 0.5, dim}, {"", {0, -3, 3}, 0.2, bright}};
    builder.mesh(squareMesh(0), translation({0, 0, 1.5}) * scaling(Vec3d(0.9, 0.9, 1.0))); // hides the first alone
    // For a sphere wholly above the horizon the form factor is (r/d)^2 cos(angle of the centre).
    const double cosine = std::sqrt(0.5);
    const Vec3d dimLight = Vec3d(1.0, 2.0, 3.0) * (0.25 / 18.0 * cosine);
    const Vec3d brightLight = Vec3d(100.0) * (0.04 / 18.0 * cosine);
    expectRadiance(renderTotal(builder.scene, onePoint(40000)), albedo * (dimLight + brightLight), 0.008);
}

} // namespace
} // namespace isolux
