// Samplers, by statistics: uniform, uncorrelated, and as good as they are meant to be. Random numbers are integers, so
// each test passes or fails everywhere alike; the probability that one of this file would fail by chance is below 1 %.
#include "core/sample_sequence.h"
#include "film/film.h"
#include "report/statistics.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>

namespace isolux {
namespace {

constexpr double kChance = 1e-5; // of each comparison by itself

using Block = PhiloxBlock (*)(const SequencePlan&, const SampleIndex&, std::uint32_t);
constexpr std::array<Block, 3> kByPixel{independentBlock, stratifiedBlock, sobolBlock};
constexpr std::array<Block, 4> kSamplers{independentBlock, stratifiedBlock, sobolBlock, sobolBlueNoiseBlock};

/// The value that chi-square exceeds with probability p (Wilson and Hilferty 1931).
double chiSquareLimit(double degrees, double p) {
    const double t = 2.0 / (9.0 * degrees);
    return degrees * std::pow(1.0 - t + normalQuantile(1.0 - p) * std::sqrt(t), 3.0);
}

double normalLimit(double p) { return normalQuantile(1.0 - 0.5 * p); }

// --- Scrambles ---

/// Over random numbers and keys each bit flips half of the time, whatever the highest differing bit: binomial.
TEST(SampleSequenceStatistics, ScramblesFlipEveryBitHalfOfTheTime) {
    constexpr std::uint32_t kDraws = 1u << 18;
    std::array<std::uint32_t, 32> flips{};
    for (std::uint32_t i = 0; i < kDraws; ++i) {
        const PhiloxBlock random = randomBlock(1, i, 0, 0, 0);
        const std::uint32_t flipped = nestedScramble(random[0], random[1]) ^ random[0];
        for (std::uint32_t bit = 0; bit < 32; ++bit) flips[bit] += flipped >> bit & 1;
    }
    for (std::uint32_t bit = 0; bit < 32; ++bit)
        EXPECT_LT(std::abs(flips[bit] - 0.5 * kDraws) / std::sqrt(0.25 * kDraws), normalLimit(kChance)) << bit;
}

/// Owen's scrambling as he defines it (1995): each bit is flipped at random for every value of the bits above it. The
/// lowest 16 bits are left alone: they do not matter here.
std::uint32_t owenScramble(std::uint32_t x, std::uint32_t stream) {
    std::uint32_t result = x;
    for (std::uint32_t bit = 31; bit >= 16; --bit) {
        const std::uint32_t above = bit == 31 ? 0 : x >> (bit + 1);
        if ((randomBlock(77, stream, above, bit, 0)[0] & 1) != 0) result ^= 1u << bit;
    }
    return result;
}

/// The variance of the mean of exp(u + v) over 2^m scrambled points of Sobol's sequence.
using Scramble = std::function<std::uint32_t(std::uint32_t, std::uint32_t)>;
double scrambledVariance(std::uint32_t m, std::uint32_t trials, const Scramble& scramble) {
    PixelStatistics means;
    for (std::uint32_t trial = 0; trial < trials; ++trial) {
        double sum = 0.0;
        for (std::uint32_t i = 0; i < 1u << m; ++i) {
            const std::uint32_t u = scramble(reverseBits(i), 2 * trial);
            const std::uint32_t v = scramble(reverseBits(pascalTransform(i)), 2 * trial + 1);
            sum += std::exp(std::ldexp(u, -32) + std::ldexp(v, -32));
        }
        means.add(Vec3d(std::ldexp(sum, -static_cast<int>(m))));
    }
    return means.variance().x;
}

TEST(SampleSequenceStatistics, ScramblesAreAsGoodAsOwens) {
    for (const std::uint32_t m : {2u, 4u, 6u}) {
        constexpr std::uint32_t kTrials = 2000;
        const double owen = scrambledVariance(m, kTrials, owenScramble);
        const double hashed = scrambledVariance(m, kTrials, [](std::uint32_t x, std::uint32_t stream) {
            return nestedScramble(x, randomBlock(5, stream, 0, 0, 0)[0]);
        });
        // The logarithm of the ratio of two variances of 2000 nearly normal means has a standard deviation of sqrt(2 *
        // 2 / 2000) = 0.045.
        EXPECT_LT(std::abs(std::log(hashed / owen)), normalLimit(kChance) * std::sqrt(4.0 / kTrials)) << m;
        RecordProperty("ratio" + std::to_string(m), std::to_string(hashed / owen));
    }
}

// --- Uniformity ---

/// One sample of each of many pixels, in 256 intervals.
TEST(SampleSequenceStatistics, WordsAreUniform) {
    constexpr std::uint32_t kPixels = 1u << 16;
    for (const Block block : kByPixel)
        for (const std::uint32_t sample : {0u, 5u, 1000u})
            for (std::size_t word = 0; word < 4; ++word) {
                std::array<std::uint32_t, 256> counts{};
                for (std::uint32_t x = 0; x < kPixels; ++x) ++counts[block({1, 6}, {x, 2, sample}, 3)[word] >> 24];
                double chiSquare = 0.0;
                for (const std::uint32_t count : counts) chiSquare += (count - 256.0) * (count - 256.0) / 256.0;
                EXPECT_LT(chiSquare, chiSquareLimit(255, kChance)) << sample << ' ' << word;
            }
}

/// Within the strata too: the position in its cell is uniform.
TEST(SampleSequenceStatistics, JitterFillsItsCell) {
    constexpr std::uint32_t kPixels = 1u << 14;
    std::array<std::uint32_t, 64> counts{};
    for (std::uint32_t x = 0; x < kPixels; ++x)
        ++counts[stratifiedBlock({1, 6}, {x, 2, 40}, 3)[0] >> (32 - 3 - 6) & 63]; // 3 bits choose the column
    double chiSquare = 0.0;
    for (const std::uint32_t count : counts) chiSquare += (count - 256.0) * (count - 256.0) / 256.0;
    EXPECT_LT(chiSquare, chiSquareLimit(63, kChance));
}

// --- Correlation ---

/// Correlation of two streams of 2^16 words, as a multiple of the standard deviation that independent ones have.
template <typename First, typename Second> double correlation(const First& first, const Second& second) {
    constexpr std::uint32_t kCount = 1u << 16;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kCount; ++i)
        sum += (std::ldexp(first(i), -32) - 0.5) * (std::ldexp(second(i), -32) - 0.5);
    return sum / std::sqrt(static_cast<double>(kCount)) * 12.0; // variance 1/12 each
}

TEST(SampleSequenceStatistics, PixelsBlocksAndReplicatesAreUncorrelated) {
    constexpr SequencePlan plan{2, 6};
    for (const Block block : kByPixel)
        for (std::size_t a = 0; a < 4; ++a) {
            const auto word = [&](std::uint32_t x, std::uint32_t y, std::uint32_t sample, std::uint32_t counter) {
                return block(plan, {x, y, sample}, counter)[a];
            };
            const auto base = [&](std::uint32_t i) { return word(i, 4, 32, 2); };
            const double limit = normalLimit(kChance);
            EXPECT_LT(std::abs(correlation(base, [&](std::uint32_t i) { return word(i + 1, 4, 32, 2); })), limit);
            EXPECT_LT(std::abs(correlation(base, [&](std::uint32_t i) { return word(i, 5, 32, 2); })), limit);
            EXPECT_LT(std::abs(correlation(base, [&](std::uint32_t i) { return word(i, 4, 33, 2); })), limit);
            EXPECT_LT(std::abs(correlation(base, [&](std::uint32_t i) { return word(i, 4, 32, 3); })), limit);
            EXPECT_LT(std::abs(correlation(base, [&](std::uint32_t i) { return word(i, 4, 32, 0x80000002u); })), limit);
        }
}

/// Over a square of pixels the words of one pair form a net, those of another pair or block another one: a shuffle
/// moves pairs of points together, so they scatter like half as many points.
TEST(SampleSequenceStatistics, BlueNoiseTiesNoBlocksNorReplicates) {
    constexpr SequencePlan plan{2, 6};
    const auto word = [&](std::uint32_t i, std::uint32_t sample, std::uint32_t counter, std::size_t place) {
        return sobolBlueNoiseBlock(plan, {i & 255, i >> 8, sample}, counter)[place];
    };
    const double limit = std::sqrt(2.0) * normalLimit(kChance);
    for (std::size_t a = 0; a < 4; ++a) {
        const auto base = [&](std::uint32_t i) { return word(i, 32, 2, a); };
        for (std::size_t b = 0; b < 4; ++b) {
            EXPECT_LT(std::abs(correlation(base, [&](std::uint32_t i) { return word(i, 32, 3, b); })), limit);
            EXPECT_LT(std::abs(correlation(base, [&](std::uint32_t i) { return word(i, 33, 2, b); })), limit);
            if (a / 2 != b / 2) {
                EXPECT_LT(std::abs(correlation(base, [&](std::uint32_t i) { return word(i, 32, 2, b); })), limit);
            }
        }
    }
}

// --- What samplers are for ---

/// The variance of a pixel's mean over 1000 pixels, for an integrand of one block's words.
template <typename Integrand>
double pixelVariance(Block block, std::uint32_t samples, std::uint32_t cellBits, const Integrand& integrand) {
    PixelStatistics means;
    for (std::uint32_t x = 0; x < 1000; ++x) {
        double sum = 0.0;
        for (std::uint32_t s = 0; s < samples; ++s) {
            const PhiloxBlock words = block({6, cellBits}, {x, 3, s}, 1);
            sum += integrand(std::ldexp(words[0], -32), std::ldexp(words[1], -32), std::ldexp(words[3], -32));
        }
        means.add(Vec3d(sum / samples));
    }
    return means.variance().x;
}

/// The ratio of two variances of 1000 means each scatters by sqrt(2 * 2 / 1000).
const double kRatioSlack = std::exp(normalLimit(kChance) * std::sqrt(4.0 / 1000.0));

/// A round that a time limit or the error ends early must not be worse than independent samples.
TEST(SampleSequenceStatistics, NoSamplerIsWorseThanIndependentAtAnyLength) {
    const auto smooth = [](double u, double v, double) { return std::exp(u + v); };
    for (const std::uint32_t samples : {16u, 64u, 100u, 400u, 1024u}) {
        const double independent = pixelVariance(independentBlock, samples, 6, smooth);
        for (const Block block : kSamplers)
            EXPECT_LT(pixelVariance(block, samples, 6, smooth) / independent, kRatioSlack) << samples;
    }
}

TEST(SampleSequenceStatistics, CompleteRoundsAreFarBetter) {
    const auto smooth = [](double u, double v, double) { return std::exp(u + v); };
    const double independent = pixelVariance(independentBlock, 1024, 6, smooth);
    // Cells of 1/8 by 1/8 leave about the 64th part of the variance; Owen's scrambles an order of magnitude less.
    EXPECT_LT(pixelVariance(stratifiedBlock, 1024, 6, smooth) / independent, kRatioSlack / 50.0);
    EXPECT_LT(pixelVariance(sobolBlock, 1024, 6, smooth) / independent, kRatioSlack / 500.0);
}

/// Halves of dimensions of different pairs: a shuffle moves two samples together, so the variance may double.
TEST(SampleSequenceStatistics, PairsAreNotTiedToEachOther) {
    const auto sameHalf = [](double, double v, double w) { return (v < 0.5) == (w < 0.5) ? 1.0 : 0.0; };
    for (const std::uint32_t samples : {64u, 400u, 1024u}) {
        const double independent = 0.25 / samples;
        for (const Block block : kSamplers)
            EXPECT_LT(pixelVariance(block, samples, 6, sameHalf) / independent, 2.0 * kRatioSlack) << samples;
    }
}

} // namespace
} // namespace isolux
