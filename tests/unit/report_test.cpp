// Metrics, intervals, limits and reports: hand-computed values, and coverage by simulation.
#include "core/error.h"
#include "report/comparison.h"
#include "report/format.h"
#include "report/paired_limits.h"
#include "report/run_report.h"
#include "report_images.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <random>

namespace isolux {
namespace {

using namespace test;

/// A render of `scene` as a renderer would leave it: every pixel the mean of `samples` exponential variables times the
/// pixel's true value, its channels fully dependent.
Image noisyImage(std::mt19937& engine, double scale, int samples) {
    std::exponential_distribution<double> noise(1.0);
    Film film(20, 20);
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const double truth = scale * (0.1 + static_cast<double>(i % 20));
        for (int s = 0; s < samples; ++s) film.pixels[i].add(Vec3d(1.0, 0.5, 0.25) * (truth * noise(engine)));
    }
    return imageFromFilm(film, {});
}

// --- Statistics ---

TEST(Statistics, NormalQuantilesMatchTables) {
    EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-13);
    EXPECT_NEAR(normalQuantile(0.995), 2.5758293035489004, 1e-13);
    EXPECT_NEAR(normalQuantile(0.9), 1.2815515655446004, 1e-13);
    EXPECT_NEAR(normalQuantile(0.025), -1.959963984540054, 1e-13);
    EXPECT_NEAR(normalQuantile(1e-10), -6.361340902404056, 1e-12);
    EXPECT_NEAR(normalQuantile(0.5), 0.0, 1e-15);
    EXPECT_EQ(normalQuantile(0.0), -kInfinity);
    EXPECT_EQ(normalQuantile(1.0), kInfinity);
    EXPECT_TRUE(std::isnan(normalQuantile(1.5)));
    EXPECT_TRUE(std::isnan(normalQuantile(kNan)));
}

TEST(Statistics, NormalQuantileInvertsTheDistribution) {
    for (const double p : {1e-300, 1e-30, 1e-5, 0.01, 0.3, 0.4999, 0.5}) {
        EXPECT_NEAR(0.5 * std::erfc(-normalQuantile(p) / std::sqrt(2.0)) / p, 1.0, 1e-12) << p;
    }
}

TEST(Statistics, StudentQuantilesMatchTables) {
    EXPECT_NEAR(studentQuantile(0.975, 1), 12.706204736174706, 1e-9);
    EXPECT_NEAR(studentQuantile(0.975, 2), 4.302652729749464, 1e-9);
    EXPECT_NEAR(studentQuantile(0.975, 5), 2.570581835636314, 1e-9);
    EXPECT_NEAR(studentQuantile(0.975, 15), 2.131449545559323, 1e-9);
    EXPECT_NEAR(studentQuantile(0.975, 30), 2.042272456301238, 1e-9);
    EXPECT_NEAR(studentQuantile(0.995, 10), 3.169272672616872, 1e-9);
    EXPECT_NEAR(studentQuantile(0.975, 1e6), 1.9599663569, 1e-9);
    EXPECT_NEAR(studentQuantile(0.025, 5), -studentQuantile(0.975, 5), 1e-12);
    EXPECT_NEAR(studentQuantile(0.5, 3), 0.0, 1e-15);
    EXPECT_TRUE(std::isnan(studentQuantile(0.975, 0.0)));
}

TEST(Statistics, StudentQuantileIsContinuousWhereItsMethodChanges) {
    EXPECT_NEAR(studentQuantile(0.975, 9999.999), studentQuantile(0.975, 10000.0), 1e-10);
    EXPECT_NEAR(studentQuantile(0.9999, 9999.999), studentQuantile(0.9999, 10000.0), 1e-8);
}

TEST(Statistics, StudentQuantileInvertsTheTail) {
    EXPECT_NEAR(studentUpperTail(1.0, 1.0), 0.25, 1e-15); // Cauchy
    for (const double degrees : {0.5, 1.0, 2.5, 7.0, 100.0, 5000.0}) {
        for (const double tail : {1e-8, 0.001, 0.025, 0.3}) {
            const double t = -studentQuantile(tail, degrees);
            EXPECT_NEAR(studentUpperTail(t, degrees) / tail, 1.0, 1e-9) << degrees << " " << tail;
        }
    }
}

