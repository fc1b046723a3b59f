// Errors of films against references: by hand, and over many synthetic renders whose truth is known.
#include "core/error.h"
#include "report/error_meter.h"
#include "report_images.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace isolux {
namespace {

using namespace test;

constexpr std::uint32_t kWidth = 16;
constexpr std::uint32_t kPixels = kWidth * kWidth;

/// What pixel `pixel` of the synthetic scene shows; a tenth of it is black.
double truth(std::size_t pixel) { return pixel % 10 == 0 ? 0.0 : 0.1 + 0.01 * static_cast<double>(pixel); }

enum class Sampling { independent, replicates };

/// How the synthetic scene is rendered: samples are gamma variables, of the given coefficient of variation.
struct Render {
    double variation = 1.0;
    double bias = 0.0; ///< of each lit pixel, relative
    std::function<std::uint32_t(std::size_t)> samples = [](std::size_t) { return 32; };
    Sampling sampling = Sampling::independent;
};

Film render(const Render& how, std::mt19937_64& random) {
    const double shape = 1.0 / (how.variation * how.variation);
    std::gamma_distribution<double> noise(shape, 1.0 / shape);
    Film film(kWidth, kWidth);
    if (how.sampling == Sampling::replicates) film.keepReplicates();
    for (std::size_t i = 0; i < kPixels; ++i) {
        const std::uint32_t count = how.samples(i);
        for (std::uint32_t s = 0; s < count; ++s) {
            const Vec3d value(truth(i) * (1.0 + how.bias) * noise(random));
            film.pixels[i].add(value);
            if (how.sampling == Sampling::replicates) film.replicates[i].add(s, value);
        }
    }
    film.refineVariance();
    return film;
}

Render ofSamples(std::uint32_t samples) {
    Render how;
    how.samples = [=](std::size_t) { return samples; };
    return how;
}

double meanSquare() {
    double sum = 0.0;
    for (std::size_t i = 0; i < kPixels; ++i) sum += truth(i) * truth(i);
    return sum / kPixels;
}

/// A reference of so many samples of coefficient of variation 1: their mean is a gamma variable. Carries its standard
/// error.
Image referenceOf(double samples, std::mt19937_64& random) {
    std::gamma_distribution<double> noise(samples, 1.0 / samples);
    Image image = makeImage(kWidth, kWidth, {"R", "G", "B", "se.R", "se.G", "se.B"});
    for (std::size_t i = 0; i < kPixels; ++i) {
        const auto value = static_cast<float>(truth(i) * noise(random));
        std::fill_n(image.values.begin() + 6 * static_cast<std::ptrdiff_t>(i), 3, value);
        const auto error = static_cast<float>(truth(i) / std::sqrt(samples));
        std::fill_n(image.values.begin() + 6 * static_cast<std::ptrdiff_t>(i) + 3, 3, error);
    }
    return image;
}

Image exactImage() {
    Image image = makeImage(kWidth, kWidth, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = static_cast<float>(truth(i / 3));
    return image;
}

ErrorMeter exactMeter() { return {exactImage(), exactImage()}; }

std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::badInput);
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

/// The estimates' mean is `expected` within 4 standard errors, which chance exceeds in one of 15000 tests.
void expectUnbiased(const std::vector<double>& estimates, double expected) {
    const double error = std::sqrt(variance(estimates) / static_cast<double>(estimates.size()));
    EXPECT_NEAR(mean(estimates), expected, 4.0 * error);
    EXPECT_LT(error, 0.1 * expected); // or that would say little
}

// --- Errors ---

Film filmOf(const std::vector<Vec3d>& colors) {
    Film film(static_cast<std::uint32_t>(colors.size()), 1);
    for (std::size_t i = 0; i < colors.size(); ++i) film.pixels[i].add(colors[i]);
    return film;
}

TEST(ErrorMeter, FollowsTheDefinitions) {
    const ErrorMeter meter(rgbImage(2, 1, {1, 1, 1, 2, 2, 2}), rgbImage(2, 1, {3, 3, 3, 2, 2, 2}));
    const ErrorSample sample = meter.measure(filmOf({Vec3d(5.0), Vec3d(2.0, 2.0, 3.5)}), MeasureFlip::no);
    // Squared errors: (5 - 1)(5 - 3) = 8 in three channels, 1.5^2 = 2.25 in one of three; r is 2 everywhere.
    EXPECT_NEAR(sample.mse, (8.0 + 0.75) / 2.0, 1e-14);
    EXPECT_NEAR(sample.relMse, (8.0 + 0.75) / 4.01 / 2.0, 1e-14);
    EXPECT_NEAR(sample.relMseTrimmed, sample.relMse, 1e-14); // of two pixels none is 0.1 %
    EXPECT_NEAR(sample.mae, (3.0 + 0.5) / 2.0, 1e-14);
    EXPECT_NEAR(sample.bias, (3.0 + 0.0722 * 1.5) / 4.0, 1e-14);
    EXPECT_NEAR(sample.relativeRmse, std::sqrt(4.375) / 2.0, 1e-14);
    EXPECT_TRUE(std::isnan(sample.flip));
    EXPECT_TRUE(std::isnan(sample.estimate)); // one sample a pixel
    EXPECT_EQ(meter.quality().mean, 2.0);
    EXPECT_NEAR(meter.quality().mse, 0.5, 1e-14); // (2/2)^2 in one of two pixels
    EXPECT_NEAR(meter.quality().relativeBiasError, std::sqrt(0.5 / 2.0) / 2.0, 1e-14);
    EXPECT_EQ(meter.quality().pixels, 2u);
    EXPECT_EQ(meter.reference().values, std::vector<float>(6, 2.0f));
}

TEST(ErrorMeter, NeverClamps) {
    const ErrorMeter meter(rgbImage(1, 1, {1, 1, 1}), rgbImage(1, 1, {3, 3, 3}));
    const ErrorSample sample = meter.measure(filmOf({Vec3d(2.0)}), MeasureFlip::no);
    EXPECT_NEAR(sample.mse, -1.0, 1e-14);
    EXPECT_NEAR(sample.relativeRmse, -0.5, 1e-14);
}

TEST(ErrorMeter, TrimsTheWorstPixels) {
    Film film = filmOf(std::vector<Vec3d>(2000, Vec3d(2.0)));
    film.pixels[7].mean = Vec3d(1000.0);
    film.pixels[8].mean = Vec3d(2000.0);
    film.pixels[9].mean = Vec3d(100.0);
    const ErrorMeter meter(makeImage(2000, 1, {"R", "G", "B"}, 1.0f), makeImage(2000, 1, {"R", "G", "B"}, 1.0f));
    const ErrorSample sample = meter.measure(film, MeasureFlip::no);
    EXPECT_NEAR(sample.relMseTrimmed, (1997.0 + 99.0 * 99.0) / 1.01 / 1998.0, 1e-10);
    EXPECT_GT(sample.relMse, 1000.0);
}

TEST(ErrorMeter, FlipIsAgainstTheMeanOfBoth) {
    const ErrorMeter meter(uniformImage(16, 16, 0.4f), uniformImage(16, 16, 0.6f));
    Film film(16, 16);
    for (PixelStatistics& pixel : film.pixels) pixel.add(Vec3d(double{0.5f}));
    EXPECT_NEAR(meter.measure(film, MeasureFlip::yes).flip, 0.0, 1e-6);
    for (PixelStatistics& pixel : film.pixels) pixel.mean = Vec3d(0.8);
    EXPECT_GT(meter.measure(film, MeasureFlip::yes).flip, 0.05);
}

TEST(ErrorMeter, NanIsNotHidden) {
    const ErrorMeter meter(uniformImage(2, 1, 1.0f), uniformImage(2, 1, 1.0f));
    const ErrorSample sample = meter.measure(filmOf({Vec3d(1.0), Vec3d(1.0, kNan, 1.0)}), MeasureFlip::yes);
    for (const double value :
         {sample.mse, sample.relMse, sample.relMseTrimmed, sample.mae, sample.flip, sample.bias, sample.relativeRmse})
        EXPECT_TRUE(std::isnan(value));
}

TEST(ErrorMeter, RefusesReferencesThatDoNotServe) {
    EXPECT_EQ(refusal([] { ErrorMeter(uniformImage(2, 1, 1.0f), uniformImage(1, 2, 1.0f)); }),
              "reference: the two references differ in size: 2 x 1 and 1 x 2");
    expectMentions(refusal([] { ErrorMeter(uniformImage(1, 1, 1.0f), makeImage(1, 1, {"Y"})); }),
                   "second reference: has no channels R, G and B");
    EXPECT_EQ(refusal([] {
                  ErrorMeter(uniformImage(2, 2, 1.0f), rgbImage(2, 2, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, NAN, 1}));
              }),
              "reference: pixel (1, 1) is not finite");
    expectMentions(refusal([] { (void)ErrorMeter(uniformImage(2, 2, 1.0f)); }), "reference: carries no variance");
    Image seeded = uniformImage(1, 1, 1.0f);
    seeded.metadata["isolux/seed"] = std::int64_t{7};
    seeded.metadata["isolux/sampleCount"] = std::int64_t{64};
    expectMentions(refusal([&] { ErrorMeter(seeded, seeded); }), "reference: the two references share random numbers");
    expectMentions(refusal([] { (void)exactMeter().measure(Film(2, 3), MeasureFlip::no); }),
                   "reference: is 16 x 16, the image 2 x 3");
}

