// Maps, vertex colours, normal maps and coverage of the CPU reference, against values computed by hand.
#include "reference/alpha.h"
#include "reference/normal_map.h"
#include "reference/tracing.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

template <typename Real> class ReferenceTexture : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceTexture, RealTypes);

/// Three by two texels: red counts columns, green rows.
TextureImage countingImage() {
    TextureImage image{"counting", 3, 2, {}, {}};
    for (std::uint8_t row = 0; row < 2; ++row)
        for (std::uint8_t column = 0; column < 3; ++column)
            image.texels8.push_back({std::uint8_t(51 * column), std::uint8_t(51 * row), 255, 128});
    return image;
}

template <typename Real>
Vec4<Real> readAt(const TextureImage& image, const Texture& texture, const Vec2d& uv,
                  Encoding encoding = Encoding::linear) {
    return TextureReader<Real>(texture, image, encoding).at(Vec2<Real>(uv));
}

TYPED_TEST(ReferenceTexture, NearestTakesTheTexelThatHoldsThePoint) {
    using Real = TypeParam;
    const TextureImage image = countingImage();
    const Texture texture{.filter = TextureFilter::nearest};
    EXPECT_EQ(readAt<Real>(image, texture, {0.1, 0.1}), Vec4<Real>(Vec4<double>(0, 0, 1, 128 / 255.0)));
    EXPECT_EQ(readAt<Real>(image, texture, {0.5, 0.75}).x, Real(0.2));
    EXPECT_EQ(readAt<Real>(image, texture, {0.5, 0.75}).y, Real(0.2)) << "v grows downwards";
    EXPECT_EQ(readAt<Real>(image, texture, {0.99, 0.49}).x, Real(0.4));
    EXPECT_EQ(readAt<Real>(image, texture, {0.99, 0.49}).y, Real(0));
}

TYPED_TEST(ReferenceTexture, IndicesAreWrapped) {
    using Real = TypeParam;
    const auto wrapped = [](double index, TextureWrap wrap) { return wrapIndex<Real>(Real(index), 3, wrap); };
    const std::vector<std::uint32_t> repeated = {2, 0, 1, 2, 0, 1, 2, 0}, mirrored = {0, 0, 1, 2, 2, 1, 0, 0};
    for (std::size_t place = 0; place < repeated.size(); ++place) {
        const int i = static_cast<int>(place) - 1;
        EXPECT_EQ(wrapped(i, TextureWrap::repeat), repeated[place]) << i;
        EXPECT_EQ(wrapped(i, TextureWrap::mirroredRepeat), mirrored[place]) << i;
        EXPECT_EQ(wrapped(i, TextureWrap::clampToEdge), static_cast<std::uint32_t>(std::clamp(i, 0, 2))) << i;
    }
    EXPECT_EQ(wrapped(-3, TextureWrap::repeat), 0u);
    EXPECT_EQ(wrapped(-4, TextureWrap::mirroredRepeat), 2u);
    EXPECT_EQ(wrapped(3e9, TextureWrap::repeat), 0u) << "beyond every integer of 32 bits";
    EXPECT_LT(wrapped(-1e30, TextureWrap::mirroredRepeat), 3u);
}

TYPED_TEST(ReferenceTexture, LinearInterpolatesBetweenCentres) {
    using Real = TypeParam;
    const TextureImage image = countingImage();
    const Texture clamped{0, TextureWrap::clampToEdge, TextureWrap::clampToEdge, TextureFilter::linear};
    const Texture repeated{};
    const Real tolerance = 4 * std::numeric_limits<Real>::epsilon();
    EXPECT_NEAR(readAt<Real>(image, clamped, {0.5, 0.5}).x, 0.2, tolerance) << "a column's centre";
    EXPECT_NEAR(readAt<Real>(image, clamped, {0.5, 0.5}).y, 0.1, tolerance) << "between two rows";
    EXPECT_NEAR(readAt<Real>(image, clamped, {1.75 / 3, 0.0}).x, 0.25, tolerance);
    EXPECT_NEAR(readAt<Real>(image, clamped, {0.0, 0.0}).x, 0.0, tolerance);
    EXPECT_NEAR(readAt<Real>(image, repeated, {0.0, 0.0}).x, 0.2, tolerance) << "between the first and the last";
    EXPECT_NEAR(readAt<Real>(image, repeated, {-2.0, 3.0}).x, 0.2, 16 * tolerance);
}