TEST(Statistics, MeanIntervalOfAKnownSample) {
    const std::vector<double> values{1.0, 2.0, 3.0, 4.0, 5.0};
    const Interval interval = meanInterval(values);
    const double half = 2.7764451051977987 * std::sqrt(2.5 / 5.0);
    EXPECT_DOUBLE_EQ(interval.estimate, 3.0);
    EXPECT_NEAR(interval.low, 3.0 - half, 1e-9);
    EXPECT_NEAR(interval.high, 3.0 + half, 1e-9);
    EXPECT_FALSE(meanInterval(std::vector<double>{1.0}).known());
    EXPECT_TRUE(std::isnan(mean({})));
}

TEST(Statistics, MeanIntervalCoversTheMeanAsOftenAsItSays) {
    std::mt19937 engine(1);
    std::normal_distribution<double> normal(5.0, 2.0);
    int covered = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const std::vector<double> values{normal(engine), normal(engine), normal(engine), normal(engine)};
        covered += meanInterval(values).contains(5.0);
    }
    expectBinomial(covered, 4000, kConfidence);
}

// --- Metrics ---

TEST(Metrics, HandComputedImage) {
    const Image image = rgbImage(2, 1, {1.0f, 2.0f, 3.0f, 0.0f, 0.0f, 0.5f});
    const Image reference = rgbImage(2, 1, {1.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f});
    const ImageErrors errors = compareImages(image, reference).errors;
    EXPECT_DOUBLE_EQ(errors.mse, (1.0 + 4.0 + 0.25) / 6.0);
    EXPECT_DOUBLE_EQ(errors.rmse, std::sqrt(5.25 / 6.0));
    EXPECT_DOUBLE_EQ(errors.relativeRmse, std::sqrt(5.25 / 6.0) / 0.5);
    EXPECT_DOUBLE_EQ(errors.relMse.estimate, (1.0 / 1.01 + 4.0 / 1.01 + 0.25 / 0.01) / 6.0);
    EXPECT_DOUBLE_EQ(errors.mae, 3.5 / 6.0);
    EXPECT_DOUBLE_EQ(errors.maxAbs, 2.0);
    EXPECT_DOUBLE_EQ(errors.imageMean.rgb.z, 1.75);
    EXPECT_DOUBLE_EQ(errors.referenceMean.luminance, 0.5);
    EXPECT_EQ(errors.pixelCount, 2u);
    EXPECT_EQ(errors.litPixelCount, 1u);
    EXPECT_TRUE(std::isnan(errors.noiseMse));
}

TEST(Metrics, EqualImagesDoNotDiffer) {
    const Image image = uniformImage(40, 40, 0.7f);
    const ComparisonReport report = compareImages(image, image, {0.0, 0.0});
    EXPECT_EQ(report.errors.mse, 0.0);
    EXPECT_EQ(report.errors.relMse.estimate, 0.0);
    EXPECT_EQ(report.bias.luminance.estimate, 0.0);
    EXPECT_EQ(report.verdict(), Verdict::within);
    const Image black = uniformImage(4, 4, 0.0f);
    EXPECT_EQ(compareImages(black, black, {0.0, 0.0}).verdict(), Verdict::within);
    EXPECT_EQ(compareImages(image, uniformImage(40, 40, 0.0f), {1e9, {}}).verdict(), Verdict::exceeded);
}