// --- Noisy references ---

/// References of as few samples as the film: their noise is as large as the error, and has no part in it.
TEST(ErrorMeter, NoiseOfReferencesDropsOut) {
    std::mt19937_64 random(1);
    Render biased = ofSamples(8);
    biased.bias = 0.2;
    std::vector<double> two, one, quality, oneQuality;
    for (int i = 0; i < 400; ++i) {
        const Film film = render(biased, random);
        const Image first = imageFromFilm(render(ofSamples(8), random), {});
        const Image second = imageFromFilm(render(ofSamples(8), random), {});
        const ErrorMeter both(first, second);
        const ErrorMeter single(first);
        two.push_back(both.measure(film, MeasureFlip::no).mse);
        one.push_back(single.measure(film, MeasureFlip::no).mse);
        quality.push_back(both.quality().mse);
        oneQuality.push_back(single.quality().mse);
        EXPECT_EQ(both.quality().samplesPerPixel, 16.0);
        EXPECT_EQ(single.quality().samplesPerPixel, 8.0);
    }
    const double expected = meanSquare() * (1.2 * 1.2 / 8.0 + 0.2 * 0.2);
    expectUnbiased(two, expected);
    expectUnbiased(one, expected);
    expectUnbiased(quality, meanSquare() / 16.0);
    expectUnbiased(oneQuality, meanSquare() / 8.0);
}

