// Variance from independently randomised replicates, and the error of an image that it gives.
#include "core/sample_sequence.h"
#include "film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace isolux {
namespace {

/// A film of one pixel and its replicates, given values in the order of samples.
Film filmOf(const std::vector<Vec3d>& values) {
    Film film(1, 1);
    film.keepReplicates();
    for (std::uint32_t s = 0; s < values.size(); ++s) {
        film.pixels[0].add(values[s]);
        film.replicates[0].add(s, values[s]);
    }
    return film;
}

std::vector<Vec3d> randomValues(std::size_t count) {
    std::mt19937 random(5);
    std::lognormal_distribution<double> value;
    std::vector<Vec3d> values(count);
    for (Vec3d& v : values) v = Vec3d(value(random), value(random), value(random));
    return values;
}

TEST(PixelReplicates, OneSampleEachIsTheVarianceOfTheSamples) {
    Film film = filmOf(randomValues(16));
    const PixelStatistics plain = film.pixels[0];
    film.refineVariance();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(film.pixels[0].variance()[c], plain.variance()[c], 1e-13);
    EXPECT_NEAR(film.pixels[0].luminanceVariance(), plain.luminanceVariance(), 1e-13);
    EXPECT_EQ(film.pixels[0].mean, plain.mean);
    EXPECT_EQ(film.pixels[0].sampleCount, 16u);
}

/// The definition, written out: sum n_r (m_r - m)^2 / (R - 1), also where replicates hold unequal numbers of samples.
TEST(PixelReplicates, VarianceIsThatOfTheReplicatesMeans) {
    for (const std::size_t count : {2u, 17u, 40u, 160u}) {
        const std::vector<Vec3d> values = randomValues(count);
        Film film = filmOf(values);
        film.refineVariance();
        double mean = 0.0;
        for (const Vec3d& value : values) mean += luminance(value) / static_cast<double>(count);
        double scatter = 0.0;
        const std::size_t replicates = std::min<std::size_t>(count, 16);
        for (std::size_t r = 0; r < replicates; ++r) {
            double sum = 0.0;
            double samples = 0.0;
            for (std::size_t s = r; s < count; s += 16, ++samples) sum += luminance(values[s]);
            scatter += samples * std::pow(sum / samples - mean, 2.0);
        }
        const double expected = scatter / static_cast<double>(replicates - 1);
        EXPECT_NEAR(film.pixels[0].luminanceVariance() / expected, 1.0, 1e-12) << count;
    }
}

TEST(PixelReplicates, WithoutTwoReplicatesNothingChanges) {
    Film film(1, 1);
    film.keepReplicates();
    for (const std::uint32_t sample : {3u, 19u, 35u}) {
        film.pixels[0].add(Vec3d(sample));
        film.replicates[0].add(sample, Vec3d(sample));
    }
    const PixelStatistics before = film.pixels[0];
    film.refineVariance();
    EXPECT_EQ(film.pixels[0], before);
    Film plain(1, 1);
    plain.pixels = film.pixels;
    plain.refineVariance();
    EXPECT_EQ(plain.pixels[0], before);
}

TEST(PixelReplicates, NanStaysNan) {
    std::vector<Vec3d> values = randomValues(32);
    values[5].x = std::numeric_limits<double>::quiet_NaN();
    Film film = filmOf(values);
    film.refineVariance();
    EXPECT_TRUE(std::isnan(film.pixels[0].variance().x));
    EXPECT_TRUE(std::isnan(film.pixels[0].luminanceVariance()));
    EXPECT_FALSE(std::isnan(film.pixels[0].variance().y));
}

/// For many pixels of Sobol points: the refined variance / samples is, on average, the variance that the pixels' means
/// have among themselves; that of the samples says far more.
TEST(PixelReplicates, SaysHowFarLowDiscrepancyMeansScatter) {
    constexpr std::uint32_t kPixels = 4000;
    constexpr std::uint32_t kSamples = 256;
    PixelStatistics means;
    double refined = 0.0;
    double plain = 0.0;
    for (std::uint32_t x = 0; x < kPixels; ++x) {
        std::vector<Vec3d> values;
        for (std::uint32_t s = 0; s < kSamples; ++s) {
            const PhiloxBlock words = sobolBlock({1, 4}, {x, 0, s}, 0);
            values.emplace_back(std::exp(unitReal<double>(words[0]) + unitReal<double>(words[1])));
        }
        Film film = filmOf(values);
        plain += film.pixels[0].luminanceVariance() / kSamples / kPixels;
        film.refineVariance();
        refined += film.pixels[0].luminanceVariance() / kSamples / kPixels;
        means.add(film.pixels[0].mean);
    }
    // The ratio of a variance of 4000 means to the mean of 4000 variances of 15 degrees of freedom: nearly normal means
    // give it a standard deviation of sqrt(2 / 4000 * (1 + 1 / 15)) = 2.3 %; 4 of them are 9.2 %.
    EXPECT_NEAR(refined / means.luminanceVariance(), 1.0, 0.092);
    EXPECT_GT(plain / refined, 20.0);
}

TEST(EstimatedRelativeRmse, IsTheRootOfTheMeanVarianceOverTheMean) {
    Film film(2, 1);
    for (int s = 0; s < 4; ++s) {
        film.pixels[0].add(s % 2 == 0 ? Vec3d(1.0, 2.0, 0.0) : Vec3d(3.0, 2.0, 0.0));
        film.pixels[1].add(Vec3d(4.0, 2.0, 1.0));
    }
    // Variances of the means: 4/3/4 in one of six values, else 0; the values' mean is (2 + 2 + 0 + 4 + 2 + 1) / 6.
    EXPECT_NEAR(estimatedRelativeRmse(film), std::sqrt(1.0 / 3.0 / 6.0) / (11.0 / 6.0), 1e-15);
}

TEST(EstimatedRelativeRmse, IsUnknownWhileAPixelHasOneSample) {
    Film film(2, 1);
    film.pixels[0].add(Vec3d(1.0));
    film.pixels[0].add(Vec3d(1.0));
    film.pixels[1].add(Vec3d(1.0));
    EXPECT_TRUE(std::isnan(estimatedRelativeRmse(film)));
    film.pixels[1].add(Vec3d(1.0));
    EXPECT_EQ(estimatedRelativeRmse(film), 0.0);
    EXPECT_TRUE(std::isnan(estimatedRelativeRmse(Film(0, 0))));
}

} // namespace
} // namespace isolux
