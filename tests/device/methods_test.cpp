// Every method, the device against the double reference on the same random numbers.
#include "device/paired_fixture.h"
#include "support/methods.h"

#include "load/gltf.h"

#include <set>

namespace isolux::test {
namespace {

RenderSettings smallImage(std::uint32_t samples) {
    return workShare() < 1.0 ? imageSettings(32, 24, samples) : imageSettings(64, 48, samples);
}

class Methods : public Paired, public ::testing::WithParamInterface<Method> {};

/// 40 samples: more than two passes, and no multiple of the replicates.
TEST_P(Methods, AgreeWithTheReference) {
    RenderSettings settings = smallImage(40);
    GetParam().apply(settings);
    expectAgreement(mixedLightsScene(), settings);
}

INSTANTIATE_TEST_SUITE_P(All, Methods, ::testing::ValuesIn(allMethods()),
                         [](const auto& tested) { return tested.param.name; });

/// Paths that are stopped after every few steps, in whatever phase, go on as if nothing had been. Drivers that repeat
/// what another has done take the methods that keep something of their own between dispatches.
TEST_F(Paired, DispatchesChangeNoBit) {
    const std::set<std::string> keepers{"Ambient", "AllLightsThrice", "Sobol", "EveryPrimitive"};
    const Scene scene = mixedLightsScene();
    RenderOptions options;
    options.signatures = PathSignatures::on;
    options.counts = TraversalCounts::on;
    for (const Method& method : allMethods()) {
        if (workShare() < 1.0 && !keepers.contains(method.name)) continue;
        RenderSettings settings = imageSettings(11, 9, 18);
        method.apply(settings);
        options.dispatchSeconds = RenderOptions{}.dispatchSeconds;
        const Film whole = render(scene, settings, options);
        options.dispatchSeconds = 1e-6;
        const Film parts = render(scene, settings, options);
        SCOPED_TRACE(method.name);
        EXPECT_EQ(differingPixels(whole, parts), 0u);
        EXPECT_TRUE(whole.replicates == parts.replicates);
        EXPECT_EQ(whole.rays, parts.rays);
        EXPECT_EQ(whole.boxTests, parts.boxTests);
        EXPECT_EQ(whole.primitiveTests, parts.primitiveTests);
    }
}

/// Without a BVH there is neither an order of boxes nor one of leaves: the same hits, to the last bit.
TEST_F(Paired, AccelerationChangesNoBit) {
    const Scene scene = loadScene(projectScene("cornell_spheres"));
    RenderSettings settings = smallImage(16);
    const Film film = render(scene, settings);
    for (const IntersectionMethod& method :
         {IntersectionMethod{Acceleration::none}, IntersectionMethod{Acceleration::meanSplit, 1},
          IntersectionMethod{Acceleration::meanSplit, 8}, IntersectionMethod{Acceleration::sah, 1}}) {
        settings.intersection = method;
        EXPECT_EQ(differingPixels(film, render(scene, settings)), 0u);
    }
}

/// Samplers differ from each other, and a part of a render is that part of the whole.
TEST_F(Paired, SamplersAreResumed) {
    const Scene scene = mixedLightsScene();
    for (const PixelSampler sampler :
         {PixelSampler::independent, PixelSampler::stratified, PixelSampler::sobol, PixelSampler::sobolBlueNoise}) {
        RenderSettings settings = smallImage(64);
        settings.sampler = sampler;
        settings.plannedSamples = 64;
        const Film whole = render(scene, settings);
        settings.sampleCount = 32;
        Film film(settings.width, settings.height);
        PathRenderer renderer(device_, scene, settings, {});
        for (const std::uint32_t first : {0u, 32u}) {
            renderer.setSamples({first, 32});
            renderer.render(film, [](double) { return Continue::yes; });
        }
        EXPECT_EQ(differingPixels(whole, film), 0u) << static_cast<int>(sampler);
    }
}

/// Light alone at each bounce adds up to the light of all; likewise direct and indirect. Single precision rounds each
/// sum: 2^-24 of the sum for each of the 16 samples and six images.
TEST_F(Paired, BouncesAddUp) {
    const Scene scene = mixedLightsScene();
    RenderSettings settings = smallImage(16);
    settings.roulette.kind = Roulette::off;
    settings.maxDepth = 5;
    const Film whole = render(scene, settings);
    const auto expectSum = [&](const std::vector<Film>& parts, double scale) {
        for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
            Vec3d sum(0.0);
            for (const Film& part : parts) sum += part.pixels[i].mean;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(sum[c], whole.pixels[i].mean[c], scale * 0x1p-24 * whole.pixels[i].mean[c]);
        }
    };
    std::vector<Film> alone;
    for (std::uint32_t depth = 0; depth <= settings.maxDepth; ++depth) {
        RenderSettings one = settings;
        one.bounces = BounceSelection::last;
        one.maxDepth = depth;
        alone.push_back(render(scene, one));
    }
    expectSum(alone, 16 * 6);
    RenderSettings part = settings;
    part.light = LightPart::direct;
    std::vector<Film> parts{render(scene, part)};
    part.light = LightPart::indirect;
    parts.push_back(render(scene, part));
    expectSum(parts, 16 * 2);
}

/// Tests are counted, and fewer the better the tree.
TEST_F(Paired, TraversalCounts) {
    const Scene scene = loadScene(blobScene());
    RenderSettings settings = imageSettings(32, 24, 1);
    settings.integrator = Integrator::normals;
    RenderOptions options;
    options.counts = TraversalCounts::on;
    const Film sah = render(scene, settings, options);
    settings.intersection.acceleration = Acceleration::meanSplit;
    const Film mean = render(scene, settings, options);
    settings.intersection.acceleration = Acceleration::none;
    const Film none = render(scene, settings, options);
    EXPECT_EQ(none.boxTests, 0u);
    EXPECT_EQ(none.primitiveTests, none.rays * primitiveCount(scene));
    EXPECT_LT(1000 * mean.primitiveTests, none.primitiveTests);
    EXPECT_LT(sah.primitiveTests + sah.boxTests, mean.primitiveTests + mean.boxTests);
    EXPECT_EQ(render(scene, settings).primitiveTests, 0u);
}

/// Adaptive sampling: both backends stop the same pixels after the same samples, but for those whose error rounds to
/// the other side; what they hold is a prefix of the uniform render.
TEST_F(Paired, AdaptivePixelsStopAlike) {
    const Scene scene = mixedLightsScene();
    const RenderSettings settings = smallImage(256);
    RenderOptions options;
    options.stopping.adaptive = AdaptiveRule{0.3, 32, 64};
    const Film film = render(scene, settings, options);
    ReferenceOptions reference;
    reference.stopping = options.stopping;
    const Film expected = renderReference(scene, settings, reference, {});
    std::size_t different = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i)
        if (film.pixels[i].sampleCount != expected.pixels[i].sampleCount) ++different;
    // One pixel in a thousand may take another branch, and each stands in nine neighbourhoods.
    EXPECT_LE(static_cast<double>(different), 9.0 * (1.0 - kAgreement) * static_cast<double>(film.pixels.size()));
    EXPECT_EQ(film.minSampleCount(), 64u);
    EXPECT_GT(film.maxSampleCount(), film.minSampleCount());
    const std::uint64_t rays = film.rays;
    for (const PixelStatistics& pixel : film.pixels) EXPECT_EQ((pixel.sampleCount - 64) % 32, 0u);
    EXPECT_LT(rays, render(scene, settings).rays) << "pixels that have stopped still cost";
    for (const std::uint32_t samples : {64u, 96u, 256u}) {
        RenderSettings shorter = settings;
        shorter.sampleCount = samples;
        const Film uniform = render(scene, shorter);
        for (std::size_t i = 0; i < film.pixels.size(); ++i)
            if (film.pixels[i].sampleCount == samples) {
                ASSERT_TRUE(film.pixels[i] == uniform.pixels[i]);
            }
    }
}

TEST_F(Paired, AnErrorAskedForIsReached) {
    const Scene scene = loadScene(projectScene("cornell_box"));
    const RenderSettings settings = imageSettings(48, 48, 4096);
    RenderOptions options;
    options.stopping.relativeError = 0.2;
    const Film film = render(scene, settings, options);
    EXPECT_LE(estimatedRelativeRmse(film), 0.2);
    EXPECT_GT(estimatedRelativeRmse(film), 0.15);
    EXPECT_LT(film.maxSampleCount(), 4096u);
    EXPECT_EQ(film.minSampleCount(), film.maxSampleCount());
}

} // namespace
} // namespace isolux::test