/// The standard error of a reference's mean luminance, as it says and as it is.
TEST(ErrorMeter, ReferencesKnowTheErrorOfTheirMean) {
    std::mt19937_64 random(2);
    std::vector<double> means, said;
    for (int i = 0; i < 200; ++i) {
        const ErrorMeter meter(imageFromFilm(render(ofSamples(4), random), {}),
                               imageFromFilm(render(ofSamples(4), random), {}));
        means.push_back(exactMeter().measure(render(ofSamples(8), random), MeasureFlip::no).bias);
        said.push_back(meter.quality().relativeBiasError);
    }
    // The deviation of 200 values is known within 5 % (one sigma).
    EXPECT_NEAR(std::sqrt(variance(means)) / mean(said), 1.0, 0.2);
}

// --- Calibration ---

/// Many samples a pixel, nearly normal means: 95 % of intervals hold the truth, whatever the reference's noise.
Calibration calibrate(const Render& how, std::uint32_t referenceSamples, int seeds) {
    std::mt19937_64 random(3);
    Render reference = ofSamples(referenceSamples);
    reference.variation = how.variation;
    const ErrorMeter meter(imageFromFilm(render(reference, random), {}), imageFromFilm(render(reference, random), {}));
    CheckpointGatherer gatherer(meter);
    for (int i = 0; i < seeds; ++i) {
        const Film film = render(how, random);
        gatherer.add(film, meter.measure(film, MeasureFlip::no));
    }
    return gatherer.calibration();
}

