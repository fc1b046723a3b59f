// Heatmaps: colours ordered by lightness, ranges that are stated, values kept beside the colours.
#include "core/error.h"
#include "report/heatmap.h"
#include "report_images.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace isolux::test {
namespace {

double lightness(Ramp ramp, double t) { return luminance(rampColor(ramp, t)); }

Vec3d colorAt(const Image& image, std::size_t pixel) {
    return {image.value(pixel, 0), image.value(pixel, 1), image.value(pixel, 2)};
}

void expectColor(const Vec3d& color, const Vec3d& expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], 1e-6) << "channel " << c; // float32 of [0, 1]
}

TEST(Ramp, LargerIsLighterFromDarkToBright) {
    for (int i = 0; i < 256; ++i) {
        EXPECT_LT(lightness(Ramp::sequential, i / 256.0), lightness(Ramp::sequential, (i + 1) / 256.0)) << i;
    }
    EXPECT_LT(lightness(Ramp::sequential, 0.0), 0.01);
    EXPECT_GT(lightness(Ramp::sequential, 1.0), 0.8);
}

TEST(Ramp, DivergingIsLightestInTheMiddle) {
    for (int i = 0; i < 128; ++i) {
        EXPECT_LT(lightness(Ramp::diverging, i / 256.0), lightness(Ramp::diverging, (i + 1) / 256.0)) << i;
        EXPECT_LT(lightness(Ramp::diverging, 1.0 - i / 256.0), lightness(Ramp::diverging, 1.0 - (i + 1) / 256.0)) << i;
    }
    EXPECT_GT(rampColor(Ramp::diverging, 0.0).z, rampColor(Ramp::diverging, 0.0).x) << "blue below";
    EXPECT_GT(rampColor(Ramp::diverging, 1.0).x, rampColor(Ramp::diverging, 1.0).z) << "red above";
}

TEST(Ramp, EndsHoldBeyondAndNanIsGreen) {
    for (const Ramp ramp : {Ramp::sequential, Ramp::diverging}) {
        EXPECT_EQ(rampColor(ramp, kInfinity), rampColor(ramp, 1.0));
        EXPECT_EQ(rampColor(ramp, -kInfinity), rampColor(ramp, 0.0));
        EXPECT_EQ(rampColor(ramp, kNan), Vec3d(0.0, 1.0, 0.0));
    }
}

TEST(Heatmap, BiasIsSignedAndItsRangeHoldsNearlyAll) {
    const Image reference = uniformImage(10, 10, 1.0f);
    Image image = reference;
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = i < 150 ? 1.5f : 0.5f;
    image.values[0] = image.values[1] = image.values[2] = 1000.0f; // one of a hundred: beyond the range
    const Heatmap heatmap = makeHeatmap(HeatmapQuantity::bias, image, reference, compareImages(image, reference));
    const double expected = 0.5 / std::sqrt(1.01);
    EXPECT_NEAR(heatmap.range.high, expected, 1e-12);
    EXPECT_EQ(heatmap.range.low, -heatmap.range.high);
    EXPECT_NEAR(heatmap.image.value(60, 3), -expected, 1e-7);
    EXPECT_NEAR(heatmap.image.value(0, 3), 999.0 / std::sqrt(1.01), 1e-3);
    expectColor(colorAt(heatmap.image, 0), rampColor(Ramp::diverging, 1.0));
    expectColor(colorAt(heatmap.image, 10), rampColor(Ramp::diverging, 1.0));
    expectColor(colorAt(heatmap.image, 99), rampColor(Ramp::diverging, 0.0));
}

TEST(Heatmap, FlipRunsFromZeroToOne) {
    const Image reference = uniformImage(8, 8, 0.5f);
    Image image = reference;
    image.values[0] = std::numeric_limits<float>::quiet_NaN();
    const ComparisonReport report = compareImages(image, reference, {}, FlipOptions{DynamicRange::low, 1.0});
    const Heatmap heatmap = makeHeatmap(HeatmapQuantity::flip, image, reference, report);
    EXPECT_EQ(heatmap.range.low, 0.0);
    EXPECT_EQ(heatmap.range.high, 1.0);
    expectColor(colorAt(heatmap.image, 0), {0.0, 1.0, 0.0});
    expectColor(colorAt(heatmap.image, 63), rampColor(Ramp::sequential, 0.0));
    EXPECT_THROW((void)makeHeatmap(HeatmapQuantity::flip, image, reference, compareImages(image, reference)), Error);
}

TEST(Heatmap, EqualImagesHaveARangeAllTheSame) {
    const Image image = uniformImage(4, 4, 1.0f);
    const Heatmap heatmap = makeHeatmap(HeatmapQuantity::relMse, image, image, compareImages(image, image));
    EXPECT_EQ(heatmap.range.high, 1.0);
    expectColor(colorAt(heatmap.image, 5), rampColor(Ramp::sequential, 0.0));
}

TEST(Heatmap, BlocksShowTheirZUpToTheLimit) {
    const Image reference = makeImage(32, 16, {"R", "G", "B", "se.R", "se.G", "se.B"}, 1.0f);
    Image image = uniformImage(32, 16, 1.0f);
    for (std::size_t pixel = 0; pixel < 512; ++pixel) {
        if (pixel % 32 < 16) image.values[3 * pixel] = image.values[3 * pixel + 1] = image.values[3 * pixel + 2] = 9.0f;
    }
    const ComparisonReport report = compareImages(image, reference);
    const Heatmap heatmap = makeHeatmap(HeatmapQuantity::blocks, image, reference, report);
    EXPECT_EQ(heatmap.range.high, report.blocks->limit);
    EXPECT_NEAR(heatmap.image.value(15, 3), 8.0 * 16.0, 1e-4);
    expectColor(colorAt(heatmap.image, 15), rampColor(Ramp::diverging, 1.0));
    expectColor(colorAt(heatmap.image, 16), rampColor(Ramp::diverging, 0.5));
    const Image plain = uniformImage(32, 16, 1.0f);
    EXPECT_THROW((void)makeHeatmap(HeatmapQuantity::blocks, image, plain, compareImages(image, plain)), Error);
}

TEST(Heatmap, IsNamedInTheReport) {
    ComparisonReport report = compareImages(uniformImage(4, 4, 1.0f), uniformImage(4, 4, 2.0f), {{}, {}, 0.01},
                                            FlipOptions{DynamicRange::high, kPixelsPerDegree});
    report.heatmap = HeatmapRange{"FLIP", 0.0, 1.0, "map.png"};
    const std::string text = toText(report);
    expectMentions(text, "map.png, FLIP from 0 to 1");
    expectMentions(text, "high dynamic range, 67.02 pixels per degree, 2 exposures");
    expectMentions(text, "FLIP 0.01: EXCEEDED");
    expectMentions(text, "no variance to judge noise by");
    const auto json = toJson(report);
    EXPECT_EQ(json["heatmap"]["file"], "map.png");
    EXPECT_EQ(json["flip"]["range"], "high");
    EXPECT_EQ(json["flip"]["exposures"]["count"], 2);
    EXPECT_TRUE(json["blocks"].is_null());
    EXPECT_TRUE(json["outliers"]["beyondNoise"].is_null());
    const auto plain = toJson(compareImages(uniformImage(4, 4, 1.0f), uniformImage(4, 4, 1.0f)));
    EXPECT_TRUE(plain["flip"].is_null());
    EXPECT_TRUE(plain["heatmap"].is_null());
}

} // namespace
} // namespace isolux::test