TEST(Metrics, NonFinitePixelsAreCountedAndSpoilTheErrors) {
    Image image = uniformImage(2, 2, 1.0f);
    image.values[0] = NAN;
    image.values[1] = -1.0f;
    image.values[3] = INFINITY;
    const ComparisonReport report = compareImages(image, uniformImage(2, 2, 1.0f), {0.1, 0.1});
    EXPECT_EQ(report.errors.imageDefects.nan, 1u);
    EXPECT_EQ(report.errors.imageDefects.infinite, 1u);
    EXPECT_EQ(report.errors.imageDefects.negative, 1u);
    EXPECT_TRUE(report.errors.referenceDefects.finite());
    for (const double value : {report.errors.mse, report.errors.relativeRmse, report.errors.relMse.estimate,
                               report.errors.relMseTrimmed, report.errors.maxAbs}) {
        EXPECT_TRUE(std::isnan(value));
    }
    EXPECT_EQ(report.verdict(), Verdict::exceeded);
    const std::string text = toText(report);
    expectMentions(text, "1 pixels hold NaN and 1 infinity");
    expectMentions(text, "nan");
    EXPECT_EQ(text.find("-nan"), std::string::npos);
    EXPECT_TRUE(nlohmann::ordered_json::parse(jsonText(toJson(report)))["mse"].is_null());
}

TEST(Metrics, TrimmedRelMseLeavesOutTheWorstThousandth) {
    Image image = uniformImage(50, 40, 1.0f);
    image.values[0] = image.values[1] = image.values[2] = 1000.0f; // one firefly; two of 2000 pixels are left out
    const ImageErrors errors = compareImages(image, uniformImage(50, 40, 1.0f)).errors;
    EXPECT_GT(errors.relMse.estimate, 400.0);
    EXPECT_EQ(errors.relMseTrimmed, 0.0);
}

TEST(Metrics, SizesAndChannelsMustFit) {
    EXPECT_THROW((void)compareImages(uniformImage(2, 3, 0.0f), uniformImage(3, 2, 0.0f)), Error);
    try {
        (void)compareImages(uniformImage(2, 2, 0.0f), makeImage(2, 2, {"Y", "Z"}));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::badInput);
        expectMentions(error.what(), "Y, Z");
    }
}

TEST(Metrics, NoiseExplainsTheErrorOfUnbiasedImages) {
    std::mt19937 engine(5);
    const ImageErrors errors = compareImages(noisyImage(engine, 1.0, 64), noisyImage(engine, 1.0, 64)).errors;
    EXPECT_NEAR(errors.noiseMse / errors.mse, 1.0, 0.25);
}

TEST(StratifiedMean, CoversTheMeanDespiteTheImage) {
    std::mt19937 engine(2);
    std::exponential_distribution<double> noise(1.0);
    int covered = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        std::vector<double> pixels(48 * 32);
        for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = (i % 48 < 16 ? 10.0 : 1.0) * noise(engine);
        covered += stratifiedMean(pixels, 48).contains(4.0);
    }
    expectBinomial(covered, 1000, kConfidence);
}

TEST(StratifiedMean, ABadBlockIsNotNoise) {
    std::vector<double> pixels(64 * 64, 0.0);
    for (std::size_t y = 0; y < 16; ++y) {
        for (std::size_t x = 0; x < 16; ++x) pixels[y * 64 + x] = 1.0;
    }
    const Interval interval = stratifiedMean(pixels, 64);
    EXPECT_DOUBLE_EQ(interval.estimate, 1.0 / 16.0);
    EXPECT_DOUBLE_EQ(interval.low, 1.0 / 16.0);
    EXPECT_FALSE(stratifiedMean(std::vector<double>{1.0}, 1).known());
}

// --- Bias ---

TEST(RelativeBias, HandComputedInterval) {
    const std::vector<std::string> channels{"R",          "G",          "B",          "variance.R",
                                            "variance.G", "variance.B", "variance.Y", "samples.Y"};
    Image image = makeImage(2, 1, channels);
    image.values = {1.2f, 1.0f, 1.0f, 4.0f, 0.0f, 0.0f, 1.0f, 4.0f, 1.0f, 1.0f, 1.0f, 8.0f, 0.0f, 0.0f, 1.0f, 4.0f};
    const RelativeBias bias = compareImages(image, uniformImage(2, 1, 1.0f)).bias;
    EXPECT_EQ(bias.method, BiasMethod::imageOnly);
    EXPECT_NEAR(bias.channels[0].estimate, 0.1, 1e-7);
    EXPECT_NEAR(bias.channels[0].high - bias.channels[0].estimate, 1.959964 * std::sqrt((1.0 + 2.0) / 4.0), 1e-6);
    EXPECT_NEAR(bias.luminance.high - bias.luminance.estimate, 1.959964 * std::sqrt(0.5 / 4.0), 1e-6);
    EXPECT_DOUBLE_EQ(bias.channels[1].low, bias.channels[1].high);
}

