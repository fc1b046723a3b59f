// Back faces that are culled: which materials have none, what kernels are told of it, and what the reference then sees.
#include "pack/packed_scene.h"
#include "reference/back_faces.h"
#include "reference/surface.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

namespace isolux {
namespace {

using namespace test;

Material glassMaterial() {
    Material glass;
    glass.transmission = 1.0;
    glass.thickness = 1.0;
    return glass;
}

RenderSettings culling(Integrator integrator = Integrator::path) {
    RenderSettings settings = smallSettings(2);
    settings.integrator = integrator;
    settings.backFaces = BackFaces::culled;
    return settings;
}

TEST(BackFaces, OfOpaqueSingleSidedMaterialsAreCulled) {
    Material material;
    EXPECT_TRUE(material.isSingleSided());
    material.transmission = 0.01;
    EXPECT_FALSE(material.isSingleSided());
    material = Material{};
    material.doubleSided = true;
    EXPECT_FALSE(material.isSingleSided());
}

// --- What kernels are told ---

/// The bits of every primitive of material 0, then of those of material 1, a sphere each.
std::vector<std::uint32_t> culledBits(const Scene& scene, const RenderSettings& settings) {
    std::vector<std::uint32_t> bits(primitiveCount(scene));
    for (const shared::PrimitiveRecord& primitive : packScene(scene, settings).primitives) {
        const auto word = std::bit_cast<std::uint32_t>(primitive.p2Id.w);
        bits.at(word & shared::kIdMask) = word & shared::kCulledBackBit;
    }
    return bits;
}

TEST(BackFaces, PrimitivesSayWhetherTheirsAreCulled) {
    SceneBuilder builder;
    builder.scene.materials.push_back(glassMaterial());
    builder.mesh(squareMesh(0));
    builder.scene.spheres = {{"", Vec3d(0.0, 0.0, 2.0), 1.0, 0}, {"", Vec3d(0.0, 0.0, 5.0), 1.0, 1}};
    constexpr std::uint32_t kBit = shared::kCulledBackBit;
    EXPECT_EQ(culledBits(builder.scene, culling()), (std::vector<std::uint32_t>{kBit, kBit, kBit, 0}));
    EXPECT_EQ(culledBits(builder.scene, {}), (std::vector<std::uint32_t>{0, 0, 0, 0}));
    builder.scene.materials[0].doubleSided = true;
    EXPECT_EQ(culledBits(builder.scene, culling()), (std::vector<std::uint32_t>{0, 0, 0, 0}));
}

FeatureNote noteOf(const Scene& scene, const RenderSettings& settings) {
    const std::vector<FeatureNote> notes = explainFeatures(scene, settings);
    const auto found = std::find_if(notes.begin(), notes.end(),
                                    [](const FeatureNote& note) { return note.name == "back-face-culling"; });
    return found == notes.end() ? FeatureNote{} : *found;
}

/// Materials that nothing has do not count.
TEST(BackFaces, CullingIsLeftOutUnlessSomethingIsCulled) {
    SceneBuilder builder;
    builder.scene.materials = {Material{}, glassMaterial(), Material{}};
    builder.mesh(squareMesh(0));
    builder.mesh(squareMesh(1), translation({0.0, 0.0, 1.0}));
    EXPECT_FALSE(findFeatures(builder.scene, {}).backFaceCulling);
    EXPECT_EQ(noteOf(builder.scene, {}).reason, "back faces are shown");
    EXPECT_TRUE(findFeatures(builder.scene, culling()).backFaceCulling);
    EXPECT_EQ(noteOf(builder.scene, culling()).reason, "1 of 2 materials are single-sided");
    builder.scene.materials[0].doubleSided = true;
    EXPECT_FALSE(findFeatures(builder.scene, culling()).backFaceCulling);
    EXPECT_EQ(noteOf(builder.scene, culling()).reason, "0 of 2 materials are single-sided");
}

// --- What the reference sees ---

/// The share of the camera's rays that meet something.
double seenFrom(Scene scene, const Vec3d& position, const RenderSettings& settings) {
    SceneBuilder builder;
    builder.scene = std::move(scene);
    builder.scene.cameras.clear();
    builder.camera(position, Vec3d(0.0), 0.3);
    const Film film = render(builder.scene, settings);
    double hits = 0.0;
    for (const PixelStatistics& pixel : film.pixels) hits += static_cast<double>(pixel.hitCount);
    return hits / (static_cast<double>(film.pixels.size()) * static_cast<double>(settings.sampleCount));
}

TEST(BackFaces, ASquareIsSeenFromItsFront) {
    const RenderSettings shown = [] {
        RenderSettings settings = culling(Integrator::albedo);
        settings.backFaces = BackFaces::shown;
        return settings;
    }();
    const RenderSettings culled = culling(Integrator::albedo);
    SceneBuilder builder;
    builder.mesh(squareMesh(0));
    const Vec3d above(0.0, 0.0, 3.0), below(0.0, 0.0, -3.0);
    EXPECT_EQ(seenFrom(builder.scene, above, shown), 1.0);
    EXPECT_EQ(seenFrom(builder.scene, below, shown), 1.0);
    EXPECT_EQ(seenFrom(builder.scene, above, culled), 1.0);
    EXPECT_EQ(seenFrom(builder.scene, below, culled), 0.0);
    builder.scene.instances[0].worldFromObject = scaling({1.0, 1.0, -1.0}); // mirrored: the front stays the face's
    EXPECT_EQ(seenFrom(builder.scene, above, culled), 0.0);
    EXPECT_EQ(seenFrom(builder.scene, below, culled), 1.0);
    builder.scene.materials[0].doubleSided = true;
    EXPECT_EQ(seenFrom(builder.scene, above, culled), 1.0);
    builder.scene.materials[0] = glassMaterial();
    EXPECT_EQ(seenFrom(builder.scene, above, culled), 1.0) << "what transmits is never culled";
}

TEST(BackFaces, ASphereIsSeenFromOutside) {
    SceneBuilder builder;
    builder.scene.spheres = {{"", Vec3d(0.0), 1.0, 0}};
    const RenderSettings culled = culling(Integrator::albedo);
    EXPECT_EQ(seenFrom(builder.scene, {0.0, 0.0, 3.0}, culled), 1.0);
    EXPECT_EQ(seenFrom(builder.scene, {0.0, 0.0, 0.5}, culled), 0.0);
    builder.scene.materials[0] = glassMaterial();
    EXPECT_EQ(seenFrom(builder.scene, {0.0, 0.0, 0.5}, culled), 1.0);
}

/// A floor under a lamp without extent; the camera looks at it from below anything that hangs between.
SceneBuilder litFloor() {
    SceneBuilder builder;
    builder.mesh(squareMesh(0), scaling({5.0, 5.0, 1.0}));
    PunctualLight lamp;
    lamp.position = {0.1, 0.2, 3.0};
    builder.scene.punctualLights = {lamp};
    builder.camera({0.0, 0.0, 0.9}, Vec3d(0.0), 0.5);
    return builder;
}

/// As if it were not there, to the last bit; turned round it keeps all light off.
TEST(BackFaces, LightPassesThroughThem) {
    const SceneBuilder open = litFloor();
    SceneBuilder roofed = litFloor();
    roofed.mesh(squareMesh(0), translation({0.0, 0.0, 1.0}) * scaling({5.0, 5.0, 1.0}));
    RenderSettings settings = culling();
    settings.maxDepth = 1;
    const Film expected = render(open.scene, settings), passed = render(roofed.scene, settings);
    EXPECT_TRUE(expected.pixels == passed.pixels);
    EXPECT_GT(luminance(expected.pixels[0].mean), 0.0);
    roofed.scene.instances[1].worldFromObject = translation({0.0, 0.0, 1.0}) * scaling({5.0, -5.0, -1.0});
    for (const PixelStatistics& pixel : render(roofed.scene, settings).pixels) EXPECT_EQ(pixel.mean, Vec3d(0.0));
}

TEST(BackFaces, AmbientRaysPassThroughThem) {
    SceneBuilder roofed = litFloor();
    roofed.mesh(squareMesh(0), translation({0.0, 0.0, 1.0}) * scaling({5.0, 5.0, 1.0}));
    for (const PixelStatistics& pixel : render(roofed.scene, culling(Integrator::ao)).pixels)
        EXPECT_EQ(pixel.mean, Vec3d(1.0));
}

// --- Rays at random ---

template <typename Real> class BackFaceTests : public ::testing::Test {};
TYPED_TEST_SUITE(BackFaceTests, RealTypes);

/// Every surface that is left is met from its front as shading tells it, however it is found.
TYPED_TEST(BackFaceTests, LeaveFrontsAlone) {
    using Real = TypeParam;
    const Scene scene = randomSoup(9);
    const World<Real> world = flatten<Real>(scene);
    const BackFaceTest<Real> test(scene, world, BackFaces::culled);
    const RayCaster<Real> fast(world), plain(world, {Acceleration::none, 4, TriangleTest::watertight});
    Random random(3);
    TraversalTests tests;
    int hits = 0, passed = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto ray =
            rayFrom<Real>(Vec3d(10, -3, 0.1) + random.inCube(4.0), Vec3d(10, -3, 0.1) + random.inCube(1.0));
        const auto isThere = [&](const Place<Real>& place) { return test.isThere(ray, place); };
        const auto hit = fast.nearest(ray, tests, isThere), again = plain.nearest(ray, tests, isThere);
        ASSERT_EQ(hit ? hit->primitive : kNoPrimitive, again ? again->primitive : kNoPrimitive);
        ASSERT_EQ(fast.visibility(ray, kNoPrimitive, tests, isThere), hit ? Visibility::blocked : Visibility::clear);
        if (hit) {
            ASSERT_EQ(surfaceAt(world, ray, *hit).side(), Side::front);
        }
        const auto first = fast.nearest(ray);
        hits += hit ? 1 : 0;
        passed += first && (!hit || hit->primitive != first->primitive) ? 1 : 0;
    }
    EXPECT_GT(hits, 1000);
    EXPECT_GT(passed, 500);
}

} // namespace
} // namespace isolux
