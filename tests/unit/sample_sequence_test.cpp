// Samplers, exactly: known words, bijections, what bits depend on, nets and strata.
#include "sample_sequence_answers.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace isolux {
namespace {

TEST(SampleSequence, KnownAnswers) {
    for (const test::SequenceAnswer& answer : test::kSequenceAnswers)
        EXPECT_EQ(answer.function(answer.plan, answer.index, answer.block), answer.words)
            << "answer " << &answer - test::kSequenceAnswers.data();
    EXPECT_EQ(laineKarrasHash(0x12345678, 0x9abcdef0), 0xfb1d0b68u);
    EXPECT_EQ(laineKarrasHash(0xffffffff, 0xffffffff), 0x5edbfd28u);
    EXPECT_EQ(nestedScramble(0x12345678, 0x9abcdef0), 0x1f8b4945u);
    EXPECT_EQ(pascalTransform(0x12345678), 0x1235500fu);
}

TEST(SampleSequence, CellBitsCoverTheSamples) {
    for (const std::uint64_t samples : {0, 1, 15, 16}) EXPECT_EQ(cellBitsFor(samples), 0u) << samples;
    for (const std::uint64_t samples : {17, 31, 32}) EXPECT_EQ(cellBitsFor(samples), 1u) << samples;
    for (const std::uint64_t samples : {33, 63, 64}) EXPECT_EQ(cellBitsFor(samples), 2u) << samples;
    EXPECT_EQ(cellBitsFor(65), 3u);
    EXPECT_EQ(cellBitsFor(4096), 8u);
    EXPECT_EQ(cellBitsFor(4097), 9u);
    EXPECT_EQ(cellBitsFor(std::uint64_t{1} << 32), 28u);
    EXPECT_EQ(cellBitsFor((std::uint64_t{1} << 33) - 2), 29u) << "the most that firstSample + sampleCount can be";
}

// --- Bits ---

TEST(SampleSequence, BitsAreReversed) {
    for (std::uint32_t bit = 0; bit < 32; ++bit) EXPECT_EQ(reverseBits(1u << bit), 1u << (31 - bit));
    EXPECT_EQ(reverseBits(0x80000001u), 0x80000001u);
    EXPECT_EQ(reverseBits(0x12345678u), 0x1e6a2c48u);
}

TEST(SampleSequence, MortonInterleavesBits) {
    for (std::uint32_t bit = 0; bit < 16; ++bit) {
        EXPECT_EQ(mortonIndex(1u << bit, 0), 1u << (2 * bit));
        EXPECT_EQ(mortonIndex(0, 1u << bit), 2u << (2 * bit));
    }
    EXPECT_EQ(mortonIndex(0xFFFF, 0xFFFF), 0xFFFFFFFFu);
    EXPECT_EQ(mortonIndex(5, 3), 0b011011u);
}

/// Sobol's second dimension by its direction numbers (Sobol 1967): the polynomial x + 1 gives m_1 = 1, m_j = 2 m_{j-1}
/// xor m_{j-1}; bit c of the index contributes m_{c+1} / 2^{c+1}.
std::uint32_t secondDimension(std::uint32_t index) {
    std::uint32_t word = 0;
    std::uint32_t m = 1;
    for (std::uint32_t c = 0; c < 32; ++c) {
        if ((index >> c & 1) != 0) word ^= m << (31 - c);
        m ^= m << 1;
    }
    return word;
}

TEST(SampleSequence, PascalIsSobolsSecondDimension) {
    std::mt19937 random(1);
    for (std::uint32_t bit = 0; bit < 32; ++bit)
        EXPECT_EQ(reverseBits(pascalTransform(1u << bit)), secondDimension(1u << bit)) << bit;
    for (int i = 0; i < 10'000; ++i) {
        const auto index = static_cast<std::uint32_t>(random());
        ASSERT_EQ(reverseBits(pascalTransform(index)), secondDimension(index));
    }
}

/// Whatever lies at bit b and below changes no bit above b, and bit b alone flips bit b: so it is a bijection.
TEST(SampleSequence, ScramblesGoOneWay) {
    std::mt19937 random(2);
    for (int i = 0; i < 20'000; ++i) {
        const auto x = static_cast<std::uint32_t>(random());
        const auto key = static_cast<std::uint32_t>(random());
        for (std::uint32_t bit = 0; bit < 32; ++bit) {
            const std::uint32_t nested = nestedScramble(x, key) ^ nestedScramble(x ^ 1u << bit, key);
            ASSERT_EQ(nested >> bit, 1u) << "the highest bit that changes is the one that was changed";
            const std::uint32_t hashed = laineKarrasHash(x, key) ^ laineKarrasHash(x ^ 1u << bit, key);
            ASSERT_EQ(hashed << (31 - bit), 0x80000000u);
        }
    }
}

// --- Nets ---

/// For 2^m words of two dimensions: every box of 2^-i by 2^(i-m), i = 0 ... m, of the square holds one.
void expectNet(const std::vector<std::array<std::uint32_t, 2>>& points, std::uint32_t m) {
    ASSERT_EQ(points.size(), std::size_t{1} << m);
    for (std::uint32_t i = 0; i <= m; ++i) {
        std::vector<int> seen(points.size(), 0);
        for (const auto& point : points) {
            const std::uint64_t column = std::uint64_t{point[0]} >> (32 - i);
            const std::uint64_t row = std::uint64_t{point[1]} >> (32 - (m - i));
            ++seen[column << (m - i) | row];
        }
        for (const int count : seen) ASSERT_EQ(count, 1) << m << ' ' << i;
    }
}

/// The points of one pair of words at these indices.
template <typename Indices, typename Block>
std::vector<std::array<std::uint32_t, 2>> pairPoints(const Indices& indices, std::size_t pair, const Block& block) {
    std::vector<std::array<std::uint32_t, 2>> points;
    for (const SampleIndex& index : indices) {
        const PhiloxBlock words = block(index);
        points.push_back({words[2 * pair], words[2 * pair + 1]});
    }
    return points;
}

TEST(SampleSequence, SobolPairsOfAReplicateAreNets) {
    for (std::uint32_t m = 0; m <= 8; ++m)
        for (const std::uint32_t begin : {0u, 1u, 37u}) // aligned blocks of 2^m
            for (const std::uint32_t replicate : {0u, 7u, 15u}) {
                std::vector<SampleIndex> indices;
                for (std::uint32_t k = begin << m; k < (begin + 1) << m; ++k)
                    indices.push_back({11, 13, 16 * k + replicate});
                for (std::size_t pair = 0; pair < 2; ++pair)
                    for (const std::uint32_t block : {0u, 5u, 0x80000003u})
                        expectNet(pairPoints(indices, pair,
                                             [&](const SampleIndex& index) {
                                                 return sobolBlock({3, 14}, index, block);
                                             }),
                                  m);
            }
}

TEST(SampleSequence, BlueNoiseIsANetOverAlignedSquaresOfPixels) {
    constexpr SequencePlan plan{4, 3};
    for (std::uint32_t m = 0; m <= 4; ++m)
        for (const std::uint32_t place : {0u, 1u, 6u}) {
            std::vector<SampleIndex> all; // the 2^cellBits samples of a replicate
            for (std::uint32_t y = 0; y < 1u << m; ++y)
                for (std::uint32_t x = 0; x < 1u << m; ++x) {
                    const SampleIndex corner{(place << m) + x, (2 * place << m) + y, 9};
                    for (std::uint32_t k = 0; k < 8; ++k) all.push_back({corner.x, corner.y, 16 * k + 9});
                }
            for (std::size_t pair = 0; pair < 2; ++pair)
                expectNet(pairPoints(all, pair,
                                     [&](const SampleIndex& index) { return sobolBlueNoiseBlock(plan, index, 2); }),
                          2 * m + 3);
        }
}

// --- Strata ---

/// Every round of 2^B samples of a replicate hits every cell once, and its first 2^j samples each of the 2^j groups of
/// cells that share their row's highest bits.
TEST(SampleSequence, EveryRoundHitsEveryCell) {
    for (std::uint32_t bits = 0; bits <= 7; ++bits)
        for (std::uint32_t round = 0; round < 3; ++round)
            for (std::size_t pair = 0; pair < 2; ++pair) {
                const std::uint32_t columnBits = (bits + 1) / 2;
                std::set<std::uint64_t> cells;
                std::set<std::uint32_t> rows;
                for (std::uint32_t k = 0; k < 1u << bits; ++k) {
                    const SampleIndex index{8, 1, 16 * ((round << bits) + k) + 3};
                    const PhiloxBlock words = stratifiedBlock({5, bits}, index, 4);
                    const std::uint64_t column = std::uint64_t{words[2 * pair]} >> (32 - columnBits);
                    const std::uint64_t row = std::uint64_t{words[2 * pair + 1]} >> (32 - (bits - columnBits));
                    cells.insert(row << columnBits | column);
                    if (k < 1u << (bits - columnBits)) rows.insert(static_cast<std::uint32_t>(row));
                }
                EXPECT_EQ(cells.size(), std::size_t{1} << bits) << bits;
                EXPECT_EQ(rows.size(), std::size_t{1} << (bits - columnBits)) << "the first samples, one a row";
            }
}

} // namespace
} // namespace isolux
