// How often the intervals of fits and ratios hold the truth, over many synthetic experiments.
#include "convergence_samples.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace convergence_test;

constexpr int kExperiments = 200;
/// Of 95 % intervals: the bootstrap of 16 seeds is somewhat short of its nominal coverage.
constexpr int kEnough = kExperiments * 90 / 100;

FitOptions fewResamples(std::vector<double> errors) { return {std::move(errors), 200}; }

std::vector<ErrorSample> joined(std::vector<ErrorSample> a, const std::vector<ErrorSample>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Samples of a skewness of 3.5, two renderers of which one needs half the samples.
TEST(ConvergenceCoverage, PlainMonteCarlo) {
    Synthetic plain;
    plain.variance = 3.0;
    Synthetic better = plain;
    better.name = "better";
    better.variance = 1.5;
    const double error = std::sqrt(plain.variance / 50.0); // after 50 samples: between checkpoints
    std::mt19937_64 random(6);
    int mse = 0, slopeSamples = 0, slopeTime = 0, floor = 0, holds = 0, time = 0, ratio = 0;
    for (int i = 0; i < kExperiments; ++i) {
        const auto samples = joined(renderSynthetic(plain, random), renderSynthetic(better, random));
        const ConvergenceReport report = summarise(samples, exactReference(), fewResamples({error}));
        const VariantSummary& variant = report.variants[0];
        mse += variant.checkpoints[3].mse.contains(plain.variance / 8.0);
        slopeSamples += variant.slopeSamples.contains(-1.0);
        slopeTime += variant.slopeTime.contains(-1.0);
        floor += variant.floor.contains(0.0);
        holds += variant.slopeHolds;
        time += variant.timeTo[0].seconds.contains(50.0 * plain.secondsPerSample);
        ASSERT_EQ(report.ratios.size(), 1u);
        EXPECT_EQ(report.ratios[0].faster, "better");
        ratio += report.ratios[0].ratio.contains(2.0);
    }
    for (const int count : {mse, slopeSamples, slopeTime, floor, holds, time, ratio}) EXPECT_GE(count, kEnough);
    // Intervals so wide that they always hold would say nothing.
    for (const int count : {slopeSamples, floor, time, ratio}) EXPECT_LT(count, kExperiments);
}

/// A squared bias of half the variance of the last checkpoint: no eye sees it in the image, and the fit finds it.
TEST(ConvergenceCoverage, PlantedFloorIsFound) {
    Synthetic biased;
    biased.variance = 0.5;
    biased.pixels = 256;
    biased.bias = std::sqrt(0.5 * biased.variance / 128.0);
    std::mt19937_64 random(6);
    int found = 0, held = 0, contained = 0;
    constexpr int kFewer = 50;
    for (int i = 0; i < kFewer; ++i) {
        const ConvergenceReport report =
            summarise(renderSynthetic(biased, random), exactReference(), fewResamples({0.05}));
        found += report.variants[0].floor.low > 0.0;
        held += report.variants[0].slopeHolds;
        contained += report.variants[0].floor.contains(biased.bias * biased.bias);
    }
    EXPECT_GE(found, kFewer * 9 / 10);
    EXPECT_EQ(held, 0);
    EXPECT_GE(contained, kFewer * 85 / 100);
}

/// Resamples are paired: where two variants make the same errors on the same seeds, their ratio has no noise left.
TEST(ConvergenceCoverage, SharedRandomNumbersSharpenRatios) {
    std::mt19937_64 random(6);
    const std::vector<ErrorSample> samples = renderSynthetic({}, random);
    std::vector<ErrorSample> twice = samples;
    for (ErrorSample sample : samples) {
        sample.variant = "twice as slow";
        sample.wallSeconds *= 2.0;
        twice.push_back(sample);
    }
    const ConvergenceReport report = summarise(twice, exactReference(), fewResamples({0.2}));
    ASSERT_EQ(report.ratios.size(), 1u);
    EXPECT_NEAR(report.ratios[0].ratio.low, 2.0, 1e-12);
    EXPECT_NEAR(report.ratios[0].ratio.high, 2.0, 1e-12);
    EXPECT_GT(report.variants[0].timeTo[0].seconds.high, 1.05 * report.variants[0].timeTo[0].seconds.low);
}

} // namespace
} // namespace isolux