TEST(RelativeBias, LuminanceIsBoundedWhereOnlyChannelsCarryVariance) {
    Image image = makeImage(1, 1, {"R", "G", "B", "variance.R", "variance.G", "variance.B", "samples.Y"});
    image.values = {1.0f, 1.0f, 1.0f, 4.0f, 4.0f, 4.0f, 4.0f};
    const ComparisonReport report = compareImages(image, uniformImage(1, 1, 1.0f));
    EXPECT_NEAR(report.bias.luminance.high, 1.959964 * 1.0, 1e-5); // the channels' deviations add up to 2, over sqrt(4)
    expectMentions(toText(report), "upper bound");
    Image errors = makeImage(1, 1, {"R", "G", "B", "se.R", "se.G", "se.B"}, 1.0f);
    EXPECT_NEAR(compareImages(errors, uniformImage(1, 1, 1.0f)).bias.luminance.high, 1.959964, 1e-5);
}

TEST(RelativeBias, SingleSamplesHaveNoInterval) {
    Film film(2, 2);
    for (PixelStatistics& pixel : film.pixels) pixel.add(Vec3d(1.0));
    const ComparisonReport report = compareImages(imageFromFilm(film, {}), uniformImage(2, 2, 1.0f));
    EXPECT_EQ(report.bias.method, BiasMethod::none);
    EXPECT_FALSE(report.bias.luminance.known());
    EXPECT_EQ(report.bias.luminance.estimate, 0.0);
}

TEST(RelativeBias, IntervalCoversTheTruthAsOftenAsItSays) {
    std::mt19937 engine(9);
    int covered = 0;
    int coveredRed = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const Image image = noisyImage(engine, 1.1, 16);
        const RelativeBias bias = relativeBias(image, noisyImage(engine, 1.0, 32));
        ASSERT_EQ(bias.method, BiasMethod::independent);
        covered += bias.luminance.contains(0.1);
        coveredRed += bias.channels[0].contains(0.1);
    }
    expectBinomial(covered, 1000, kConfidence);
    expectBinomial(coveredRed, 1000, kConfidence);
}

TEST(RelativeBias, ASeededBiasIsDetected) {
    std::mt19937 engine(4);
    int exceeded = 0;
    int falseAlarms = 0;
    for (int trial = 0; trial < 50; ++trial) {
        const Image reference = noisyImage(engine, 1.0, 100);
        exceeded += compareImages(noisyImage(engine, 1.05, 100), reference, {0.02, {}}).verdict() == Verdict::exceeded;
        falseAlarms +=
            compareImages(noisyImage(engine, 1.0, 100), reference, {0.02, {}}).verdict() == Verdict::exceeded;
    }
    EXPECT_GE(exceeded, 45);
    EXPECT_EQ(falseAlarms, 0);
}

Metadata samplesMetadata(std::int64_t first, std::int64_t count) {
    return {{"isolux/seed", std::int64_t{1}},
            {"isolux/sampleFirst", first},
            {"isolux/sampleCount", count},
            {"isolux/sceneHash", "abc"}};
}

TEST(RelativeBias, SharedSamplesAreFoundInTheMetadata) {
    const Metadata metadata = samplesMetadata(0, 64);
    EXPECT_TRUE(shareSamples(metadata, metadata));
    EXPECT_TRUE(shareSamples(metadata, samplesMetadata(63, 1)));
    EXPECT_FALSE(shareSamples(metadata, samplesMetadata(64, 64)));
    EXPECT_FALSE(shareSamples(samplesMetadata(64, 64), metadata));
    EXPECT_FALSE(shareSamples(metadata, {}));
    EXPECT_FALSE(shareSamples({}, {}));
    Metadata other = metadata;
    other["isolux/sceneHash"] = "def";
    EXPECT_FALSE(shareSamples(metadata, other));
    other.erase("isolux/sceneHash");
    EXPECT_TRUE(shareSamples(metadata, other)) << "nothing says that the scenes differ";
    other["isolux/seed"] = std::int64_t{2};
    EXPECT_FALSE(shareSamples(metadata, other));
}