TYPED_TEST(ReferenceTexture, DecodesBeforeItInterpolates) {
    using Real = TypeParam;
    TextureImage image{"", 2, 1, {}, {}};
    image.texels8 = {{0, 128, 255, 128}, {255, 128, 255, 128}};
    const Vec4<Real> middle = readAt<Real>(image, {}, {0.5, 0.5}, Encoding::srgb);
    EXPECT_NEAR(middle.x, 0.5, 1e-6) << "the mean of what the codes stand for";
    EXPECT_NEAR(middle.y, 0.21586050011389926, 1e-7) << "IEC 61966-2-1 of 128";
    EXPECT_NEAR(middle.w, 128 / 255.0, 1e-7) << "alpha is linear";
    TextureImage deep{"", 1, 1, {}, {{0, 32768, 65535, 13107}}};
    const Vec4<Real> texel = readAt<Real>(deep, {}, {0.3, 0.3});
    EXPECT_NEAR(texel.y, 32768 / 65535.0, 1e-7);
    EXPECT_NEAR(texel.w, 0.2, 1e-7);
    EXPECT_NEAR(readAt<Real>(deep, {}, {0.3, 0.3}, Encoding::srgb).y, linearFromSrgb(32768 / 65535.0), 1e-7);
}

TYPED_TEST(ReferenceTexture, WhatIsNotFiniteReadsAsZero) {
    using Real = TypeParam;
    const Texture texture{.filter = TextureFilter::nearest};
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double u : {kInfinity, -kInfinity, std::nan("")})
        EXPECT_EQ(readAt<Real>(countingImage(), texture, {u, 0.75}), readAt<Real>(countingImage(), texture, {0, 0.75}));
}

/// The square with texture coordinates (0, 0) at its corner (-1, 1), and v downwards.
Mesh texturedSquare(std::uint32_t material) {
    Mesh mesh = squareMesh(material);
    mesh.uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    return mesh;
}

/// Any image of the counting kind on a square that a camera looks down on.
SceneBuilder texturedScene() {
    SceneBuilder builder;
    builder.scene.images = {countingImage()};
    builder.scene.textures = {{.filter = TextureFilter::nearest}};
    builder.mesh(texturedSquare(0));
    builder.camera({0, 0, 4}, Vec3d(0.0), 0.5);
    return builder;
}

/// The point of a scene's surface below (x, y).
template <typename Real> struct Below {
    World<Real> world;
    Attributes<Real> attributes;
    Surface<Real> surface;

    Below(const Scene& scene, double x, double y, double from = 3.0)
        : world(flatten<Real>(scene)), attributes(scene, world) {
        const Ray<Real> ray{{Real(x), Real(y), Real(from)}, {0, 0, from > 0 ? Real(-1) : Real(1)}};
        const auto hit = RayCaster<Real>(world).nearest(ray);
        EXPECT_TRUE(hit);
        if (hit) surface = withNormalMap(surfaceAt(world, ray, *hit), attributes);
    }
    [[nodiscard]] MaterialPoint<Real> material() const {
        return materialPointAt(attributes, surface.material, surface.place());
    }
};

TYPED_TEST(ReferenceTexture, MapsAndVertexColoursMultiplyTheirFactors) {
    using Real = TypeParam;
    SceneBuilder builder = texturedScene();
    Material& material = builder.scene.materials[0];
    material.baseColor = {0.5, 0.5, 0.5};
    material.metallic = 0.5;
    material.roughness = 0.6;
    material.maps[static_cast<std::size_t>(MapSlot::metallicRoughness)].texture = 0;
    builder.scene.meshes[0].colors.assign(4, {0.5f, 1.0f, 0.25f, 1.0f});
    builder.scene.meshes[0].colors[1] = builder.scene.meshes[0].colors[2] = {1.0f, 1.0f, 0.25f, 1.0f};
    const MaterialPoint<Real> point = Below<Real>(builder.scene, 0.5, -0.5).material();
    EXPECT_NEAR(point.base.x, 0.5 * 0.875, 1e-6) << "colours run from left to right";
    EXPECT_NEAR(point.base.y, 0.5, 1e-6);
    EXPECT_NEAR(point.base.z, 0.125, 1e-6);
    EXPECT_NEAR(point.metal, 0.5, 1e-6) << "blue is 1";
    EXPECT_NEAR(point.alpha, 0.12 * 0.12, 1e-7) << "green of the lower row is 0.2";
    EXPECT_FALSE(point.isLambertian());
}

