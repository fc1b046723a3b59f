#include "core/math.h"
#include "core/pacing.h"
#include "core/philox.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace isolux {
namespace {

// Known answers published with the reference implementation (Random123, kat_vectors).
TEST(Philox, KnownAnswers) {
    EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (PhiloxBlock{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
              (PhiloxBlock{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (PhiloxBlock{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, UnitNumbersAreNeverOneAndTheSameInBothPrecisions) {
    for (const std::uint32_t word :
         {0u, 1u, 0xffu, 0x100u, 0x80000000u, 0xffffff00u, 0xffffff80u, 0xfffffffeu, 0xffffffffu}) {
        EXPECT_LT(unitReal<float>(word), 1.0f);
        EXPECT_GE(unitReal<float>(word), 0.0f);
        EXPECT_EQ(static_cast<double>(unitReal<float>(word)), unitReal<double>(word));
    }
    EXPECT_EQ(unitReal<double>(0xffffffffu), 1.0 - 1.0 / 16777216.0);
}

TEST(Philox, IndicesChangeEveryWord) {
    const PhiloxBlock base = randomBlock(7, 10, 20, 30, 40);
    for (const PhiloxBlock& other :
         {randomBlock(8, 10, 20, 30, 40), randomBlock(7, 11, 20, 30, 40), randomBlock(7, 10, 21, 30, 40),
          randomBlock(7, 10, 20, 31, 40), randomBlock(7, 10, 20, 30, 41),
          randomBlock(7 + (std::uint64_t{1} << 32), 10, 20, 30, 40)})
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NE(base[i], other[i]);
}

TEST(Box, EmptyAndExtended) {
    Box3d box;
    EXPECT_TRUE(box.empty());
    EXPECT_EQ(box.halfArea(), 0.0);
    box.extend(Vec3d(1, 2, 3));
    EXPECT_FALSE(box.empty());
    box.extend(Vec3d(2, 4, 6));
    EXPECT_EQ(box.halfArea(), 1 * 2 + 2 * 3 + 3 * 1);
    EXPECT_EQ(box.center(), Vec3d(1.5, 3, 4.5));
}

TEST(Pacing, WithoutALimitPassesAreAsLargeAsTheyMayBe) {
    const Pacing pacing(std::nullopt, 16);
    EXPECT_EQ(pacing.nextPass(0, 100), 16u);
    EXPECT_EQ(pacing.nextPass(96, 100), 4u);
    EXPECT_EQ(pacing.nextPass(100, 100), 0u);
    EXPECT_EQ(pacing.nextPass(0, 7), 7u);
    EXPECT_EQ(pacing.nextPass(0, 0), 0u);
    EXPECT_EQ(pacing.fraction(0.0, 100), 0.0);
    EXPECT_EQ(pacing.fraction(12.5, 100), 0.125);
    EXPECT_EQ(pacing.fraction(100.0, 100), 1.0);
}

TEST(Pacing, WithoutTimeThereIsOneSample) {
    for (const double seconds : {0.0, 1e-9, -1.0}) {
        const Pacing pacing(seconds, 16);
        std::this_thread::sleep_for(std::chrono::milliseconds(1)); // no clock is too coarse for that
        EXPECT_EQ(pacing.nextPass(0, 100), 1u);
        EXPECT_EQ(pacing.nextPass(1, 100), 0u);
        EXPECT_EQ(pacing.nextPass(0, 0), 0u);
    }
    EXPECT_EQ(Pacing(1e-9, 16).fraction(1.0, 100), 1.0) << "time ends before the samples do";
}

TEST(Pacing, WithTimeToSparePassesGrowFromOne) {
    const Pacing pacing(1e9, 16);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::uint32_t done = 0;
    for (const std::uint32_t expected : {1u, 1u, 2u, 4u, 8u, 16u, 16u, 2u, 0u}) {
        const std::uint32_t pass = pacing.nextPass(done, 50);
        EXPECT_EQ(pass, expected) << "after " << done;
        done += pass;
    }
    EXPECT_EQ(pacing.fraction(25.0, 50), 0.5);
}

TEST(Pacing, TheLastPassFitsInWhatIsLeft) {
    // However long the machine really sleeps: three quarters of the time or more are gone for the first 900.
    const Pacing pacing(0.02, 1000);
    std::this_thread::sleep_for(std::chrono::milliseconds(15));
    EXPECT_LE(pacing.nextPass(900, 100000), 300u);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(pacing.nextPass(1200, 100000), 0u);
    EXPECT_EQ(pacing.fraction(1200.0, 100000), 1.0);
}

} // namespace
} // namespace isolux