TEST(RelativeBias, SharedSamplesAreComparedInPairs) {
    Image image = rgbImage(2, 2, std::vector<float>(12, 1.0f));
    Image reference = image;
    for (std::size_t c = 0; c < 3; ++c) image.values[c] = 1.4f;
    image.metadata = reference.metadata = samplesMetadata(0, 64);
    const ComparisonReport report = compareImages(image, reference);
    EXPECT_EQ(report.bias.method, BiasMethod::paired);
    EXPECT_NEAR(report.bias.luminance.estimate, 0.1, 1e-7);
    EXPECT_NEAR(report.bias.luminance.high - 0.1, studentQuantile(0.975, 3) * 0.1,
                1e-6); // d = (.4, 0, 0, 0): s/sqrt(4) = .1
    expectMentions(toText(report), "share random numbers");
}

// --- Limits ---

TEST(Limits, OnlyAWholeIntervalBeyondExceeds) {
    EXPECT_EQ(checkLimit({0.9, 1.1, 1.3}, 1.0), Verdict::within);
    EXPECT_EQ(checkLimit({1.01, 1.1, 1.3}, 1.0), Verdict::exceeded);
    EXPECT_EQ(checkLimit({1.0, 1.1, 1.3}, 1.0), Verdict::within);
    EXPECT_EQ(checkLimit({-1.3, -1.1, -1.01}, 1.0), Verdict::exceeded);
    EXPECT_EQ(checkLimit({-1.3, -1.1, -0.9}, 1.0), Verdict::within);
    EXPECT_EQ(checkLimit({-9.0, 3.0, 9.0}, 1.0), Verdict::within) << "an interval around 0 accuses nobody";
    EXPECT_EQ(checkLimit({kNan, 1.1, kNan}, 1.0), Verdict::exceeded);
    EXPECT_EQ(checkLimit({kNan, 0.9, kNan}, 1.0), Verdict::within);
    EXPECT_EQ(checkLimit({kNan, kNan, kNan}, 1.0), Verdict::exceeded);
    EXPECT_EQ(checkLimit({kNan, -kInfinity, kNan}, 1.0), Verdict::exceeded);
}

TEST(Limits, AreNamedInTheReport) {
    const ComparisonReport report = compareImages(uniformImage(2, 2, 2.0f), uniformImage(2, 2, 1.0f), {0.5, 2.0});
    ASSERT_EQ(report.limits.size(), 5u);
    EXPECT_EQ(report.verdict(), Verdict::exceeded);
    EXPECT_EQ(report.limits.back().verdict, Verdict::within);
    expectMentions(toText(report), "relative bias of luminance 0.5: EXCEEDED");
    const nlohmann::ordered_json json = nlohmann::ordered_json::parse(jsonText(toJson(report)));
    EXPECT_EQ(json["schema"], 1);
    EXPECT_EQ(json["relativeBias"]["luminance"], nlohmann::ordered_json::parse("[null, 1.0, null]"));
    EXPECT_EQ(json["limits"][4]["name"], "relMSE");
    EXPECT_EQ(json["limits"][0]["exceeded"], true);
}

// --- Paired films ---

Film uniformFilm(std::uint32_t width, std::uint32_t height) {
    Film film(width, height);
    for (PixelStatistics& pixel : film.pixels) {
        pixel.sampleCount = 4;
        pixel.mean = Vec3d(1.0, 0.5, 0.001);
        pixel.pathSignature = 17;
    }
    return film;
}