void expectCalibrated(const Calibration& calibration, std::uint64_t seeds) {
    EXPECT_EQ(calibration.meanLuminance.total, seeds);
    // 16 to 64 seeds: 95 % within the 99.99 % limits of a binomial variable.
    expectBinomial(static_cast<int>(calibration.meanLuminance.inside), static_cast<int>(seeds), 0.95);
    ASSERT_EQ(calibration.pixels.size(), 5u);
    std::uint64_t total = 0;
    for (const Coverage& fifth : calibration.pixels) {
        total += fifth.total;
        // The reference is one for all seeds, and samples are somewhat skewed: within 2 %.
        EXPECT_NEAR(fifth.share().estimate, 0.95, 0.02);
    }
    EXPECT_EQ(total, seeds * (kPixels - 26)); // 26 pixels are black
    EXPECT_TRUE(calibration.estimateOverError.contains(1.0));
    EXPECT_LT(calibration.estimateOverError.high / calibration.estimateOverError.low, 1.2);
}

TEST(Calibration, OfIndependentSamples) {
    Render how = ofSamples(64);
    how.variation = 0.5;
    expectCalibrated(calibrate(how, 256, 40), 40);
}

/// Counts that differ from pixel to pixel, but not by the noise.
TEST(Calibration, OfUnequalCounts) {
    Render how;
    how.variation = 0.5;
    how.samples = [](std::size_t pixel) { return 32 + 32 * static_cast<std::uint32_t>(pixel % 3); };
    expectCalibrated(calibrate(how, 256, 40), 40);
}

/// 16 replicates: the normal quantile instead of Student's would hold 93.1 %.
TEST(Calibration, OfReplicates) {
    Render how = ofSamples(64);
    how.variation = 0.5;
    how.sampling = Sampling::replicates;
    expectCalibrated(calibrate(how, 512, 40), 40);
}

/// What renders without noise is equal to its reference up to single precision, and that is inside.
TEST(Calibration, WithoutNoiseRoundingIsInside) {
    Render how = ofSamples(4);
    how.variation = 1e-9;
    std::mt19937_64 random(3);
    const ErrorMeter meter = exactMeter();
    CheckpointGatherer gatherer(meter);
    const Film film = render(how, random);
    gatherer.add(film, meter.measure(film, MeasureFlip::no));
    for (const Coverage& fifth : gatherer.calibration().pixels) EXPECT_EQ(fifth.inside, fifth.total);
    EXPECT_EQ(gatherer.calibration().meanLuminance.inside, 1u);
}

TEST(Calibration, FifthsGoByBrightness) {
    const Calibration calibration = CheckpointGatherer(exactMeter()).calibration();
    EXPECT_TRUE(std::is_sorted(calibration.brightness.begin(), calibration.brightness.end()));
    EXPECT_NEAR(calibration.brightness.back(), truth(255), 1e-6);
    const ErrorMeter black(uniformImage(2, 2, 0.0f), uniformImage(2, 2, 0.0f));
    CheckpointGatherer gatherer(black);
    Film film(2, 2);
    for (PixelStatistics& pixel : film.pixels) pixel.add(Vec3d(0.0));
    gatherer.add(film, black.measure(film, MeasureFlip::no));
    for (const Coverage& fifth : gatherer.calibration().pixels) EXPECT_EQ(fifth.total, 0u);
}

