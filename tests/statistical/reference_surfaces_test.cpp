// Surfaces that are not Lambertian, seen in scenes whose radiance is known: glass, absorption, coverage, emission maps,
// what a white furnace loses; and every way to find light, which must not change the mean.
#include "statistical/reference_estimates.h"

#include "core/srgb.h"
#include "reference/fresnel.h"

#include <array>
#include <string>
#include <vector>

namespace isolux {
namespace {

using namespace test;

Material whiteGlass(double roughness, double thickness) {
    Material material;
    material.specular = 1.0;
    material.transmission = 1.0;
    material.roughness = roughness;
    material.thickness = thickness;
    return material;
}

/// A sphere of the material in a world of radiance 1, filling the image.
SceneBuilder sphereInFurnace(const Material& material) {
    SceneBuilder builder;
    builder.scene.materials[0] = material;
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.scene.spheres = {{"", Vec3d(0.0), 1.0, 0}};
    builder.camera({0, 0, 10}, Vec3d(0.0), 0.14); // within the sphere
    return builder;
}

RenderSettings longPaths(std::uint32_t samples) {
    RenderSettings settings = squareImage(16, samples);
    settings.roulette.start = 8;
    return settings;
}

/// Compensated from tables of albedos, which hold 0.5 %.
TEST(ReferenceSurfaces, WhiteSpheresVanishInAWhiteFurnace) {
    Material metal;
    metal.metallic = 1.0;
    Material coated;
    coated.specular = 1.0;
    for (const double roughness : {0.0, 0.3, 0.6, 1.0}) {
        SCOPED_TRACE(roughness);
        // The rougher, the more samples are lost between microfacets and made up for by the others.
        const std::uint32_t samples = roughness < 0.5 ? 300 : roughness < 1.0 ? 1500 : 5000;
        for (Material material : {metal, coated, whiteGlass(roughness, 0.0), whiteGlass(roughness, 1.0)}) {
            SCOPED_TRACE(material.thickness);
            material.roughness = roughness;
            expectRadiance(renderTotal(sphereInFurnace(material).scene, longPaths(samples)), Vec3d(1.0), 0.005);
        }
    }
}

/// A plate of glass between z = -1 and 0 over an emitter, from above.
SceneBuilder plateOverLight(const Material& glass, const Vec3d& emission) {
    SceneBuilder builder;
    builder.scene.materials[0] = glass;
    const std::uint32_t light = builder.material(Vec3d(0.0), emission, Faces::front);
    builder.mesh(squareMesh(0), scaling({50.0, 50.0, 1.0}));
    Mesh back = squareMesh(0);
    for (auto& triangle : back.triangles) std::swap(triangle[1], triangle[2]);
    builder.mesh(back, translation({0, 0, -1}) * scaling({50.0, 50.0, 1.0}));
    builder.mesh(squareMesh(light), translation({0, 0, -2}) * scaling({500.0, 500.0, 1.0}));
    builder.camera({0, 0, 3}, Vec3d(0.0), 1e-4);
    return builder;
}

TEST(ReferenceSurfaces, PlateAbsorbsByItsThickness) {
    Material glass = whiteGlass(0.0, 1.0);
    glass.attenuationColor = {0.8, 0.3, 0.05};
    glass.attenuationDistance = 0.7;
    const double r = 0.04;
    for (const LightSampling sampling : {LightSampling::mis, LightSampling::light, LightSampling::hemisphere}) {
        RenderSettings settings = longPaths(200);
        settings.lightSampling = sampling;
        const Vec3d left = glm::pow(glass.attenuationColor, Vec3d(1.0 / 0.7));
        // All paths that bounce between the faces, of which every other one comes out above.
        const Vec3d expected = (1 - r) * (1 - r) * left / (1.0 - r * r * left * left);
        expectRadiance(renderTotal(plateOverLight(glass, Vec3d(1.0)).scene, settings), expected, 0.005);
    }
}

TEST(ReferenceSurfaces, ThinGlassPassesStraight) {
    Material glass = whiteGlass(0.0, 0.0);
    glass.baseColor = {0.9, 0.5, 0.2};
    SceneBuilder builder;
    builder.scene.materials[0] = glass;
    const std::uint32_t light = builder.material(Vec3d(0.0), Vec3d(1.0), Faces::front);
    builder.mesh(squareMesh(0), scaling({50.0, 50.0, 1.0}));
    builder.mesh(squareMesh(light), translation({-2.4, 0, -1.8}) * scaling({0.1, 0.1, 1.0})); // on the line of sight
    builder.camera({4, 0, 3}, Vec3d(0.0), 1e-4);
    const double through = 1.0 - dielectricFresnel(0.6, 1.5);
    expectRadiance(renderTotal(builder.scene, longPaths(100)), glass.baseColor * through, 0.005);
}

/// An emitter in glass under a face seen at an angle: radiance falls by the square of the index as it leaves.
TEST(ReferenceSurfaces, LightInsideGlassIsScaled) {
    for (const double roughness : {0.0, 0.4}) {
        SceneBuilder builder;
        builder.scene.materials[0] = whiteGlass(roughness, 1.0);
        const std::uint32_t light = builder.material(Vec3d(0.0), Vec3d(1.0), Faces::front);
        builder.mesh(squareMesh(0), scaling({50.0, 50.0, 1.0}));
        builder.mesh(squareMesh(light), translation({0, 0, -1e-3}) * scaling({50.0, 50.0, 1.0}));
        builder.camera({4, 0, 3}, Vec3d(0.0), 1e-4);
        RenderSettings settings = longPaths(400);
        settings.maxDepth = 1;
        const PixelStatistics total = renderTotal(builder.scene, settings);
        const double smooth = (1.0 - dielectricFresnel(0.6, 1.5)) / 2.25;
        // Roughness mixes Fresnel's values of a range of angles, no more.
        if (roughness == 0.0)
            expectRadiance(total, Vec3d(smooth), 0.005);
        else
            EXPECT_NEAR(total.mean.x, smooth, 0.03 * smooth);
    }
}

TextureImage checkerImage() {
    TextureImage image{"checker", 2, 2, {}, {}};
    image.texels8 = {{255, 255, 255, 255}, {64, 32, 0, 0}, {64, 32, 0, 0}, {255, 255, 255, 255}};
    return image;
}

/// The square with a checker of two by two over it.
Mesh checkeredSquare(std::uint32_t material) {
    Mesh mesh = squareMesh(material);
    mesh.uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    return mesh;
}

/// An unlit square before a background, filling the image.
SceneBuilder unlitSquare(AlphaMode mode, double alpha) {
    SceneBuilder builder;
    Material& material = builder.scene.materials[0];
    material.unlit = true;
    material.baseColor = {0.5, 0.25, 1.0};
    material.alphaMode = mode;
    material.alpha = alpha;
    builder.scene.environment.radiance = {0.1, 0.2, 0.3};
    builder.mesh(checkeredSquare(0));
    builder.camera({0, 0, 10}, Vec3d(0.0), 2 * std::atan(0.1)); // just the square
    return builder;
}

TEST(ReferenceSurfaces, BlendAndMaskCover) {
    SceneBuilder builder = unlitSquare(AlphaMode::blend, 0.3);
    const Vec3d base = builder.scene.materials[0].baseColor, sky = builder.scene.environment.radiance;
    expectRadiance(renderTotal(builder.scene, squareImage(16, 400)), 0.3 * base + 0.7 * sky, 0.01);
    builder.mesh(checkeredSquare(0), translation({0, 0, -1e-4})); // two sheets cover independently
    expectRadiance(renderTotal(builder.scene, squareImage(16, 400)), 0.51 * base + 0.49 * sky, 0.01);
    builder = unlitSquare(AlphaMode::mask, 1.0);
    builder.scene.images = {checkerImage()};
    builder.scene.textures = {{.filter = TextureFilter::nearest}};
    builder.scene.materials[0].maps[0].texture = 0;
    expectRadiance(renderTotal(builder.scene, squareImage(16, 100)), 0.5 * base + 0.5 * sky, 0.01);
}

/// A floor under a lamp behind a sheet that blends: the share of light that passes, in shadow rays and in found ones.
TEST(ReferenceSurfaces, SheetsThatBlendLetLightThrough) {
    const double formFactor = 0.09;
    for (const LightSampling sampling : {LightSampling::mis, LightSampling::light, LightSampling::bsdf}) {
        SceneBuilder builder = floorSeenFromTheSide(Vec3d(0.5));
        Material sheet;
        sheet.alphaMode = AlphaMode::blend;
        sheet.alpha = 0.4;
        sheet.baseColor = Vec3d(0.0);
        builder.scene.materials.push_back(sheet);
        builder.mesh(squareMesh(1), translation({0, 0, 0.5}));
        builder.scene.spheres = {{"", {0, 0, 2}, 0.6, builder.material(Vec3d(0.0), Vec3d(10.0), Faces::front)}};
        RenderSettings settings = onePoint(sampling == LightSampling::bsdf ? 60000 : 20000);
        settings.lightSampling = sampling;
        expectRadiance(renderTotal(builder.scene, settings), Vec3d(0.5 * 10.0 * formFactor * 0.6), 0.02);
    }
}

/// A floor under a lamp with a map and coverage: the integral over its texels, each a square.
TEST(ReferenceSurfaces, EmissionMapsAreIntegrated) {
    for (const LightSampling sampling : {LightSampling::mis, LightSampling::light, LightSampling::bsdf}) {
        SceneBuilder builder = floorSeenFromTheSide(Vec3d(0.5));
        builder.scene.images = {checkerImage()};
        builder.scene.textures = {{.filter = TextureFilter::nearest}};
        const std::uint32_t lamp = builder.material(Vec3d(1.0), Vec3d(8.0), Faces::front);
        Material& material = builder.scene.materials[lamp];
        material.maps[static_cast<std::size_t>(MapSlot::emission)].texture = 0;
        material.alphaMode = AlphaMode::blend;
        material.alpha = 0.5;
        builder.mesh(checkeredSquare(lamp), translation({0, 0, 1}) * scaling({1.0, -1.0, -1.0}));
        RenderSettings settings = onePoint(sampling == LightSampling::mis ? 20000 : 40000);
        settings.lightSampling = sampling;
        // Four squares with a corner above the point, each seen alike; two are white.
        const double quarter = 2.0 / (2.0 * kPi) * (1 / std::sqrt(2.0)) * std::atan(1 / std::sqrt(2.0));
        const Vec3d dim(linearFromSrgb(64 / 255.0), linearFromSrgb(32 / 255.0), 0.0);
        const Vec3d expected = 0.5 * 8.0 * 0.5 * 2.0 * quarter * (Vec3d(1.0) + dim);
        expectRadiance(renderTotal(builder.scene, settings), expected, 0.015);
    }
}

EnvironmentMap gradientMap() {
    EnvironmentMap map{"gradient", 16, 8, {}};
    for (std::uint32_t row = 0; row < 8; ++row)
        for (std::uint32_t column = 0; column < 16; ++column)
            map.texels.push_back(Vec3f(0.1f * float(row + 3), 0.4f, 0.5f) + (row == 2 && column == 5 ? 8.0f : 0.0f));
    return map;
}

/// Rough metal, coated and clear and rough glass, blended foliage and a lamp with a map under an environment map.
Scene everySurface() {
    SceneBuilder builder;
    builder.scene.images = {checkerImage()};
    builder.scene.textures = {{.filter = TextureFilter::linear}};
    builder.scene.materials[0].baseColor = {0.6, 0.5, 0.4};
    const std::uint32_t lamp = builder.material(Vec3d(0.2), {6.0, 5.0, 4.0}, Faces::front);
    builder.scene.materials[lamp].maps[static_cast<std::size_t>(MapSlot::emission)].texture = 0;
    const auto add = [&](Material material) {
        builder.scene.materials.push_back(std::move(material));
        return static_cast<std::uint32_t>(builder.scene.materials.size() - 1);
    };
    Material metal;
    metal.baseColor = {0.9, 0.7, 0.3};
    metal.metallic = 1.0;
    metal.roughness = 0.7;
    Material coated;
    coated.baseColor = {0.2, 0.4, 0.8};
    coated.specular = 1.0;
    coated.roughness = 0.7;
    Material rough = whiteGlass(0.7, 1.0);
    rough.attenuationColor = {0.5, 0.9, 0.7};
    rough.attenuationDistance = 0.5;
    Material sheet = whiteGlass(0.7, 0.0);
    sheet.transmission = 0.6;
    sheet.metallic = 0.2;
    sheet.alphaMode = AlphaMode::blend;
    sheet.alpha = 0.7;
    builder.mesh(squareMesh(0), scaling({4.0, 4.0, 1.0}));
    builder.mesh(checkeredSquare(lamp), translation({0, 0, 3}) * scaling({0.7, 0.7, -1.0}));
    builder.mesh(squareMesh(add(sheet)), translation({0.0, 0.4, 1.2}) * scaling({0.6, 0.6, 1.0}));
    builder.scene.spheres = {{"", {1.2, -0.5, 0.6}, 0.5, add(metal)},
                             {"", {-1.2, -0.5, 0.6}, 0.5, add(coated)},
                             {"", {0.0, -1.0, 0.55}, 0.5, add(rough)},
                             {"", {0.0, 1.5, 0.5}, 0.4, add(whiteGlass(0.0, 1.0))}};
    builder.scene.environment.radiance = Vec3d(1.0);
    builder.scene.environment.map = std::make_shared<EnvironmentMap>(gradientMap());
    builder.camera({0.5, -6.0, 2.5}, {0.0, 0.0, 0.8}, 0.6);
    return builder.scene;
}

struct Way {
    std::string name;
    LightSampling sampling;
    LightChoice choice;
    Precision precision;
    std::uint32_t samples;
    double mostError; ///< largest relative standard error
};

/// Means of the whole image by z-tests against the default, with one error budget.
TEST(ReferenceSurfaces, EveryWayToFindLightHasTheSameMean) {
    const std::vector<Way> ways = {
        {"all lights", LightSampling::mis, LightChoice::all, Precision::doublePrecision, 128, 0.01},
        {"float", LightSampling::mis, LightChoice::one, Precision::singlePrecision, 128, 0.01},
        {"light samples alone", LightSampling::light, LightChoice::one, Precision::doublePrecision, 256, 0.01},
        {"scattering alone", LightSampling::bsdf, LightChoice::one, Precision::doublePrecision, 512, 0.01},
        {"uniform directions", LightSampling::hemisphere, LightChoice::one, Precision::doublePrecision, 2000, 0.03}};
    const Scene scene = everySurface();
    RenderSettings settings = squareImage(24, 256);
    settings.maxDepth = 4;
    const PixelStatistics expected = renderTotal(scene, settings);
    for (const Way& way : ways) {
        SCOPED_TRACE(way.name);
        settings.lightSampling = way.sampling;
        settings.lightChoice = way.choice;
        settings.sampleCount = way.samples;
        settings.firstSample = 256; // none of the default's
        const PixelStatistics total = renderTotal(scene, settings, way.precision);
        for (int channel = 0; channel < 3; ++channel) {
            const double error = std::hypot(standardError(total, channel), standardError(expected, channel));
            EXPECT_NEAR(total.mean[channel], expected.mean[channel], kSigmas * error) << "channel " << channel;
            EXPECT_LT(error, way.mostError * expected.mean[channel]) << "too few samples to tell";
            std::printf("%s, channel %d: %+.3f %%, standard error %.3f %%\n", way.name.c_str(), channel,
                        100 * (total.mean[channel] / expected.mean[channel] - 1), 100 * error / expected.mean[channel]);
        }
    }
}

/// What leaves a glass sphere that emits: its inside is lit by itself, found by scattering and by light samples alike.
TEST(ReferenceSurfaces, GlassThatEmitsLightsItself) {
    std::array<PixelStatistics, 2> totals;
    for (const LightSampling sampling : {LightSampling::bsdf, LightSampling::mis}) {
        Material glass = whiteGlass(0.6, 1.0);
        glass.emission = Vec3d(1.0, 2.0, 3.0);
        glass.doubleSided = true;
        glass.attenuationColor = Vec3d(0.3);
        glass.attenuationDistance = 1.0;
        SceneBuilder builder = sphereInFurnace(glass);
        builder.scene.environment.radiance = Vec3d(0.0);
        RenderSettings settings = longPaths(400);
        settings.lightSampling = sampling;
        settings.maxDepth = 3;
        totals[sampling == LightSampling::mis ? 1 : 0] = renderTotal(builder.scene, settings);
    }
    for (int channel = 0; channel < 3; ++channel) {
        const double error = std::hypot(standardError(totals[0], channel), standardError(totals[1], channel));
        EXPECT_NEAR(totals[0].mean[channel], totals[1].mean[channel], kSigmas * error);
        EXPECT_LT(error, 0.005 * totals[0].mean[channel]);
    }
}

} // namespace
} // namespace isolux
