#include "core/math.h"
#include "core/philox.h"

#include <gtest/gtest.h>

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

} // namespace
} // namespace isolux