TYPED_TEST(ReferenceTexture, CoordinatesAreTransformed) {
    using Real = TypeParam;
    SceneBuilder builder = texturedScene();
    TextureMap& map = builder.scene.materials[0].maps[static_cast<std::size_t>(MapSlot::transmission)];
    map.texture = 0;
    builder.scene.materials[0].transmission = 1.0;
    map.uvFromMesh = glm::dmat2(0.0, 1.0, 1.0, 0.0); // u and v change places
    map.offset = {0.25, 0.5};
    // (-0.5, 0.5) has (0.25, 0.25): (0.5, 0.75) is the middle column.
    EXPECT_NEAR(Below<Real>(builder.scene, -0.5, 0.5).material().transmission, 0.2, 1e-6);
    // (0.5, 0.5) has (0.75, 0.25): (0.5, 1.25) too.
    EXPECT_NEAR(Below<Real>(builder.scene, 0.5, 0.5).material().transmission, 0.2, 1e-6);
    // (-0.5, -0.5) has (0.25, 0.75): (1, 0.75) is the first column again.
    EXPECT_NEAR(Below<Real>(builder.scene, -0.5, -0.4).material().transmission, 0.4, 1e-6);
}

TYPED_TEST(ReferenceTexture, SpheresHaveOneCoordinate) {
    using Real = TypeParam;
    SceneBuilder builder = texturedScene();
    builder.scene.instances.clear();
    builder.scene.spheres = {{"", Vec3d(0.0), 1.0, 0}};
    builder.scene.materials[0].maps[0] = {.texture = 0, .offset = {0.5, 0.75}};
    const Vec3<Real> base = Below<Real>(builder.scene, 0.1, 0.2).material().base;
    EXPECT_NEAR(base.x, linearFromSrgb(0.2), 1e-6);
    EXPECT_NEAR(base.y, linearFromSrgb(0.2), 1e-6);
}

TYPED_TEST(ReferenceTexture, ParametersFollowTheConventions) {
    using Real = TypeParam;
    SceneBuilder builder = texturedScene();
    Material& material = builder.scene.materials[0];
    material.baseColor = {0.9, 0.5, 0.1};
    material.metallic = 0.4;
    material.specular = 0.5;
    material.specularColor = {1.0, 2.0, 100.0};
    material.transmission = 0.5;
    material.thickness = 0.1;
    const MaterialPoint<Real> point = Below<Real>(builder.scene, 0.1, 0.2).material();
    EXPECT_NEAR(point.transmission, 0.3, 1e-6);
    const double metal = 0.4 / 0.7;
    EXPECT_NEAR(point.metal, metal, 1e-6);
    EXPECT_FALSE(point.isLambertian());
    EXPECT_NEAR(point.f0.x, 0.02, 1e-6);
    EXPECT_NEAR(point.f0.y, 0.04, 1e-6);
    EXPECT_NEAR(point.f0.z, 0.5, 1e-6) << "0.04 * 100 counts as 1";
    EXPECT_NEAR(point.f90, 0.5, 1e-6);
    EXPECT_TRUE(point.isSolid());
    material = Material{};
    EXPECT_TRUE(Below<Real>(builder.scene, 0.1, 0.2).material().isLambertian());
    material.transmission = 1.0;
    EXPECT_EQ(Below<Real>(builder.scene, 0.1, 0.2).material().body, Body::wall);
}

/// A normal map of one texel, of which x and y are 0.6 and 0.
SceneBuilder bumpyScene() {
    SceneBuilder builder = texturedScene();
    builder.scene.images = {{"", 1, 1, {{204, 128, 230, 255}}, {}}};
    builder.scene.meshes[0].tangents.assign(4, {1, 0, 0, 1});
    builder.scene.materials[0].maps[static_cast<std::size_t>(MapSlot::normal)].texture = 0;
    return builder;
}

TYPED_TEST(ReferenceTexture, NormalMapsBendTheShadingNormal) {
    using Real = TypeParam;
    const auto expectNear = [](const Vec3<Real>& normal, const Vec3d& expected) {
        EXPECT_NEAR(glm::length(Vec3d(normal) - glm::normalize(expected)), 0.0, 1e-6);
    };
    constexpr double x = 2 * 204 / 255.0 - 1, y = 2 * 128 / 255.0 - 1, z = 2 * 230 / 255.0 - 1;
    SceneBuilder builder = bumpyScene();
    expectNear(Below<Real>(builder.scene, 0.1, 0.2).surface.ns, {x, y, z});
    expectNear(Below<Real>(builder.scene, 0.1, 0.2, -3.0).surface.ns, {-x, -y, -z});
    builder.scene.materials[0].normalScale = 0.5;
    expectNear(Below<Real>(builder.scene, 0.1, 0.2).surface.ns, {x / 2, y / 2, z});
    builder.scene.materials[0].normalScale = 1.0;
    builder.scene.meshes[0].tangents.assign(4, {0, 1, 0, -1}); // T = y, B = -cross(z, y) = x
    expectNear(Below<Real>(builder.scene, 0.1, 0.2).surface.ns, {y, x, z});
    builder.scene.instances[0].worldFromObject = scaling({-2.0, 1.0, 1.0}); // mirrored
    expectNear(Below<Real>(builder.scene, 0.1, 0.2).surface.ns, {-y, x, z});
    builder.scene.meshes[0].tangents.assign(4, {0, 0, 1, 1}); // along the normal
    expectNear(Below<Real>(builder.scene, 0.1, 0.2).surface.ns, {0, 0, 1});
}