/// A renderer that believes to be twice as good as it is.
TEST(Calibration, EstimateOverErrorIsTheRootOfMeanSquares) {
    const ErrorMeter meter = exactMeter();
    CheckpointGatherer gatherer(meter);
    std::mt19937_64 random(3);
    const Film film = render(ofSamples(2), random);
    for (const double error : {1.0, 2.0, 3.0}) {
        ErrorSample sample;
        sample.relativeRmse = error;
        sample.estimate = 0.5 * error;
        gatherer.add(film, sample);
    }
    const Interval ratio = gatherer.calibration().estimateOverError;
    EXPECT_NEAR(ratio.low, 0.5, 1e-12);
    EXPECT_NEAR(ratio.estimate, 0.5, 1e-12);
    EXPECT_NEAR(ratio.high, 0.5, 1e-12);
}

// --- Squared bias ---

/// mean over pixels, channels and i != j of (x_i - r1)(x_j - r2), written out.
double pairwise(const std::vector<Film>& films, const ErrorMeter& meter, std::size_t without) {
    double sum = 0.0;
    double pairs = 0.0;
    for (std::size_t i = 0; i < films.size(); ++i) {
        for (std::size_t j = 0; j < films.size(); ++j) {
            if (i == j || i == without || j == without) continue;
            pairs += 3.0 * kPixels;
            for (std::size_t p = 0; p < kPixels; ++p) {
                const ReferencePixel& r = meter.pixels()[p];
                const Vec3d product = (films[i].pixels[p].mean - r.first) * (films[j].pixels[p].mean - r.second);
                sum += product.x + product.y + product.z;
            }
        }
    }
    return sum / pairs;
}

TEST(SquaredBias, IsTheMeanOverPairsOfSeeds) {
    std::mt19937_64 random(4);
    const ErrorMeter meter(imageFromFilm(render(ofSamples(8), random), {}),
                           imageFromFilm(render(ofSamples(8), random), {}));
    CheckpointGatherer gatherer(meter);
    std::vector<Film> films;
    EXPECT_TRUE(std::isnan(gatherer.biasSquared().estimate));
    for (int i = 0; i < 5; ++i) {
        films.push_back(render(ofSamples(8), random));
        gatherer.add(films.back(), meter.measure(films.back(), MeasureFlip::no));
    }
    std::vector<double> left;
    for (std::size_t i = 0; i < films.size(); ++i) left.push_back(pairwise(films, meter, i));
    const double error = std::sqrt(variance(left) * 16.0 / 5.0); // (K - 1)/K sum of squares about their mean
    const Interval expected = studentInterval(pairwise(films, meter, films.size()), error, 4.0);
    const Interval interval = gatherer.biasSquared();
    // Sums of deviations are kept in single precision.
    EXPECT_NEAR(interval.estimate, expected.estimate, 1e-6 * meanSquare());
    EXPECT_NEAR(interval.low, expected.low, 1e-6 * meanSquare());
    EXPECT_NEAR(interval.high, expected.high, 1e-6 * meanSquare());
}

/// Both kinds of reference, of 1 % of the MSE's variance as they should be, and more seeds than groups: a bias of 10 %
/// under noise of 25 % a seed.
TEST(SquaredBias, IsUnbiasedAndItsIntervalHolds) {
    std::mt19937_64 random(5);
    Render biased = ofSamples(16);
    biased.bias = 0.1;
    const double expected = meanSquare() * 0.1 * 0.1;
    std::vector<double> two, one;
    int inside = 0;
    constexpr int kRuns = 60;
    for (int run = 0; run < kRuns; ++run) {
        const Image first = referenceOf(800.0, random);
        const ErrorMeter both(first, referenceOf(800.0, random));
        const ErrorMeter single(first);
        CheckpointGatherer pairs(both), alone(single);
        for (int seed = 0; seed < 20; ++seed) {
            const Film film = render(biased, random);
            pairs.add(film, both.measure(film, MeasureFlip::no));
            alone.add(film, single.measure(film, MeasureFlip::no));
        }
        two.push_back(pairs.biasSquared().estimate);
        one.push_back(alone.biasSquared().estimate);
        inside += pairs.biasSquared().contains(expected);
    }
    expectUnbiased(two, expected);
    expectUnbiased(one, expected);
    expectBinomial(inside, kRuns, 0.95);
}

} // namespace
} // namespace isolux