TEST(Paired, RelativeDifferenceHoldsChannelsToTheirOwnValueOrLuminance) {
    EXPECT_DOUBLE_EQ(relativeDifference({1.0, 1.0, 1.5}, {1.0, 1.0, 1.0}), 0.5);
    EXPECT_DOUBLE_EQ(relativeDifference({1.1, 0.0, 0.0}, {1.0, 0.0, 0.0}), 1.1 - 1.0);
    EXPECT_NEAR(relativeDifference({1.0, 1e-6, 0.0}, {1.0, 0.0, 0.0}), 1e-6 / 0.2126, 1e-12);
    EXPECT_EQ(relativeDifference({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}), 0.0);
    EXPECT_EQ(relativeDifference({0.0, 0.0, 1e-9}, {0.0, 0.0, 0.0}), kInfinity);
    EXPECT_EQ(relativeDifference({kNan, 0.0, 0.0}, {1.0, 0.0, 0.0}), kInfinity);
    EXPECT_EQ(relativeDifference({1.0, 0.0, 0.0}, {kInfinity, 0.0, 0.0}), kInfinity);
}

TEST(Paired, TellsRoundingBranchesAndMistakesApart) {
    const Film reference = uniformFilm(4, 2);
    Film film = reference;
    film.at(0, 0).mean *= 1.0 + 1e-5; // rounding
    film.at(1, 0).mean *= 1.5;        // another branch
    film.at(1, 0).pathSignature = 3;
    film.at(2, 0).pathSignature = 4; // another branch of no consequence
    film.at(3, 1).mean *= 1.01;      // a mistake
    const PairedDifferences result = pairedDifferences(film, reference);
    EXPECT_EQ(result.litPixels, 8u);
    EXPECT_EQ(result.withinTolerance, 6u);
    EXPECT_EQ(result.otherBranch, 1u);
    EXPECT_EQ(result.unexplained, 1u);
    EXPECT_EQ(result.differentSignatures, 2u);
    EXPECT_EQ(result.medianDifference, 0.0);
    EXPECT_NEAR(result.difference999, 0.5, 1e-12);
    EXPECT_NEAR(result.luminanceBias.estimate, (1e-5 + 0.5 + 0.01) / 8.0, 1e-12);
    ASSERT_EQ(result.worst.size(), 3u);
    EXPECT_EQ(result.worst[0].x, 3u) << "the unexplained pixel comes first";
    EXPECT_EQ(result.worst[0].y, 1u);
    EXPECT_EQ(result.worst[1].x, 1u);
    EXPECT_EQ(result.worst[1].signature, Signature::different);
    expectMentions(toText(result), "unexplained");
    EXPECT_EQ(toJson(result)["unexplained"], 1);
    EXPECT_EQ(toJson(result)["worst"][1]["sameSignature"], false);
}

/// A pixel far off in the film under test: explained if any of the films in single precision errs there, on the same
/// branch, a hundredth of that or more.
TEST(Paired, RoundingIsWhatAnyFilmInSinglePrecisionShows) {
    const Film reference = uniformFilm(4, 2);
    const auto planted = [&](double error) {
        Film film = reference;
        film.at(2, 1).mean *= 1.0 + error;
        return film;
    };
    const auto unexplained = [&](const std::vector<Film>& singles) {
        const PairedDifferences result = pairedDifferences(planted(0.02), reference, {1e-3, singles});
        EXPECT_EQ(result.unexplained + result.rounding, 1u);
        return result.unexplained;
    };
    EXPECT_EQ(unexplained({}), 1u);
    EXPECT_EQ(unexplained({planted(1.9e-4)}), 1u);
    EXPECT_EQ(unexplained({planted(1.9e-4), planted(0.0), planted(-1.9e-4)}), 1u) << "errors do not add up";
    EXPECT_EQ(unexplained({planted(1.9e-4), planted(2.1e-4)}), 0u);
    EXPECT_EQ(unexplained({planted(-2.1e-4), planted(0.0)}), 0u);
    Film elsewhere = planted(0.5);
    elsewhere.at(2, 1).pathSignature = 18;
    EXPECT_EQ(unexplained({planted(0.0), elsewhere}), 1u);
    EXPECT_EQ(unexplained({elsewhere, elsewhere, elsewhere}), 1u) << "three may meet an edge by chance";
    EXPECT_EQ(unexplained({elsewhere, elsewhere, elsewhere, planted(0.0)}), 1u) << "the branch can be told";
    EXPECT_EQ(unexplained({elsewhere, elsewhere, elsewhere, elsewhere}), 0u);
    Film near = planted(1.9e-4);
    near.at(2, 1).pathSignature = 18;
    EXPECT_EQ(unexplained({near, near, near, near}), 1u) << "rounding that small explains no 2 %";
    elsewhere.at(2, 1).pathSignature = 0;
    EXPECT_EQ(unexplained({elsewhere}), 0u) << "a film without signatures";
}

