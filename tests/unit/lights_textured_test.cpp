// Powers of textured emitters and of environment maps in the light table.
#include "core/srgb.h"
#include "scene/emission.h"
#include "scene/environment_table.h"
#include "scene/lights.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

/// A grey image of `size` squared texels, white where `lit` says so, on a square of edge 1 that it covers.
template <typename Lit> Scene texturedSquare(std::uint32_t size, const Lit& lit) {
    Scene scene;
    TextureImage image{"sign", size, size, {}, {}};
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) image.texels8.push_back(lit(x, y) ? Texel8(255) : Texel8(0));
    scene.images = {image};
    scene.textures.resize(1);
    Material material;
    material.emission = {2.0, 1.0, 0.5};
    material.maps[static_cast<std::size_t>(MapSlot::emission)].texture = 0;
    scene.materials = {material};
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}}; // below the diagonal from the lower left, and above
    scene.meshes = {mesh};
    scene.instances = {{"sign", 0, Mat4d(1.0)}};
    return scene;
}

Vec3d meanOf(const Scene& scene, std::size_t triangle) {
    return MeanEmission(scene).ofTriangle(scene.meshes[0], scene.meshes[0].triangles[triangle]);
}

TEST(MeanEmission, IsTheFactorWithoutAMap) {
    Scene scene = texturedSquare(4, [](auto, auto) { return false; });
    scene.materials[0].maps = {};
    EXPECT_EQ(meanOf(scene, 0), scene.materials[0].emission);
    scene.materials[0].unlit = true;
    EXPECT_EQ(meanOf(scene, 0), Vec3d(0.0));
}

TEST(MeanEmission, OfAConstantMapIsExact) {
    Scene scene = texturedSquare(4, [](auto, auto) { return true; });
    for (Texel8& texel : scene.images[0].texels8) texel = Texel8(128, 0, 255, 7);
    const double half = linearFromSrgb(128.0 / 255.0);
    EXPECT_EQ(meanOf(scene, 0), Vec3d(2.0 * half, 0.0, 0.5));
}

TEST(MeanEmission, OfHalfAnImageIsHalf) {
    // The lower half: 3/4 of the lower triangle, 1/4 of the upper one. The rows of lookups number twice the root of
    // their count, so the border is at most one of n rows off: n = 4 for 16 lookups, 32 for 1024.
    for (const auto& [size, n] : {std::pair{2u, 4.0}, {64u, 32.0}}) {
        const Scene scene = texturedSquare(size, [size = size](auto, auto y) { return 2 * y >= size; });
        const Vec3d emission = scene.materials[0].emission;
        EXPECT_LT(glm::length(meanOf(scene, 0) / emission - Vec3d(0.75)), 2.0 / n) << size;
        EXPECT_LT(glm::length(meanOf(scene, 1) / emission - Vec3d(0.25)), 2.0 / n) << size;
    }
}

TEST(MeanEmission, LooksAsOftenAsTexelsAreCovered) {
    // A chequerboard of single texels: seen evenly, by one lookup a texel or more.
    const Scene scene = texturedSquare(32, [](auto x, auto y) { return (x + y) % 2 == 0; });
    // 512 texels a triangle, 23^2 lookups: the standard error of so many random ones, twice.
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(meanOf(scene, i).y, 0.5, 2.0 * 0.5 / 23.0);
}

TEST(MeanEmission, FollowsTransformsAndHugeCoordinates) {
    Scene scene = texturedSquare(8, [](auto x, auto y) { return x == 2 && y == 5; });
    TextureMap& map = scene.materials[0].maps[static_cast<std::size_t>(MapSlot::emission)];
    map.uvFromMesh = glm::dmat2(0.0);
    map.offset = {2.5 / 8.0, 5.5 / 8.0};
    EXPECT_EQ(meanOf(scene, 0), scene.materials[0].emission);
    map.offset = {0.0, 0.0};
    EXPECT_EQ(meanOf(scene, 0), Vec3d(0.0));
    for (const double scale : {1e30, 1e300, std::numeric_limits<double>::infinity()}) {
        map.uvFromMesh = glm::dmat2(scale);
        EXPECT_LE(meanOf(scene, 0).x, scene.materials[0].emission.x);
    }
}

