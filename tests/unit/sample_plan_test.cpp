// Which pixels take how many samples, and when a render stops; how biased stopping by the error is.
#include "film/sample_plan.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <thread>

namespace isolux {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::uint32_t> allPixels(const Film& film) {
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t y = 0; y < film.height; ++y)
        for (std::uint32_t x = 0; x < film.width; ++x) pixels.push_back(packPixel(x, y));
    return pixels;
}

SamplePlan planFor(const Film& film, const StoppingRule& rule, std::uint32_t samples) {
    return {rule, {0, samples}, FirstPasses::full, allPixels(film)};
}

/// Adds a pass whose samples are value(pixel's index, sample).
using Values = std::function<double(std::size_t, std::uint32_t)>;
void render(Film& film, const Pass& pass, const Values& value) {
    for (const std::uint32_t pixel : pass.pixels)
        for (std::uint32_t s = pass.firstSample; s < pass.firstSample + pass.sampleCount; ++s) {
            PixelStatistics& target = film.at(pixelX(pixel), pixelY(pixel));
            target.add(Vec3d(value(&target - film.pixels.data(), s)));
            ++target.hitCount;
        }
}

/// Renders until the plan ends; the sizes of the passes.
std::vector<std::uint32_t> renderAll(Film& film, SamplePlan& plan, const Values& value) {
    std::vector<std::uint32_t> sizes;
    while (const std::optional<Pass> pass = plan.next(film)) {
        render(film, *pass, value);
        sizes.push_back(pass->sampleCount);
    }
    return sizes;
}

double alternating(std::size_t /*pixel*/, std::uint32_t sample) { return sample % 2 == 0 ? 0.5 : 1.5; }

TEST(SamplePlan, WithoutARuleAllSamplesAreTakenInPassesOfSixteen) {
    Film film(2, 2);
    SamplePlan plan = planFor(film, {}, 40);
    EXPECT_EQ(renderAll(film, plan, alternating), (std::vector<std::uint32_t>{16, 16, 8}));
    EXPECT_EQ(film.minSampleCount(), 40u);
    EXPECT_EQ(film.maxSampleCount(), 40u);
    SamplePlan growing({}, {100, 40}, FirstPasses::growing, allPixels(film));
    EXPECT_EQ(renderAll(film, growing, alternating), (std::vector<std::uint32_t>{1, 1, 2, 4, 8, 16, 8}));
}

TEST(SamplePlan, PassesBeginWhereTheLastEnded) {
    const Film film(1, 1);
    SamplePlan plan({}, {7, 20}, FirstPasses::full, {packPixel(0, 0)});
    EXPECT_EQ(plan.next(film)->firstSample, 7u);
    EXPECT_EQ(plan.next(film)->firstSample, 23u);
    EXPECT_FALSE(plan.next(film));
    EXPECT_FALSE(planFor(film, {}, 0).next(film));
    EXPECT_EQ(planFor(film, {}, 0).fraction(0.0), 1.0);
}

TEST(SamplePlan, NoPassCrossesATest) {
    Film film(1, 1);
    SamplePlan plan = planFor(film, {{}, AdaptiveRule{1e-9, 20, 24}, {}}, 100);
    EXPECT_EQ(renderAll(film, plan, alternating), (std::vector<std::uint32_t>{16, 8, 16, 4, 16, 4, 16, 4, 16}));
    EXPECT_EQ(film.minSampleCount(), 100u);
}

TEST(SamplePlan, FinishedPixelsTakeNoMore) {
    Film film(9, 1); // the pixel at the left is noisy, and keeps its neighbour going
    SamplePlan plan = planFor(film, {{}, AdaptiveRule{0.05, 32, 64}, {}}, 4096);
    renderAll(film, plan,
              [](std::size_t pixel, std::uint32_t sample) { return pixel == 0 ? 4.0 * (sample % 2) : 1.0; });
    // Values 0 and 4 in turn: sigma is 2, so is the mean, and 1.96 / sqrt(n - 1) <= 0.05 from n = 1538 on.
    EXPECT_EQ(film.at(0, 0).sampleCount, 64u + 32u * 47u);
    EXPECT_EQ(film.at(1, 0).sampleCount, film.at(0, 0).sampleCount);
    for (std::uint32_t x = 2; x < 9; ++x) EXPECT_EQ(film.at(x, 0).sampleCount, 64u) << x;
}

TEST(SamplePlan, StopsWhenTheImageIsGoodEnough) {
    Film film(4, 4);
    SamplePlan plan = planFor(film, {{}, {}, 0.05}, 4096);
    EXPECT_EQ(renderAll(film, plan, alternating).size(), 7u); // 0.5 / sqrt(n - 1) <= 0.05: 101 samples, in sixteens
    EXPECT_EQ(plan.fraction(0.0), 1.0);
    EXPECT_LE(estimatedRelativeRmse(film), 0.05);
}

TEST(SamplePlan, TheErrorIsNotJudgedBySixteenSamplesLess) {
    Film film(1, 1);
    SamplePlan plan({{}, {}, 0.5}, {0, 100}, FirstPasses::growing, allPixels(film));
    renderAll(film, plan, [](std::size_t, std::uint32_t) { return 1.0; });
    EXPECT_EQ(film.minSampleCount(), 16u);
}

TEST(SamplePlan, NanNeverStops) {
    Film film(3, 1);
    SamplePlan plan = planFor(film, {{}, AdaptiveRule{10.0, 16, 16}, 10.0}, 64);
    renderAll(film, plan, [](std::size_t pixel, std::uint32_t) { return pixel == 0 ? kNan : 1.0; });
    EXPECT_EQ(film.at(0, 0).sampleCount, 64u);
    EXPECT_EQ(film.at(1, 0).sampleCount, 64u);
    EXPECT_EQ(film.at(2, 0).sampleCount, 16u);
}

