// FLIP against its authors' own program, on images made by the formulas of tests/support/flip_figures.py.
#include "core/error.h"
#include "flip_figures.h"
#include "report/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace isolux::test {
namespace {

using PixelFunction = std::function<double(std::uint32_t x, std::uint32_t y, std::uint32_t channel)>;

std::uint32_t hashed(std::uint32_t x, std::uint32_t y, std::uint32_t channel, std::uint32_t seed) {
    std::uint32_t value = seed * 0x9E3779B9u + channel * 0x85EBCA6Bu + x * 0xC2B2AE35u + y * 0x27D4EB2Fu;
    value = (value ^ (value >> 16u)) * 0x7FEB352Du;
    value = (value ^ (value >> 15u)) * 0x846CA68Bu;
    return value ^ (value >> 16u);
}

double noise(std::uint32_t x, std::uint32_t y, std::uint32_t channel, std::uint32_t seed) {
    return std::ldexp(hashed(x, y, channel, seed) >> 8u, -24);
}

double gradient(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    const std::array<std::uint32_t, 3> ramps{x, y, x + y};
    return (x / 16 + y / 16) % 2 == 0 ? ramps[channel] % 128 / 128.0 : 0.25;
}

double disturbed(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    if (x == 20 && y == 40) return 1.0;
    if (channel == 0 && x >= 40 && x < 60 && y >= 30 && y < 36) return 1.0;
    return gradient(x, y, channel) * (15.0 / 16.0) + noise(x, y, channel, 3) / 16.0;
}

double radiance(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    const int stops = static_cast<int>(hashed(x / 16, y / 16, 0, 5) % 12);
    return x < 24 ? 0.0 : std::ldexp(gradient(x, y, channel) + 1.0 / 64.0, stops - 6);
}

double noisyRadiance(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    if (x == 70 && y == 33) return 1000.0;
    return radiance(x, y, channel) * (0.5 + noise(x, y, channel, 7));
}

double spotlight(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    return x >= 100 && x < 140 && y >= 60 && y < 90 ? 8.0 + gradient(x, y, channel) : 0.0;
}

double leakingSpotlight(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    return spotlight(x, y, channel) + 1.0 / 1024.0;
}

PixelFunction noiseOfSeed(std::uint32_t seed) {
    return [seed](std::uint32_t x, std::uint32_t y, std::uint32_t channel) { return noise(x, y, channel, seed); };
}

Image makeImage(std::uint32_t width, std::uint32_t height, const PixelFunction& function) {
    Image image{width, height, {"R", "G", "B"}, {}, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            for (std::uint32_t c = 0; c < 3; ++c) image.values.push_back(static_cast<float>(function(x, y, c)));
        }
    }
    return image;
}

struct Pair {
    Image image;
    Image reference;
    double pixelsPerDegree = kPixelsPerDegree;
};

/// The images of a row of the figures.
Pair makePair(const std::string& name) {
    const auto make = [](std::uint32_t width, std::uint32_t height, const PixelFunction& image,
                         const PixelFunction& reference, double pixelsPerDegree = kPixelsPerDegree) {
        return Pair{makeImage(width, height, image), makeImage(width, height, reference), pixelsPerDegree};
    };
    if (name == "noise") return make(64, 48, noiseOfSeed(1), noiseOfSeed(2));
    if (name == "gradient") return make(96, 64, disturbed, gradient);
    if (name == "gradientFromAfar") return make(96, 64, disturbed, gradient, 120.0);
    if (name == "gradientFromNear") return make(96, 64, disturbed, gradient, 20.0);
    if (name == "radiance") return make(128, 96, noisyRadiance, radiance);
    if (name == "spotlight") return make(256, 192, leakingSpotlight, spotlight);
    return make(1, 1, noiseOfSeed(1), noiseOfSeed(2));
}

/// How far single precision may lead the authors' program away. The derivatives of a flat image are 0 but for rounding,
/// some 2^-24 of the values, and enter FLIP by their square root: 2^-12 at most, times |e log e| <= 1/e of the colour
/// error. Where there is texture, rounding enters linearly and averages out.
double toleranceOf(const FlipFigures& figures) {
    const std::string name = figures.name;
    return name == "singlePixel" || name == "spotlight" ? 9e-5 : 2e-6;
}

