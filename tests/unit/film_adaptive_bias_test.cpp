// How far stopping by the error darkens: Monte Carlo over pixels whose mean is 1, with the default rule. The figures of
// host/film/README.md come from here.
#include "film/sample_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace isolux {
namespace {

constexpr std::uint32_t kRuns = 16; // intervals are across independent runs, never across pixels
constexpr double kStudent = 5.24;   // t of 15 degrees of freedom, two-sided, 1e-4

using Values = std::function<double(std::mt19937&)>;

/// Log-normal with sigma 1: the fireflies of a path tracer.
double logNormal(std::mt19937& random) { return std::lognormal_distribution(-0.5, 1.0)(random); }

/// All light comes from one sample in a hundred.
double rare(std::mt19937& random) { return random() % 100 == 0 ? 100.0 : 0.0; }

/// The same over even light that makes up a tenth.
double rareOverDim(std::mt19937& random) { return 0.1 + 0.9 * rare(random); }

/// How samples are dealt with, and how many pixels of their kind lie side by side.
enum class Sampling { independent, replicates };
struct Setting {
    Values values;
    std::uint32_t edge = 1; ///< 1: alone
    std::uint32_t films = 1;
    Sampling sampling = Sampling::independent;
    std::uint32_t maxSamples = 8192;
    double usualSamples = 3000.0; ///< a constant for the control variate, near what pixels take
};

/// Averages over the pixels of a film.
struct Totals {
    double excess = 0.0;
    double samples = 0.0;
};

void takePass(Film& film, const Pass& pass, const Values& values, std::mt19937& random) {
    for (const std::uint32_t pixel : pass.pixels) {
        const std::size_t index = std::size_t{pixelY(pixel)} * film.width + pixelX(pixel);
        for (std::uint32_t s = pass.firstSample; s < pass.firstSample + pass.sampleCount; ++s) {
            const Vec3d value(values(random));
            film.pixels[index].add(value);
            ++film.pixels[index].hitCount;
            if (!film.replicates.empty()) film.replicates[index].add(s, value);
        }
    }
    film.refineVariance();
}

Totals renderFilm(const Setting& setting, std::mt19937& random) {
    Film film(setting.edge, setting.edge);
    if (setting.sampling == Sampling::replicates) film.keepReplicates();
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t i = 0; i < film.pixels.size(); ++i)
        pixels.push_back(packPixel(i % setting.edge, i / setting.edge));
    SamplePlan plan({{}, AdaptiveRule{}, {}}, {0, setting.maxSamples}, FirstPasses::full, pixels);
    while (const std::optional<Pass> pass = plan.next(film)) takePass(film, *pass, setting.values, random);
    Totals totals;
    for (const PixelStatistics& pixel : film.pixels) {
        const auto samples = static_cast<double>(pixel.sampleCount);
        // E[sum] = E[n] * mean (Wald), so (mean - 1) n has mean 0 and takes most of the noise away.
        totals.excess += (pixel.mean.x - 1.0) * (1.0 - samples / setting.usualSamples);
        totals.samples += samples;
    }
    totals.excess /= static_cast<double>(film.pixels.size());
    totals.samples /= static_cast<double>(film.pixels.size());
    return totals;
}

struct Bias {
    double estimate = 0.0;
    double halfWidth = 0.0; ///< of its interval
    double samples = 0.0;   ///< a pixel took
};

Bias measure(const Setting& setting) {
    PixelStatistics runs;
    Bias bias;
    for (std::uint32_t run = 0; run < kRuns; ++run) {
        std::mt19937 random(run);
        Totals sum;
        for (std::uint32_t i = 0; i < setting.films; ++i) {
            const Totals totals = renderFilm(setting, random);
            sum.excess += totals.excess / setting.films;
            bias.samples += totals.samples / setting.films / kRuns;
        }
        runs.add(Vec3d(sum.excess));
    }
    bias.estimate = runs.mean.x;
    bias.halfWidth = kStudent * std::sqrt(runs.variance().x / kRuns);
    return bias;
}

/// By E[sum] = E[n] * mean (Wald), the bias of the mean is -Cov(mean, n)/E[n]; n is proportional to variance / mean^2,
/// so to first order that is -(tolerance / 1.96)^2 (skewness / coefficient of variation - 2): -0.18 % here, for the
/// log-normal's skewness of 6.185 and coefficient of variation of 1.311. Neighbours only make pixels take more.
constexpr double kFirstOrder = 0.0018;

TEST(AdaptiveBias, LogNormalPixelsDarkenAsFirstOrderSays) {
    for (const Sampling sampling : {Sampling::independent, Sampling::replicates}) {
        const Bias bias = measure({logNormal, 1, 100, sampling});
        EXPECT_LT(std::abs(bias.estimate + kFirstOrder), bias.halfWidth + 0.5 * kFirstOrder) << "half for second order";
    }
}

TEST(AdaptiveBias, AmongEqualsLogNormalPixelsKeepTheirMean) {
    for (const Sampling sampling : {Sampling::independent, Sampling::replicates}) {
        const Bias bias = measure({logNormal, 10, 1, sampling});
        EXPECT_LT(std::abs(bias.estimate), bias.halfWidth + 0.5 * kFirstOrder) << "less than half of it alone";
    }
}

/// Black pixels wait until 1024 samples, of which all miss with probability 0.99^1024 = 3.4e-5.
TEST(AdaptiveBias, BlackPixelsWaitForRareLight) {
    for (const std::uint32_t edge : {1u, 14u}) {
        const Bias bias = measure({rare, edge, edge == 1 ? 200u : 1u, Sampling::independent, 2048, 2048.0});
        EXPECT_LT(std::abs(bias.estimate), bias.halfWidth + std::pow(0.99, 1024.0));
    }
}

/// The probability that a pixel and its neighbours all miss rare light in the first 64 samples, averaged over a film.
double missedByAll(std::uint32_t edge) {
    double sum = 0.0;
    for (std::uint32_t y = 0; y < edge; ++y)
        for (std::uint32_t x = 0; x < edge; ++x) {
            const auto around = [&](std::uint32_t at) { return std::min(at + 1, edge - 1) + 2 - std::max(at, 1u); };
            sum += std::pow(0.99, 64.0 * around(x) * around(y));
        }
    return sum / (edge * edge);
}

/// Over dim light nothing tells that rare light was missed: 64 samples do with probability 0.526, those of nine
/// neighbours with 0.003. Such pixels stop at a tenth of their mean; the others go on to the last sample, and would
/// make up for 64 / 1024 of it.
TEST(AdaptiveBias, RareLightOverDimIsLostAloneAndFoundAmongEquals) {
    EXPECT_NEAR(missedByAll(1), 0.526, 0.001);
    EXPECT_NEAR(missedByAll(1000), 0.0031, 0.0001);
    for (const std::uint32_t edge : {1u, 14u}) {
        const Bias bias = measure({rareOverDim, edge, edge == 1 ? 400u : 1u, Sampling::independent, 1024, 1024.0});
        EXPECT_NEAR(bias.estimate, -0.9 * (1.0 - 64.0 / 1024.0) * missedByAll(edge), bias.halfWidth);
    }
}

} // namespace
} // namespace isolux