TEST(MeanEmission, SpheresHaveOneCoordinate) {
    Scene scene = texturedSquare(8, [](auto x, auto y) { return x == 2 && y == 5; });
    scene.spheres = {{"lamp", Vec3d(0.0), 1.0, 0}};
    EXPECT_EQ(MeanEmission(scene).ofSphere(0), Vec3d(0.0));
    scene.materials[0].maps[static_cast<std::size_t>(MapSlot::emission)].offset = {2.5 / 8.0, 5.5 / 8.0};
    EXPECT_EQ(MeanEmission(scene).ofSphere(0), scene.materials[0].emission);
}

TEST(LightTable, TexturedEmittersCountWithTheirMean) {
    Scene scene = texturedSquare(2, [](auto, auto y) { return y == 1; });
    const LightTable lights = buildLightTable(scene);
    ASSERT_EQ(lights.lights.size(), 2u);
    const double lower = meanOf(scene, 0).x;
    const double upper = meanOf(scene, 1).x;
    EXPECT_GT(lower, upper);
    EXPECT_NEAR(lights.choice.pdf[0], lower / (lower + upper), 1e-9); // rounded to 2^-33
    scene.images[0].texels8.assign(4, Texel8(0));
    EXPECT_TRUE(buildLightTable(scene).lights.empty()) << "a black map emits nothing";
    EXPECT_EQ(buildLightTable(scene).lightOf, std::vector<std::uint32_t>(2, kNoLight));
}

TEST(LightTable, UnlitSurfacesAreNoLights) {
    Scene scene = texturedSquare(2, [](auto, auto) { return true; });
    scene.spheres = {{"ball", Vec3d(0.0), 1.0, 0}};
    EXPECT_EQ(buildLightTable(scene).lights.size(), 3u);
    scene.materials[0].unlit = true;
    EXPECT_TRUE(buildLightTable(scene).lights.empty());
}

// --- Environment maps ---

std::shared_ptr<EnvironmentMap> mapOf(std::uint32_t width, std::uint32_t height, const Vec3f& color) {
    return std::make_shared<EnvironmentMap>(
        EnvironmentMap{"sky", width, height, std::vector<Vec3f>(std::size_t{width} * height, color)});
}

TEST(EnvironmentFlux, OfAConstantMapIsThatOfAConstant) {
    Environment constant;
    constant.radiance = {1.0, 2.0, 3.0};
    Environment mapped = constant;
    mapped.radiance = {4.0, 4.0, 4.0};
    mapped.map = mapOf(16, 8, {0.25f, 0.5f, 0.75f});
    EXPECT_NEAR(environmentFlux(mapped) / environmentFlux(constant), 1.0, 1e-13); // 128 sums of doubles
}

TEST(EnvironmentFlux, CountsEachChannelByItsOwn) {
    Environment environment;
    environment.radiance = {1.0, 0.0, 0.0};
    environment.map = mapOf(2, 1, {0.0f, 1.0f, 1.0f});
    EXPECT_EQ(environmentFlux(environment), 0.0) << "red light on a map without red";
    environment.radiance = {1.0, 3.0, 0.0};
    EXPECT_NEAR(environmentFlux(environment), 4.0 * kPi * 3.0 * 0.7152, 1e-12);
}

TEST(EnvironmentFlux, EveryLitMapHasSome) {
    Environment environment;
    environment.radiance = Vec3d(1e-3);
    for (const auto& [width, height] : {std::pair{1u, 1u}, {2u, 1u}, {64u, 32u}}) {
        const auto map = mapOf(width, height, Vec3f(0.0f));
        map->texels.front().z = std::numeric_limits<float>::denorm_min();
        environment.map = map;
        EXPECT_GT(environmentFlux(environment), 0.0);
        EXPECT_FALSE(buildEnvironmentTable(*map).cells.bins.empty());
    }
}

TEST(LightTable, EnvironmentMapsCountWithTheirFlux) {
    Scene scene = texturedSquare(2, [](auto, auto) { return true; });
    scene.environment.radiance = Vec3d(2.0);
    scene.environment.map = mapOf(4, 2, Vec3f(0.5f));
    const LightTable lights = buildLightTable(scene);
    ASSERT_EQ(lights.environment, 2u);
    // The square's half diagonal is the root of 1/2: a disc of pi/2, radiance 1 from everywhere.
    const double sky = 4.0 * kPi * 0.5 * kPi;
    const double sign = kPi * luminance(scene.materials[0].emission);
    EXPECT_NEAR(lights.choice.pdf[2], sky / (sky + sign), 1e-9); // rounded to 2^-34
    scene.environment.map = mapOf(4, 2, Vec3f(0.0f));
    EXPECT_EQ(buildLightTable(scene).environment, kNoLight);
}

} // namespace
} // namespace isolux