/// 0/0 and NaN: no number of samples tells the error, and there may be no largest one.
TEST(SamplePlan, AnErrorThatStaysUnknownIsGivenUp) {
    for (const double value : {0.0, kNan}) {
        Film film(2, 1);
        SamplePlan plan = planFor(film, {{}, {}, 10.0}, 4096);
        renderAll(film, plan, [&](std::size_t, std::uint32_t) { return value; });
        EXPECT_EQ(film.minSampleCount(), 1024u) << value;
    }
    Film film(2, 1); // light that is found late is waited for
    SamplePlan plan = planFor(film, {{}, {}, 0.1}, 4096);
    renderAll(film, plan, [](std::size_t, std::uint32_t sample) { return sample == 1000 ? 1.0 : 0.0; });
    EXPECT_EQ(film.minSampleCount(), 4096u);
}

TEST(SamplePlan, ATimeLimitEndsIt) {
    Film film(1, 1);
    SamplePlan plan({1e-9, {}, {}}, {0, 100}, FirstPasses::full, allPixels(film));
    std::this_thread::sleep_for(std::chrono::milliseconds(1)); // no clock is too coarse for that
    EXPECT_EQ(renderAll(film, plan, alternating), std::vector<std::uint32_t>{1});
    EXPECT_EQ(plan.fraction(0.0), 1.0);
}

TEST(SamplePlan, TheFractionOnlyGrows) {
    Film film(40, 1);
    SamplePlan plan = planFor(film, {{}, AdaptiveRule{0.05, 32, 64}, 0.001}, 1000);
    double before = 0.0;
    std::mt19937 random(1);
    while (const std::optional<Pass> pass = plan.next(film)) {
        for (const double part : {0.0, 0.5, 1.0}) {
            EXPECT_GE(plan.fraction(part), before);
            before = plan.fraction(part);
        }
        EXPECT_LE(before, 1.0);
        render(film, *pass, [&](std::size_t pixel, std::uint32_t) {
            return std::lognormal_distribution(0.0, 0.04 * static_cast<double>(pixel))(random);
        });
    }
    EXPECT_EQ(plan.fraction(0.0), 1.0);
    EXPECT_LT(film.minSampleCount(), film.maxSampleCount());
}

// --- Satisfied pixels ---

Film uniformFilm(std::uint32_t width, std::uint32_t height, std::uint32_t samples) {
    Film film(width, height);
    for (PixelStatistics& pixel : film.pixels) {
        for (std::uint32_t s = 0; s < samples; ++s) pixel.add(Vec3d(1.0));
        pixel.hitCount = samples;
    }
    return film;
}

TEST(SatisfiedPixels, OneKeepsItsEightNeighboursAtEveryBorder) {
    for (const std::uint32_t x : {0u, 2u, 4u})
        for (const std::uint32_t y : {0u, 1u, 3u}) {
            Film film = uniformFilm(5, 4, 64);
            film.at(x, y).luminanceSquaredDeviation = 1e6;
            const std::vector<bool> satisfied = satisfiedPixels(film, {});
            for (std::uint32_t row = 0; row < 4; ++row)
                for (std::uint32_t column = 0; column < 5; ++column) {
                    const bool near =
                        std::max(row, y) - std::min(row, y) <= 1 && std::max(column, x) - std::min(column, x) <= 1;
                    EXPECT_EQ(satisfied[row * 5 + column], !near) << column << ' ' << row;
                }
        }
}

TEST(SatisfiedPixels, TheInequalityDecides) {
    // sigma = 1 and mean 1 at n samples: 1.96 / sqrt(n) <= tolerance.
    Film film = uniformFilm(1, 1, 400);
    film.at(0, 0).luminanceSquaredDeviation = 399.0;
    EXPECT_TRUE(satisfiedPixels(film, {.tolerance = 0.0981})[0]);
    EXPECT_FALSE(satisfiedPixels(film, {.tolerance = 0.0979})[0]);
}

TEST(SatisfiedPixels, RoundingBelowZeroIsNoVariance) {
    Film film = uniformFilm(1, 1, 64);
    film.at(0, 0).luminanceSquaredDeviation = -1e-18;
    EXPECT_TRUE(satisfiedPixels(film, {})[0]);
}

TEST(SatisfiedPixels, WithoutTwoSamplesNothingIs) {
    EXPECT_FALSE(satisfiedPixels(uniformFilm(1, 1, 0), {})[0]);
    EXPECT_FALSE(satisfiedPixels(uniformFilm(1, 1, 1), {})[0]);
    EXPECT_TRUE(satisfiedPixels(uniformFilm(1, 1, 2), {})[0]);
}

TEST(SatisfiedPixels, BlackWaitsWhereThereIsASurface) {
    const AdaptiveRule rule{0.05, 32, 64};
    for (const std::uint32_t samples : {64u, 1023u, 1024u}) {
        Film film(1, 1);
        for (std::uint32_t s = 0; s < samples; ++s) film.pixels[0].add(Vec3d(0.0));
        EXPECT_TRUE(satisfiedPixels(film, rule)[0]) << "nothing is there";
        film.pixels[0].hitCount = 1;
        EXPECT_EQ(satisfiedPixels(film, rule)[0], samples >= 1024);
    }
}

} // namespace
} // namespace isolux
