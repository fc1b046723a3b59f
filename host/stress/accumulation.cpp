// Many samples a pixel: what the device and the host do with them, simulated on one pixel of samples that are known,
// and real images of a lamp and of a furnace.
#include "film/film.h"
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace isolux {
namespace {

constexpr const char* kPlainSum = "plain sum in single precision";

class Random {
public:
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

private:
    std::mt19937_64 engine_{1};
};

using Integrand = Vec3f (*)(Random&);

/// No power of two and no sum of few of them.
Vec3f constantSample(Random&) { return Vec3f(0.7f); }

Vec3f exponentialSample(Random& random) { return Vec3f(static_cast<float>(-std::log1p(-random.unit()))); }

/// Colours of luminance 1, but for rounding.
Vec3f tintedSample(Random& random) {
    const double red = random.unit(), blue = random.unit();
    return Vec3f(Vec3d(red, (1.0 - luminance(Vec3d(red, 0.0, blue))) / luminance(Vec3d(0.0, 1.0, 0.0)), blue));
}

/// A batch of samples as shaders/film/accumulate.glsl sums it.
class DeviceBatch {
public:
    void add(const Vec3f& radiance) {
        ++count_;
        const Vec3f before = radiance - mean_;
        mean_ += before / static_cast<float>(count_);
        const Vec3f after = radiance - mean_;
        squaredDeviation_ += before * after;
        luminanceSquaredDeviation_ += luminance(before) * luminance(after);
    }
    [[nodiscard]] PixelStatistics statistics() const {
        PixelStatistics pixel;
        pixel.mean = Vec3d(mean_);
        pixel.squaredDeviation = Vec3d(squaredDeviation_);
        pixel.luminanceSquaredDeviation = static_cast<double>(luminanceSquaredDeviation_);
        pixel.sampleCount = count_;
        return pixel;
    }

private:
    Vec3f mean_{0.0f};
    Vec3f squaredDeviation_{0.0f};
    float luminanceSquaredDeviation_ = 0.0f;
    std::uint32_t count_ = 0;
};

/// Kahan's sum: exact to double's last place however many terms there are.
class ExactSum {
public:
    void add(const Vec3d& term) {
        const Vec3d corrected = term - rest_;
        const Vec3d sum = sum_ + corrected;
        rest_ = (sum - sum_) - corrected;
        sum_ = sum;
    }
    [[nodiscard]] const Vec3d& value() const { return sum_; }

private:
    Vec3d sum_{0.0};
    Vec3d rest_{0.0};
};

/// One pixel and all that there is to know about its samples.
struct SimulatedPixel {
    PixelStatistics pixel; ///< as the device and the host have it
    ExactSum sum;
    ExactSum squares;    ///< of the distances from the first sample
    ExactSum luminances; ///< their distances from the first sample's, and the squares of these
    Vec3d first{0.0};
    Vec3f plain{0.0f};
    std::uint64_t negativeVariances = 0; ///< after how many batches some variance was below zero

    void add(const DeviceBatch& batch) {
        pixel.merge(batch.statistics());
        const Vec3d variance = pixel.variance();
        const double least = std::min({variance.x, variance.y, variance.z, pixel.luminanceVariance()});
        if (!(least >= 0.0)) ++negativeVariances; // NaN is none either
    }
    void note(const Vec3f& sample) {
        const Vec3d exact(sample);
        if (plain == Vec3f(0.0f)) first = exact;
        plain += sample;
        sum.add(exact);
        squares.add((exact - first) * (exact - first));
        const double brighter = luminance(exact) - luminance(first);
        luminances.add({brighter, brighter * brighter, 0.0});
    }
    [[nodiscard]] Vec3d exactMean() const { return sum.value() / static_cast<double>(pixel.sampleCount); }
    [[nodiscard]] Vec3d exactVariance() const {
        const auto count = static_cast<double>(pixel.sampleCount);
        const Vec3d shift = exactMean() - first;
        return (squares.value() - count * shift * shift) / (count - 1.0);
    }
    [[nodiscard]] double exactLuminanceVariance() const {
        const auto count = static_cast<double>(pixel.sampleCount);
        const Vec3d& sums = luminances.value();
        return (sums.y - sums.x * sums.x / count) / (count - 1.0);
    }
};

SimulatedPixel simulate(Integrand integrand, std::uint64_t samples, const StressBench& bench) {
    constexpr std::uint64_t kBatch = 16, kLook = 1 << 16; // samples the device sums at once; until someone is asked
    SimulatedPixel pixel;
    Random random;
    for (std::uint64_t done = 0; done < samples; done += kBatch) {
        if (done % kLook == 0 && bench.interrupted && bench.interrupted()) break;
        DeviceBatch batch;
        for (std::uint64_t i = 0; i < std::min(kBatch, samples - done); ++i) {
            const Vec3f sample = integrand(random);
            batch.add(sample);
            pixel.note(sample);
        }
        pixel.add(batch);
    }
    return pixel;
}

StressFigures errorOfMean(const char* renderer, const Vec3d& mean, const SimulatedPixel& simulated) {
    StressFigures figures;
    figures.renderer = renderer;
    const double error = luminance(mean) / luminance(simulated.exactMean()) - 1.0;
    figures.error = {error, error, error}; // of these very samples: nothing is left to chance
    figures.faults.tried = simulated.pixel.sampleCount;
    if (!isFinite(mean)) figures.faults.nonFinite = 1;
    return figures;
}

/// Whether the variances are those of the samples, to the tolerance that figures have. Rounding may add the square of
/// 16 last places of single precision.
void judgeVariance(const SimulatedPixel& simulated, StressFigures& figures) {
    const auto judge = [&](double variance, double exact) {
        if (!(std::abs(variance - exact) <= kStressTolerance * exact + 1e-12))
            figures.failure = fmt::format("a variance of {:g} is taken for {:g}", exact, variance);
    };
    const Vec3d variance = simulated.pixel.variance(), exact = simulated.exactVariance();
    for (int channel = 0; channel < 3; ++channel) judge(variance[channel], exact[channel]);
    judge(simulated.pixel.luminanceVariance(), simulated.exactLuminanceVariance());
}

Trial simulated(Integrand integrand, double samples) {
    return trialBy([=](const StressBench& bench) {
        const SimulatedPixel simulated = simulate(integrand, static_cast<std::uint64_t>(samples), bench);
        StressFigures device = errorOfMean(kStressDevice, simulated.pixel.mean, simulated);
        device.faults.negative = simulated.negativeVariances;
        judgeVariance(simulated, device);
        const Vec3d plainMean = Vec3d(simulated.plain) / static_cast<double>(simulated.pixel.sampleCount);
        return std::vector<StressFigures>{device, errorOfMean(kPlainSum, plainMean, simulated)};
    });
}

/// The steps of `stepsBy`, to be tried otherwise.
std::vector<PlannedStep> simulatedSteps(Integrand integrand, const Decades& decades) {
    std::vector<PlannedStep> steps = stepsBy(decades, [](double) { return RenderTrial{}; });
    for (PlannedStep& step : steps) step.trial = simulated(integrand, step.parameter);
    return steps;
}

/// Beyond, the references would take minutes; the answer is known, and the noise is small.
Renderers renderersFor(double samples) { return samples > 3e5 ? Renderers::deviceAlone : Renderers::all; }

RenderSettings imageOf(std::uint32_t width, std::uint32_t height, double samples) {
    RenderSettings settings = scatteringAlone(0);
    settings.width = width;
    settings.height = height;
    settings.sampleCount = static_cast<std::uint32_t>(samples);
    return settings;
}

/// Bright stripes on a darker ground, both of which emit: each covers half of every pixel. Eight pixels are what a
/// processor's vectors hold, and no path is shorter.
RenderTrial stripedLamp(double samples) {
    SceneBuilder builder;
    const std::uint32_t dark = builder.material(Vec3d(0.0), Vec3d(0.5), Faces::front);
    const std::uint32_t bright = builder.material(Vec3d(0.0), Vec3d(1.5), Faces::front);
    builder.mesh(squareMesh(dark), translation({0.0, 0.0, -0.1}) * scaling({3.0, 2.0, 1.0}));
    for (const double middle : {-1.75, -0.75, 0.25, 1.25})
        builder.mesh(squareMesh(bright), translation({middle, 0.0, 0.0}) * scaling({0.25, 1.1, 1.0}));
    parallelCamera(builder, {0.0, 0.0, 3.0}, Vec3d(0.0), 1.0);
    RenderTrial trial = expecting(1.0, builder.scene, imageOf(4, 2, samples));
    trial.renderers = renderersFor(samples);
    return trial;
}

/// A furnace in which every path ends at every bounce by a toss of a coin: samples are distributed geometrically.
RenderTrial furnace(double samples) {
    SceneBuilder builder;
    builder.scene.spheres = {{"", Vec3d(0.0), 1.0, builder.material(Vec3d(0.5), Vec3d(1.0), Faces::both)}};
    builder.camera(Vec3d(0.0), {0.0, 0.0, -1.0}, 1.0);
    RenderSettings settings = imageOf(4, 4, samples);
    settings.maxDepth = kUnlimitedDepth;
    settings.roulette = {.kind = Roulette::throughput, .start = 1};
    RenderTrial trial = expecting(2.0, builder.scene, settings);
    trial.renderers = renderersFor(samples);
    return trial;
}

/// What accumulation does to samples, whatever they are.
constexpr const char* kLimit =
    "None up to 2^53 samples. The device sums 16 samples in single precision by Welford's recurrence, off by at most "
    "some 16 u = 1e-6, u = 2^-24, one way as often as the other; the host joins these batches in double. A plain sum "
    "stagnates once a sample is less than u of it, after 1.7e7 alike, and loses their last places much earlier.";

StressSweep about(const char* name, const char* title) {
    return {.name = name, .title = title, .axisTitle = "samples", .limit = kLimit};
}

} // namespace

std::vector<PlannedSweep> accumulationSweeps(Extent extent) {
    const bool full = extent == Extent::full;
    const Decades simulated = full ? Decades{3, 8, 1} : Decades{3, 7, 2};
    return {
        {about("constant", "The same value again and again, simulated on one pixel"),
         simulatedSteps(constantSample, simulated)},
        {about("exponential", "Values distributed exponentially, simulated on one pixel"),
         simulatedSteps(exponentialSample, simulated)},
        {about("tinted", "Colours of one luminance, whose variance is rounding, simulated on one pixel"),
         simulatedSteps(tintedSample, simulated)},
        {about("lamp", "An image of 4 x 2 pixels of a lamp in two shades"), stepsBy({2, full ? 7 : 4, 1}, stripedLamp)},
        {about("furnace", "An image of 4 x 4 pixels in a furnace, paths ending by chance at every bounce"),
         stepsBy({2, full ? 6 : 4, 1}, furnace)}};
}

} // namespace isolux
