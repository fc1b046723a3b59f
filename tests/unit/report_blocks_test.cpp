// Blocks and outliers: the budget of errors holds, seeded faults are found, equality is judged by rounding alone.
#include "core/error.h"
#include "report/comparison.h"
#include "report_images.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <random>

namespace isolux::test {
namespace {

constexpr float kSamples = 4.0f;

/// A pixel of value 1 in every channel, of variance `deviation`^2 in every channel and in luminance.
Image noisyImage(std::uint32_t width, std::uint32_t height, float deviation) {
    Image image =
        makeImage(width, height, {"R", "G", "B", "variance.R", "variance.G", "variance.B", "variance.Y", "samples.Y"});
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        float* const values = image.values.data() + 8 * pixel;
        std::fill(values, values + 3, 1.0f);
        std::fill(values + 3, values + 7, kSamples * deviation * deviation);
        values[7] = kSamples;
    }
    return image;
}

void addToPixel(Image& image, std::size_t pixel, float value) {
    for (std::size_t c = 0; c < 3; ++c) image.values[image.channels.size() * pixel + c] += value;
}

Image noisyImage(std::mt19937& engine, std::uint32_t width, std::uint32_t height, float deviation) {
    std::normal_distribution<float> normal(0.0f, deviation);
    Image image = noisyImage(width, height, deviation);
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) addToPixel(image, pixel, normal(engine));
    return image;
}

BlockComparison compared(const Image& image, const Image& reference, std::span<const std::uint8_t> mask = {}) {
    const std::optional<BlockComparison> comparison = compareBlocks(image, reference, mask);
    if (!comparison) throw std::logic_error("no variance");
    return *comparison;
}

// --- Geometry ---

TEST(BlockGrid, CoversEveryPixelOnce) {
    for (const auto& [width, height] : {std::pair{64u, 32u}, {37u, 50u}, {15u, 1u}, {1u, 1u}, {47u, 33u}}) {
        const BlockGrid grid(width, height);
        const std::size_t pixelCount = std::size_t{width} * height;
        std::vector<std::size_t> first(grid.count(), pixelCount);
        for (std::size_t pixel = 0; pixel < pixelCount; ++pixel)
            first.at(grid.of(pixel)) = std::min(first.at(grid.of(pixel)), pixel);
        for (std::size_t block = 0; block < grid.count(); ++block)
            EXPECT_EQ(grid.top(block) * width + grid.left(block), first[block]) << width << " x " << height;
    }
    EXPECT_EQ(BlockGrid(47, 33).count(), 4u) << "remainders are spread over the blocks";
}

// --- The budget ---

TEST(ZLimit, KeepsTheFamilyError) {
    EXPECT_NEAR(zLimit(1, 0.05), 1.959963984540054, 1e-12);
    for (const std::size_t tests : {2u, 65u, 1000000u}) {
        const double tail = 0.5 * std::erfc(zLimit(tests, 0.01) / std::sqrt(2.0));
        EXPECT_NEAR(std::pow(1.0 - 2.0 * tail, static_cast<double>(tests)), 0.99, 1e-9) << tests;
    }
}

TEST(Blocks, FalseAlarmsKeepTheBudget) {
    std::mt19937 engine(3);
    constexpr int kTrials = 1000;
    int alarms = 0;
    int beyond95 = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        const BlockComparison comparison =
            compared(noisyImage(engine, 64, 32, 0.5f), noisyImage(engine, 64, 32, 0.25f));
        ASSERT_EQ(comparison.noisyBlocks, 8u);
        alarms += !comparison.agree();
        beyond95 += static_cast<int>(comparison.beyond95);
    }
    expectBinomial(alarms, kTrials, kFamilyError);
    expectBinomial(beyond95, 8 * kTrials, 0.05);
}

TEST(Blocks, HandComputedFigures) {
    Image image = noisyImage(32, 16, 0.3f);
    for (std::size_t y = 0; y < 16; ++y) addToPixel(image, y * 32 + 20, 0.5f); // 16 of the right block's 256 pixels
    const BlockComparison comparison = compared(image, noisyImage(32, 16, 0.4f));
    ASSERT_EQ(comparison.blocks.size(), 2u);
    const BlockDifference& right = comparison.blocks[1];
    EXPECT_EQ(right.x, 16u);
    EXPECT_EQ(right.y, 0u);
    EXPECT_EQ(right.pixelCount, 256u);
    EXPECT_NEAR(right.difference, 0.5 / 16.0, 1e-12);
    EXPECT_NEAR(right.standardError, 0.5 / 16.0, 1e-8); // sqrt(0.09 + 0.16) over sqrt(256)
    EXPECT_NEAR(right.z, 1.0, 1e-5);                    // less 2^-23 of rounding over 1/32
    EXPECT_EQ(comparison.blocks[0].z, 0.0);
    EXPECT_NEAR(comparison.whole.z, 1.0 / std::sqrt(2.0), 1e-5);
    EXPECT_EQ(comparison.worst, 1u);
    EXPECT_TRUE(comparison.agree());
    EXPECT_EQ(comparison.limit, zLimit(3, kFamilyError));
}