TEST(Paired, BlackPixelsCountOnlyWhereOneFilmIsLit) {
    Film reference = uniformFilm(2, 2);
    reference.at(0, 0).mean = reference.at(1, 1).mean = Vec3d(0.0);
    Film film = reference;
    film.at(1, 1).mean = Vec3d(1e-12);
    const PairedDifferences result = pairedDifferences(film, reference);
    EXPECT_EQ(result.litPixels, 3u);
    EXPECT_EQ(result.unexplained, 1u);
}

TEST(Paired, NanIsNeverWithinTolerance) {
    const Film reference = uniformFilm(2, 2);
    Film film = reference;
    film.at(0, 1).mean.y = kNan;
    const PairedDifferences result = pairedDifferences(film, reference);
    EXPECT_EQ(result.unexplained, 1u);
    EXPECT_EQ(result.difference999, kInfinity);
    EXPECT_TRUE(std::isnan(result.luminanceBias.estimate));
}

std::vector<std::string> exceeded(const Film& film, const Film& reference) {
    return exceededLimits(pairedDifferences(film, reference), {});
}

/// Every tenth pixel on another branch, as often brighter as darker by `part`.
Film branchedFilm(const Film& reference, double part) {
    Film film = reference;
    for (std::uint32_t i = 0; i < film.width; i += 10) {
        film.at(i, 0).mean *= 1.0 + (i / 10 % 2 == 0 ? part : -part);
        film.at(i, 0).pathSignature = 3;
    }
    return film;
}

TEST(Paired, OtherBranchesAgreeWhereTheMeanIsKnown) {
    const Film reference = uniformFilm(100000, 1);
    EXPECT_TRUE(exceeded(branchedFilm(reference, 0.01), reference).empty()) << "interval of 2e-5";
    const std::vector<std::string> unknown = exceeded(branchedFilm(reference, 0.5), reference);
    ASSERT_EQ(unknown.size(), 1u) << "interval of 1e-3 about 0";
    expectMentions(unknown[0], "90 %");
    expectMentions(unknown[0], "98 %");
    expectMentions(unknown[0], "more samples");
}

TEST(Paired, WhatIsExceededIsNamedWithItsLimit) {
    const Film reference = uniformFilm(1000, 1);
    EXPECT_TRUE(exceeded(reference, reference).empty());
    Film mistaken = reference;
    mistaken.at(0, 0).mean *= 1.01;
    const std::vector<std::string> one = exceeded(mistaken, reference);
    ASSERT_EQ(one.size(), 1u);
    expectMentions(one[0], "1 pixels are unexplained");
    Film brighter = reference;
    for (PixelStatistics& pixel : brighter.pixels) pixel.mean *= 1.0005; // within the tolerance, all of them
    const std::vector<std::string> biased = exceeded(brighter, reference);
    ASSERT_EQ(biased.size(), 1u);
    expectMentions(biased[0], "relative bias");
    expectMentions(biased[0], "0.01 %");
    Film nan = reference;
    nan.at(0, 0).mean.x = kNan;
    EXPECT_EQ(exceeded(nan, reference).size(), 2u) << "unexplained, and no mean";
}

TEST(Paired, FilmsMustFit) {
    EXPECT_THROW((void)pairedDifferences(uniformFilm(2, 2), uniformFilm(4, 1)), Error);
    Film other = uniformFilm(2, 2);
    other.at(1, 1).sampleCount = 5;
    EXPECT_THROW((void)pairedDifferences(other, uniformFilm(2, 2)), Error);
    const std::vector<Film> singles{uniformFilm(2, 2), other};
    EXPECT_THROW((void)pairedDifferences(uniformFilm(2, 2), uniformFilm(2, 2), {1e-3, singles}), Error);
}

} // namespace
} // namespace isolux