TYPED_TEST(ReferenceTexture, NormalsBelowTheSurfaceAreNotTaken) {
    using Real = TypeParam;
    const Vec3<Real> up(0, 0, 1);
    const Tangent<Real> tangent{{2, 0, 0}, 1};
    EXPECT_EQ(bendNormal(up, up, tangent, Vec3<Real>(1, 0, 0)), up) << "in the horizon";
    EXPECT_EQ(bendNormal(up, up, tangent, Vec3<Real>(0, 0, -1)), up);
    EXPECT_EQ(bendNormal(up, up, tangent, Vec3<Real>(0, 0, 0)), up);
    EXPECT_NEAR(bendNormal(up, up, tangent, Vec3<Real>(0, Real(0.6), Real(0.8))).y, 0.6, 1e-6);
}

TEST(ReferenceAlpha, HashIsTheWrittenOne) {
    EXPECT_EQ(lowbias32(0u), 0u);
    // By hand from the five steps.
    std::uint32_t h = 12345u;
    h = (h ^ (h >> 16)) * 0x7FEB352Du;
    h = (h ^ (h >> 15)) * 0x846CA68Bu;
    EXPECT_EQ(lowbias32(12345u), h ^ (h >> 16));
    EXPECT_EQ(coverageNumber<double>(7u, 3u), unitReal<double>(lowbias32(7u ^ (3u * 0x9E3779B9u))));
}

TEST(ReferenceAlpha, CoverageByModeMapAndColour) {
    SceneBuilder builder = texturedScene();
    Material& material = builder.scene.materials[0];
    material.alpha = 0.8;
    material.maps[0].texture = 0;
    builder.scene.meshes[0].colors.assign(4, {1.0f, 1.0f, 1.0f, 0.5f});
    const auto coverage = [&] {
        const Below<double> below(builder.scene, 0.1, 0.2);
        return coverageAt(below.attributes, below.surface.place());
    };
    EXPECT_EQ(coverage(), 1.0) << "opaque whatever it says";
    material.alphaMode = AlphaMode::blend;
    EXPECT_NEAR(coverage(), 0.8 * 0.5 * 128 / 255.0, 1e-12);
    material.alphaMode = AlphaMode::mask;
    EXPECT_EQ(coverage(), 0.0);
    material.alphaCutoff = 0.8 * 0.5 * 128 / 255.0 - 1e-9;
    EXPECT_EQ(coverage(), 1.0);
}

/// What is seen does not depend on how primitives are found, and shadow rays agree with the nearest hit.
TEST(ReferenceAlpha, PresenceIsAnAnswerForTheWholeRay) {
    Scene scene = randomSoup(4);
    scene.materials[0].alphaMode = AlphaMode::blend;
    scene.materials[0].alpha = 0.4;
    const World<double> world = flatten<double>(scene);
    const Attributes<double> attributes(scene, world);
    const RayCaster<double> fast(world), plain(world, {Acceleration::none, 4, TriangleTest::watertight});
    Random random(12);
    TraversalTests tests;
    int hits = 0, passed = 0;
    for (std::uint32_t key = 0; key < 3000; ++key) {
        const auto ray =
            rayFrom<double>(Vec3d(10, -3, 0.1) + random.inCube(4.0), Vec3d(10, -3, 0.1) + random.inCube(1.0));
        const Presence<double> presence(attributes, key);
        const auto hit = fast.nearest(ray, tests, presence), again = plain.nearest(ray, tests, presence);
        ASSERT_EQ(hit.has_value(), again.has_value());
        ASSERT_EQ(fast.visibility(ray, kNoPrimitive, tests, presence), hit ? Visibility::blocked : Visibility::clear);
        ASSERT_EQ(hit ? hit->primitive : kNoPrimitive, again ? again->primitive : kNoPrimitive);
        hits += hit ? 1 : 0;
        const auto first = fast.nearest(ray);
        passed += first && (!hit || hit->primitive != first->primitive) ? 1 : 0;
    }
    EXPECT_GT(hits, 1000);
    EXPECT_GT(passed, 1000);
}

} // namespace
} // namespace isolux
