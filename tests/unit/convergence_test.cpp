// Fits, times, ratios and what is refused: samples that follow a law exactly, so that every figure is known.
#include "convergence_samples.h"
#include "core/error.h"
#include "report/convergence_fit.h"
#include "report_images.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace isolux {
namespace {

using namespace convergence_test;
using test::expectMentions;
using test::kNan;

ConvergenceReport summarised(const std::vector<ErrorSample>& samples, std::vector<double> errors = {0.05}) {
    return summarise(samples, exactReference(), {std::move(errors), 100});
}

VariantSummary summaryOf(const std::vector<ErrorSample>& samples, std::vector<double> errors = {0.05}) {
    return summarised(samples, std::move(errors)).variants.at(0);
}

std::string refusal(const std::vector<ErrorSample>& samples) {
    try {
        (void)summarised(samples);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::badInput);
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

// --- Fits ---

TEST(Convergence, ExactPowersGiveTheirExponentAndNoFloor) {
    for (const double exponent : {0.6, 1.0, 1.5, 2.5}) {
        const VariantSummary variant = summaryOf(exactSamples({}, exponent, 0.0));
        for (const Interval& slope : {variant.slopeSamples, variant.slopeTime}) {
            EXPECT_NEAR(slope.low, -exponent, 1e-10);
            EXPECT_NEAR(slope.estimate, -exponent, 1e-10);
            EXPECT_NEAR(slope.high, -exponent, 1e-10);
        }
        EXPECT_EQ(variant.floor.estimate, 0.0);
        EXPECT_EQ(variant.slopeHolds, exponent >= 1.0) << exponent;
        EXPECT_NEAR(variant.efficiency.estimate * 1.28 * std::pow(128.0, -exponent), 1.0, 1e-12);
    }
}

TEST(Convergence, FloorIsRelativeToTheReference) {
    ReferenceQuality reference = exactReference();
    reference.mean = 2.0;
    const VariantSummary variant = summarise(exactSamples({}, 1.3, 0.02), reference, {{0.05}, 100}).variants.at(0);
    EXPECT_NEAR(variant.floor.estimate, 0.02 / 4.0, 1e-7);
    EXPECT_FALSE(variant.slopeHolds);
    EXPECT_NEAR(variant.checkpoints[0].relativeRmse.estimate, std::sqrt(1.02) / 2.0, 1e-12);
}

/// Without a reference at hand (a file alone) its mean follows from MSE and relative RMSE of the samples.
TEST(Convergence, MeanOfTheReferenceFollowsFromTheSamples) {
    std::vector<ErrorSample> samples = exactSamples({}, 1.0, 0.0);
    for (ErrorSample& sample : samples) sample.relativeRmse = std::sqrt(sample.mse) / 3.0;
    const VariantSummary variant = summarise(samples, {}, {{0.1}, 100}).variants.at(0);
    EXPECT_NEAR(variant.checkpoints[0].relativeRmse.estimate, 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(variant.timeTo[0].seconds.estimate, 0.01 / (0.3 * 0.3), 1e-9);
    EXPECT_TRUE(std::isnan(variant.checkpoints[0].raysPerPixel));
}

TEST(Convergence, LinesAreFittedFromFourSamplesOn) {
    std::vector<ErrorSample> samples = exactSamples({}, 1.0, 0.0);
    for (ErrorSample& sample : samples)
        if (sample.checkpoint < 2) sample.mse *= 3.0;
    EXPECT_NEAR(summaryOf(samples).slopeSamples.estimate, -1.0, 1e-10);
    Synthetic few;
    few.checkpoints = 5; // three of them with four samples or more: too few, so that all count
    samples = exactSamples(few, 1.0, 0.0);
    for (ErrorSample& sample : samples)
        if (sample.checkpoint < 2) sample.mse *= 3.0;
    EXPECT_LT(summaryOf(samples).slopeSamples.estimate, -1.2);
}

TEST(Convergence, ErrorsThatAreNotPositiveAreLeftOutOfLogarithms) {
    std::vector<ErrorSample> samples = exactSamples({}, 1.0, 0.0);
    for (ErrorSample& sample : samples)
        if (sample.checkpoint == 5) sample.mse = -1e-4;
    const VariantSummary variant = summaryOf(samples, {0.15});
    EXPECT_NEAR(variant.slopeSamples.estimate, -1.0, 1e-10);
    EXPECT_NEAR(variant.checkpoints[5].relativeRmse.estimate, -0.01, 1e-12); // not clamped: its root with its sign
    EXPECT_NEAR(variant.timeTo[0].seconds.estimate, 0.01 / (0.15 * 0.15), 1e-9);
}

TEST(Convergence, NanIsNotHidden) {
    std::vector<ErrorSample> samples = exactSamples({}, 1.0, 0.0);
    samples[5].mse = kNan;
    const VariantSummary variant = summaryOf(samples, {0.5, 0.05});
    EXPECT_TRUE(std::isnan(variant.slopeSamples.estimate));
    EXPECT_TRUE(std::isnan(variant.floor.estimate));
    EXPECT_FALSE(variant.slopeHolds);
    EXPECT_EQ(variant.timeTo[0].reason, ""); // reached before
    EXPECT_EQ(variant.timeTo[1].reason, "the error is not known");
}

TEST(Convergence, OneSeedHasNoIntervals) {
    Synthetic one;
    one.seeds = 1;
    const VariantSummary variant = summaryOf(exactSamples(one, 1.0, 0.0), {0.2, 0.01});
    EXPECT_NEAR(variant.slopeSamples.estimate, -1.0, 1e-10);
    EXPECT_FALSE(variant.slopeSamples.known());
    EXPECT_FALSE(variant.checkpoints[0].mse.known());
    EXPECT_FALSE(variant.slopeHolds);
    EXPECT_NEAR(variant.timeTo[0].seconds.estimate, 0.25, 1e-9);
    EXPECT_EQ(variant.timeTo[1].reason, "not reached; the slope has no interval");
}

/// Hesterberg 2015: at 16 seeds the percentiles are those of z = sqrt(16/15) 2.1314, 1.386 % and 98.614 %.
TEST(Convergence, PercentilesAreExpanded) {
    std::vector<double> values;
    for (int i = 0; i <= 10000; ++i) values.push_back(i);
    const Interval interval = percentileInterval(5000.0, values, 16);
    EXPECT_EQ(interval.low, 138.0);
    EXPECT_EQ(interval.high, 10000.0 - 138.0);
    std::fill(values.begin(), values.begin() + 501, kNan); // more than 5 %
    EXPECT_FALSE(percentileInterval(5000.0, values, 16).known());
}

// --- Checkpoints ---

TEST(Convergence, CheckpointsAreMeansAndMedians) {
    Synthetic three;
    three.seeds = 3;
    three.checkpoints = 1;
    std::vector<ErrorSample> samples = exactSamples(three, 1.0, 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        samples[i].mse = static_cast<double>(i); // 0, 1, 2
        samples[i].wallSeconds = i == 0 ? 100.0 : 1.0 + static_cast<double>(i);
        samples[i].estimate = i == 0 ? 5.0 : 1.0;
        samples[i].rays = 30 * i;
        samples[i].setupSeconds = static_cast<double>(i * i);
    }
    ReferenceQuality reference = exactReference();
    reference.pixels = 10;
    const VariantSummary variant = summarise(samples, reference, {{0.05}, 100}).variants.at(0);
    const CheckpointSummary& checkpoint = variant.checkpoints.at(0);
    EXPECT_EQ(checkpoint.mse.estimate, 1.0);
    EXPECT_NEAR(checkpoint.mse.high, 1.0 + 4.302652729749464 / std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(checkpoint.relativeRmse.low, -std::sqrt(4.302652729749464 / std::sqrt(3.0) - 1.0), 1e-9);
    EXPECT_EQ(checkpoint.wallSeconds, 3.0);
    EXPECT_TRUE(std::isnan(checkpoint.deviceSeconds));
    EXPECT_EQ(checkpoint.raysPerPixel, 3.0);
    EXPECT_NEAR(checkpoint.estimate.estimate, 3.0, 1e-12); // the root of the mean square
    EXPECT_EQ(variant.setupSeconds, 1.0);
    EXPECT_EQ(variant.seeds, 3u);
}

/// The error of a reference's mean is one for all seeds: their scatter does not show it.
TEST(Convergence, BiasCountsTheErrorOfTheReference) {
    Synthetic two;
    two.seeds = 2;
    two.checkpoints = 1;
    std::vector<ErrorSample> samples = exactSamples(two, 1.0, 0.0);
    samples[0].bias = 0.01;
    samples[1].bias = 0.03;
    ReferenceQuality reference = exactReference();
    reference.relativeBiasError = 0.1;
    const Interval bias = summarise(samples, reference, {{0.05}, 100}).variants.at(0).checkpoints.at(0).bias;
    const double half = std::hypot(0.01 * 12.706204736174706, 0.1 * 1.959963984540054);
    EXPECT_NEAR(bias.low, 0.02 - half, 1e-12);
    EXPECT_NEAR(bias.high, 0.02 + half, 1e-12);
}

TEST(Convergence, SharesHaveWilsonsInterval) {
    // Of 10 in 10, by hand: center (1 + z^2/20)/(1 + z^2/10).
    const Interval all = Coverage{10, 10}.share();
    EXPECT_NEAR(all.low, 0.7224672001371107, 1e-12);
    EXPECT_EQ(all.estimate, 1.0);
    EXPECT_NEAR(all.high, 1.0, 1e-15);
    const Interval half = Coverage{5, 10}.share();
    EXPECT_NEAR(half.low, 0.2365930, 1e-6);
    EXPECT_NEAR(half.high, 0.7634070, 1e-6);
    EXPECT_FALSE(Coverage{}.share().known());
}

TEST(Convergence, NoisyReferencesAreNamed) {
    const ConvergenceReport report = summarised(exactSamples({}, 1.0, 0.0));
    ReferenceQuality reference = exactReference();
    EXPECT_TRUE(tooNoisyFor(report, reference).empty());
    reference.mse = 0.011 / 64.0;
    EXPECT_EQ(tooNoisyFor(report, reference), (std::vector<std::string>{"plain@6", "plain@7"}));
    EXPECT_NEAR(reference.relativeRmse(), std::sqrt(0.011) / 8.0, 1e-12);
}

// --- Times and ratios ---

TEST(Convergence, TimesAreInterpolatedInLogarithms) {
    const VariantSummary variant = summaryOf(exactSamples({}, 1.5, 0.0), {0.1});
    EXPECT_NEAR(variant.timeTo[0].seconds.estimate, 0.01 * std::pow(100.0, 1.0 / 1.5), 1e-9);
    EXPECT_NEAR(variant.timeTo[0].seconds.low, variant.timeTo[0].seconds.high, 1e-9);
    EXPECT_FALSE(variant.timeTo[0].extrapolated);
    EXPECT_EQ(variant.timeTo[0].reason, "");
}

TEST(Convergence, TimesAreExtrapolatedOnlyWhereTheSlopeHolds) {
    const VariantSummary plain = summaryOf(exactSamples({}, 1.0, 0.0), {0.01});
    EXPECT_TRUE(plain.timeTo[0].extrapolated);
    EXPECT_NEAR(plain.timeTo[0].seconds.estimate, 100.0, 1e-6);
    const VariantSummary slow = summaryOf(exactSamples({}, 0.6, 0.0), {0.01});
    EXPECT_FALSE(slow.timeTo[0].extrapolated);
    EXPECT_TRUE(std::isnan(slow.timeTo[0].seconds.estimate));
    EXPECT_EQ(slow.timeTo[0].reason, "not reached; slope -0.6 [-0.6, -0.6] does not hold");
    const VariantSummary biased = summaryOf(exactSamples({}, 1.3, 1e-3), {0.01});
    expectMentions(biased.timeTo[0].reason, "not reached; ");
}

/// Beyond the last checkpoint time is proportional to samples: start-up that is part of all times so far makes the
/// slope over time too steep, and must not make the future too short.
TEST(Convergence, ExtrapolationGoesBySamples) {
    std::vector<ErrorSample> samples = exactSamples({}, 1.0, 0.0);
    for (ErrorSample& sample : samples) sample.wallSeconds += 0.2;
    const VariantSummary variant = summaryOf(samples, {0.01});
    EXPECT_LT(variant.slopeTime.estimate, -1.1);
    EXPECT_NEAR(variant.timeTo[0].seconds.estimate, 1.48 * 10000.0 / 128.0, 1e-6);
}

TEST(Convergence, AnErrorReachedAtOnceHasNoTime) {
    const TimeToError time = summaryOf(exactSamples({}, 1.0, 0.0), {1.5}).timeTo.at(0);
    EXPECT_TRUE(std::isnan(time.seconds.estimate));
    EXPECT_EQ(time.reason, "reached at the first checkpoint: within 0.01 s");
}

TEST(Convergence, RatiosNameTheFasterFirst) {
    std::vector<ErrorSample> samples = exactSamples({}, 1.0, 0.0);
    Synthetic faster;
    faster.name = "faster";
    faster.secondsPerSample = 0.0025;
    faster.firstSeed = 100;
    faster.seeds = 5;
    for (const ErrorSample& sample : exactSamples(faster, 1.0, 0.0)) samples.push_back(sample);
    const ConvergenceReport report = summarised(samples, {0.1, 0.01, 1.5});
    ASSERT_EQ(report.ratios.size(), 2u); // 1.5 is reached at once: no ratio
    EXPECT_EQ(report.ratios[0].faster, "faster");
    EXPECT_EQ(report.ratios[0].slower, "plain");
    EXPECT_NEAR(report.ratios[0].ratio.estimate, 4.0, 1e-9);
    EXPECT_EQ(sentence(report.ratios[0]), "faster reaches 10 % relative RMSE 4 (4-4) times sooner than plain");
    EXPECT_TRUE(report.ratios[1].extrapolated);
    EXPECT_EQ(sentence(report.ratios[1]),
              "faster reaches 1 % relative RMSE 4 (4-4) times sooner than plain, extrapolated");
    SpeedRatio large{"b", "a", 0.05, {1234.4, 3456.7, 9876.5}, false};
    EXPECT_EQ(sentence(large), "b reaches 5 % relative RMSE 3457 (1234-9876) times sooner than a");
}

TEST(Convergence, ResultsAreReproducible) {
    std::mt19937_64 random(1);
    const std::vector<ErrorSample> samples = renderSynthetic({}, random);
    EXPECT_EQ(toJson(summarised(samples)).dump(), toJson(summarised(samples)).dump());
}

// --- What is refused ---

TEST(Convergence, RefusesSamplesThatDoNotFit) {
    const std::vector<ErrorSample> good = exactSamples({}, 1.0, 0.0);
    std::vector<ErrorSample> samples = good;
    samples.pop_back();
    EXPECT_EQ(refusal(samples), "variant \"plain\": seed 15, checkpoint 0: the seed has 7 of 8 checkpoints");
    samples = good;
    samples[3].checkpoint = 9;
    EXPECT_EQ(refusal(samples),
              "variant \"plain\": seed 0, checkpoint 4: every seed must have the same checkpoints, from 0 to 7");
    samples = good;
    samples.push_back(good[9]);
    EXPECT_EQ(refusal(samples), "variant \"plain\": seed 1, checkpoint 1: given twice");
    samples = good;
    samples[0].wallSeconds = 0.0;
    expectMentions(refusal(samples), "wall seconds must be above 0");
    samples[0].wallSeconds = kNan;
    expectMentions(refusal(samples), "wall seconds must be above 0");
    samples = good;
    samples[0].samplesPerPixel = 0.0;
    expectMentions(refusal(samples), "samples must be above 0");
    EXPECT_TRUE(summarised({}).variants.empty());
}

} // namespace
} // namespace isolux
