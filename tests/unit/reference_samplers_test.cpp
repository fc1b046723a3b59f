// Where the CPU reference takes its random numbers from, and what that does to its error.
#include "reference/tracing.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

constexpr std::array kDependent = {PixelSampler::stratified, PixelSampler::sobol, PixelSampler::sobolBlueNoise};

TEST(ReferenceSamplers, StreamsAreTheWrittenBlocks) {
    const Scene scene = smallRoom();
    const World<double> world = flatten<double>(scene);
    RenderSettings settings = smallSettings(100);
    settings.firstSample = 30; // 130 samples: nine in a replicate, 2^4 cells
    const SequencePlan plan{settings.seed, 4};
    const SampleIndex index{7, 3, 77};
    const auto blockOf = [&](PixelSampler sampler, std::uint32_t block) {
        settings.sampler = sampler;
        return Tracing<double>(scene, world, settings, SideRule::geometric).stream(index).block(block);
    };
    for (const std::uint32_t block : {0u, 1u, 2u, 0x80000003u}) {
        EXPECT_EQ(blockOf(PixelSampler::independent, block), randomBlock(settings.seed, 7, 3, 77, block));
        EXPECT_EQ(blockOf(PixelSampler::stratified, block), stratifiedBlock(plan, index, block));
        EXPECT_EQ(blockOf(PixelSampler::sobol, block), sobolBlock(plan, index, block));
        EXPECT_EQ(blockOf(PixelSampler::sobolBlueNoise, block), sobolBlueNoiseBlock(plan, index, block));
    }
}

/// Every pixel estimates the same: a floor's radiance under a sphere, smooth in both numbers of a light sample.
struct FloorUnderSphere {
    Scene scene;
    double expected = 0.0;

    FloorUnderSphere() {
        SceneBuilder builder;
        builder.mesh(squareMesh(0), scaling({100.0, 100.0, 1.0}));
        builder.scene.spheres.push_back(
            {"", {1.0, 0.0, 2.0}, 1.5, builder.material(Vec3d(0.0), Vec3d(1.0), Faces::front)});
        builder.camera({3.0, 0.0, 0.2}, Vec3d(0.0), 1e-9);
        scene = builder.scene;
        // (r/d)^2 cos(angle of the centre), wholly above the horizon (Howell, configuration B-39).
        expected = 1.5 * 1.5 / 5.0 * (2.0 / std::sqrt(5.0));
    }
};

Film renderSmooth(PixelSampler sampler, std::uint32_t samples) {
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.sampleCount = samples;
    settings.maxDepth = 1;
    settings.lightSampling = LightSampling::light;
    settings.sampler = sampler;
    return render(FloorUnderSphere().scene, settings);
}

double squaredError(const Film& film) {
    double sum = 0.0;
    for (const PixelStatistics& pixel : film.pixels) {
        const double error = pixel.mean.y - FloorUnderSphere().expected;
        sum += error * error / static_cast<double>(film.pixels.size());
    }
    return sum;
}

TEST(ReferenceSamplers, SmoothIntegralsHaveLessErrorThanByIndependentSamples) {
    const double independent = squaredError(renderSmooth(PixelSampler::independent, 256));
    // 16 samples a replicate: jittering n cells of a smooth integrand in two dimensions divides the variance by some n,
    // nested scrambling by more. The square root of the ratio is asked for, far from what chance does to 256 pixels.
    for (const PixelSampler sampler : kDependent)
        EXPECT_LT(squaredError(renderSmooth(sampler, 256)), independent / 4.0);
}

TEST(ReferenceSamplers, VarianceIsThatOfTheMeansByTheirReplicates) {
    for (const PixelSampler sampler : {PixelSampler::independent, PixelSampler::stratified, PixelSampler::sobol}) {
        const Film film = renderSmooth(sampler, 128);
        EXPECT_EQ(film.replicates.size(), usesReplicates(sampler) ? film.pixels.size() : 0u);
        double told = 0.0;
        for (const PixelStatistics& pixel : film.pixels)
            told += pixel.variance().y / static_cast<double>(pixel.sampleCount * film.pixels.size());
        // Of 256 independent pixels with 15 degrees of freedom each: relative deviations of sqrt(2/256) and
        // sqrt(2/(15 * 256)), if errors are normal. Three comparisons with one false alarm in 1e5 each.
        const double deviation = std::sqrt(2.0 / 256.0 + 2.0 / (15.0 * 256.0));
        EXPECT_NEAR(squaredError(film) / told, 1.0, 4.5 * deviation);
    }
}

TEST(ReferenceSamplers, MeansAreThoseOfIndependentSamples) {
    for (const PixelSampler sampler : kDependent) {
        const Film film = renderSmooth(sampler, 128);
        double mean = 0.0;
        for (const PixelStatistics& pixel : film.pixels) mean += pixel.mean.y / 256.0;
        // Pixels of blue noise share a sequence, so that only the errors' size is known: all 256 together err less than
        // one, by its root mean square, times 4.5.
        EXPECT_NEAR(mean, FloorUnderSphere().expected, 4.5 * std::sqrt(squaredError(film)));
    }
}

TEST(ReferenceSamplers, ReplicatesHoldTheFilmsSamples) {
    RenderSettings settings = smallSettings(21);
    settings.firstSample = 9;
    settings.sampler = PixelSampler::sobol;
    const Film film = render(smallRoom(), settings);
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        Vec3d sum(0.0);
        for (std::uint32_t r = 0; r < kReplicates; ++r) {
            sum += film.replicates[i].sum[r];
            ASSERT_EQ(film.replicates[i].sampleCount[r], r >= 9 && r < 14 ? 2u : 1u) << "samples 9 ... 29";
        }
        // Sums of 21 terms of which none is negative, and as many steps of the mean that round four times each.
        const Vec3d& mean = film.pixels[i].mean;
        for (int channel = 0; channel < 3; ++channel)
            ASSERT_NEAR(sum[channel] / 21.0, mean[channel], 21.0 * roundingBound<double>(5 * 21) * mean[channel]);
    }
}

TEST(ReferenceSamplers, FilmsDoNotDependOnRegions) {
    for (const PixelSampler sampler : kDependent) {
        RenderSettings settings = smallSettings(5);
        settings.sampler = sampler;
        const Film film = render(smallRoom(), settings);
        const Film part = renderReferenceRegion(smallRoom(), settings, {}, {9, 4, 5, 3}, {});
        for (std::uint32_t y = 0; y < 3; ++y)
            for (std::uint32_t x = 0; x < 5; ++x) ASSERT_EQ(part.at(x, y), film.at(9 + x, 4 + y));
    }
}

} // namespace
} // namespace isolux