TEST(Blocks, AFaultInOneBlockIsFoundAndLocated) {
    std::mt19937 engine(8);
    Image image = noisyImage(engine, 128, 128, 0.1f);
    for (std::size_t y = 32; y < 48; ++y) {
        for (std::size_t x = 64; x < 80; ++x) addToPixel(image, y * 128 + x, 0.1f);
    }
    const Image reference = noisyImage(engine, 128, 128, 0.1f);
    const BlockComparison comparison = compared(image, reference);
    EXPECT_FALSE(comparison.agree());
    EXPECT_EQ(comparison.beyondLimit, 1u);
    EXPECT_EQ(comparison.blocks[comparison.worst].x, 64u);
    EXPECT_EQ(comparison.blocks[comparison.worst].y, 32u);
    const ComparisonReport report = compareImages(image, reference, {{}, {}, {}, BlockCheck::enforced});
    EXPECT_EQ(report.verdict(), Verdict::exceeded);
    expectMentions(toText(report), "at (64, 32)");
    expectMentions(toText(report), "DIFFER");
    EXPECT_EQ(toJson(report)["blocks"]["worst"]["x"], 64);
    EXPECT_EQ(compareImages(image, reference).verdict(), Verdict::within) << "reported, not enforced";
}

TEST(Blocks, TheMeanFindsWhatNoBlockDoes) {
    Image image = noisyImage(128, 128, 0.1f);
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) addToPixel(image, pixel, 0.01f);
    const BlockComparison comparison = compared(image, noisyImage(128, 128, 0.1f));
    EXPECT_EQ(comparison.beyondLimit, 0u);
    EXPECT_FALSE(comparison.agree());
}

// --- What the variance rests on ---

TEST(Blocks, LuminanceIsBoundedWhereOnlyChannelsCarryVariance) {
    Image image = makeImage(1, 1, {"R", "G", "B", "se.R", "se.G", "se.B"}, 1.0f);
    const BlockComparison comparison = compared(image, uniformImage(1, 1, 1.0f));
    EXPECT_NEAR(comparison.whole.standardError, 1.0, 1e-12) << "as if the channels were fully correlated";
}

TEST(Blocks, WithoutVarianceThereIsNothingToCompareBy) {
    const Image image = uniformImage(4, 4, 1.0f);
    EXPECT_FALSE(compareBlocks(image, image));
    EXPECT_TRUE(compareBlocks(noisyImage(4, 4, 0.1f), image)) << "the other one is taken as exact";
    EXPECT_THROW((void)compareImages(image, image, {{}, {}, {}, BlockCheck::enforced}), Error);
    EXPECT_THROW((void)compareBlocks(noisyImage(4, 4, 0.1f), uniformImage(2, 8, 1.0f)), Error);
}

TEST(Blocks, WithoutNoiseOnlyRoundingMayDiffer) {
    const Image reference = noisyImage(16, 16, 0.0f);
    Image image = reference;
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) addToPixel(image, pixel, 0x1p-23f);
    BlockComparison comparison = compared(image, reference);
    EXPECT_EQ(comparison.noisyBlocks, 0u);
    EXPECT_EQ(comparison.blocks[0].z, 0.0) << "neighbouring floats may store the same value";
    EXPECT_TRUE(comparison.agree());
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) addToPixel(image, pixel, 0x1p-23f);
    comparison = compared(image, reference);
    EXPECT_EQ(comparison.blocks[0].z, kInfinity);
    EXPECT_FALSE(comparison.agree());
}