TEST(Flip, AgreesWithItsAuthorsProgram) {
    for (const FlipFigures& figures : kFlipFigures) {
        const Pair pair = makePair(figures.name);
        const DynamicRange range = figures.highRange ? DynamicRange::high : DynamicRange::low;
        const FlipResult result = flip(pair.image, pair.reference, {range, pair.pixelsPerDegree});
        SCOPED_TRACE(std::string(figures.name) + (figures.highRange ? ", high range" : ", low range"));
        EXPECT_NEAR(result.mean, figures.mean, toleranceOf(figures));
        for (std::size_t i = 0; i < figures.pixels.size(); ++i) {
            EXPECT_NEAR(result.errors[i * result.errors.size() / 5], figures.pixels[i], toleranceOf(figures));
        }
        ASSERT_EQ(result.exposures.has_value(), figures.highRange);
        if (!result.exposures) continue;
        EXPECT_NEAR(result.exposures->start, figures.start, 4e-6); // 2^-24 of a luminance, and of exposures up to 24
        EXPECT_NEAR(result.exposures->stop, figures.stop, 4e-6);
        EXPECT_EQ(result.exposures->count, figures.exposures);
    }
}

TEST(Flip, EqualImagesDoNotDiffer) {
    const Image image = makeImage(40, 30, noisyRadiance);
    for (const DynamicRange range : {DynamicRange::low, DynamicRange::high}) {
        const FlipResult result = flip(image, image, {range});
        EXPECT_EQ(result.mean, 0.0);
        EXPECT_EQ(result.largest, 0.0);
    }
}

TEST(Flip, LowRangeIsSymmetric) {
    const Pair pair = makePair("gradient");
    const double mean = flip(pair.image, pair.reference, {DynamicRange::low}).mean;
    EXPECT_EQ(flip(pair.reference, pair.image, {DynamicRange::low}).mean, mean);
}

TEST(Flip, NonFinitePixelsSpoilTheMeanAndTheirNeighbourhoodOnly) {
    for (const float defect : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        for (const DynamicRange range : {DynamicRange::low, DynamicRange::high}) {
            Pair pair = makePair("radiance");
            pair.image.values[1] = defect;
            const FlipResult result = flip(pair.image, pair.reference, {range});
            EXPECT_TRUE(std::isnan(result.mean));
            EXPECT_TRUE(std::isnan(result.largest));
            EXPECT_TRUE(std::isnan(result.errors.front()));
            EXPECT_TRUE(std::isfinite(result.errors.back()));
        }
    }
}

TEST(Flip, NegativeValuesCountAsBlack) {
    const Image black = makeImage(4, 4, [](auto...) { return 0.0; });
    const Image negative = makeImage(4, 4, [](auto...) { return -3.0; });
    EXPECT_EQ(flip(negative, black, {DynamicRange::low}).mean, 0.0);
    EXPECT_EQ(flip(negative, black, {DynamicRange::high}).mean, 0.0);
}

TEST(Flip, ABlackReferenceHasFiniteExposures) {
    const Image black = makeImage(4, 4, [](auto...) { return 0.0; });
    const FlipResult result = flip(makeImage(4, 4, noiseOfSeed(1)), black);
    ASSERT_TRUE(result.exposures);
    EXPECT_EQ(result.exposures->start, result.exposures->stop);
    EXPECT_NEAR(result.exposures->start, 24.083, 1e-3);
    EXPECT_GT(result.mean, 0.5);
    EXPECT_LE(result.largest, 1.0);
}

TEST(Flip, ImagesMustFit) {
    const Image image = makeImage(4, 2, noiseOfSeed(1));
    EXPECT_THROW((void)flip(image, makeImage(2, 4, noiseOfSeed(1))), Error);
    Image other = image;
    other.channels = {"X", "Y", "Z"};
    EXPECT_THROW((void)flip(image, other), Error);
}

} // namespace
} // namespace isolux::test