TEST(Blocks, MaskedPixelsAreLeftOutAndCounted) {
    Image image = noisyImage(32, 16, 0.1f);
    addToPixel(image, 5, 1000.0f);
    std::vector<std::uint8_t> mask(image.pixelCount(), 1);
    mask[5] = 0;
    BlockComparison comparison = compared(image, noisyImage(32, 16, 0.1f), mask);
    EXPECT_EQ(comparison.excludedPixels, 1u);
    EXPECT_EQ(comparison.blocks[0].pixelCount, 255u);
    EXPECT_EQ(comparison.whole.pixelCount, 511u);
    EXPECT_TRUE(comparison.agree());
    for (std::size_t pixel = 0; pixel < mask.size(); ++pixel) mask[pixel] = pixel % 32 >= 16;
    comparison = compared(image, noisyImage(32, 16, 0.1f), mask);
    ASSERT_EQ(comparison.blocks.size(), 1u) << "a block without pixels is no block";
    EXPECT_EQ(comparison.blocks[0].x, 16u);
    std::fill(mask.begin(), mask.end(), std::uint8_t{0});
    comparison = compared(image, noisyImage(32, 16, 0.1f), mask);
    EXPECT_FALSE(comparison.agree()) << "nothing was compared";
    EXPECT_TRUE(toJson(comparison)["worst"].is_null());
}

TEST(Blocks, NonFinitePixelsNeverAgree) {
    for (const float defect : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image image = noisyImage(64, 16, 0.1f);
        addToPixel(image, 40, defect);
        addToPixel(image, 60, 1000.0f);
        const BlockComparison comparison = compared(image, noisyImage(64, 16, 0.1f));
        EXPECT_TRUE(std::isnan(comparison.whole.z));
        EXPECT_EQ(comparison.worst, 2u) << "NaN counts as larger than any";
        EXPECT_EQ(comparison.beyondLimit, 2u);
        EXPECT_FALSE(comparison.agree());
        const ComparisonReport report =
            compareImages(image, noisyImage(64, 16, 0.1f), {{}, {}, {}, BlockCheck::enforced});
        EXPECT_EQ(report.verdict(), Verdict::exceeded);
    }
}

// --- Outliers ---

TEST(Outliers, AreBeyondTheNoiseOfBothImages) {
    Image image = noisyImage(32, 32, 0.3f);
    addToPixel(image, 7, 0.5f * 4.4f); // of 0.5 = sqrt(0.09 + 0.16); the limit of 1024 pixels is 4.42
    addToPixel(image, 8, 0.5f * 4.45f);
    const Outliers outliers = findOutliers(image, noisyImage(32, 32, 0.4f));
    EXPECT_EQ(outliers.beyondNoise, 1u);
    EXPECT_EQ(outliers.zLimit, zLimit(1024, kFamilyError));
    EXPECT_FALSE(findOutliers(uniformImage(4, 4, 1.0f), uniformImage(4, 4, 9.0f)).beyondNoise);
}

TEST(Outliers, FirefliesAreBrightAloneInOneImage) {
    const Image reference = uniformImage(16, 16, 1.0f);
    Image image = reference;
    addToPixel(image, 0, 9.5f);      // 10.5 times its surroundings, in a corner
    addToPixel(image, 16 * 8, 8.5f); // 9.5 times
    const Outliers outliers = findOutliers(image, reference);
    EXPECT_EQ(outliers.imageFireflies, 1u);
    EXPECT_EQ(outliers.referenceFireflies, 0u);
    EXPECT_EQ(findOutliers(reference, image).referenceFireflies, 1u);
    EXPECT_EQ(findOutliers(image, image).imageFireflies, 0u) << "what the other image has too is no firefly";
}

TEST(Outliers, EdgesAreNoFireflies) {
    Image image = uniformImage(16, 16, 0.0f);
    Image reference = image;
    for (std::size_t y = 0; y < 16; ++y) {
        for (std::size_t x = 8; x < 16; ++x) {
            addToPixel(reference, y * 16 + x, 1.0f);
            addToPixel(image, y * 16 + x - 1, 1.0f); // the same edge, a pixel to the left
        }
    }
    EXPECT_EQ(findOutliers(image, reference).imageFireflies, 0u);
    const Image black = uniformImage(16, 16, 0.0f);
    EXPECT_EQ(findOutliers(image, black).imageFireflies, 0u) << "a bright area is not a single pixel";
    Image spark = black;
    addToPixel(spark, 100, 1e-6f);
    EXPECT_EQ(findOutliers(spark, black).imageFireflies, 1u);
}

TEST(Outliers, DefectsAreNotCounted) {
    Image image = uniformImage(1, 1, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(findOutliers(image, uniformImage(1, 1, 1.0f)).imageFireflies, 0u);
    image = noisyImage(4, 4, 0.1f);
    addToPixel(image, 3, std::numeric_limits<float>::infinity());
    const Outliers outliers = findOutliers(image, noisyImage(4, 4, 0.1f));
    EXPECT_EQ(outliers.imageFireflies, 0u);
    EXPECT_EQ(outliers.beyondNoise, 0u);
}

} // namespace
} // namespace isolux::test
