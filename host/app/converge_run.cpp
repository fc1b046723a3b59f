#include "app/converge_run.h"

#include "app/converge_checkpoints.h"
#include "core/error.h"
#include "core/log.h"
#include "core/platform.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <utility>

namespace isolux {
namespace {

constexpr std::uint32_t kWarmUpSamples = 8;
/// Seeds of warm-ups: of no variant, and below those of references.
constexpr std::uint64_t kWarmUpSeed = std::uint64_t{1} << 62;

struct Job {
    std::size_t variant = 0;
    std::uint64_t seed = 0;
};

/// Every seed of every variant in an order that is random, so that nothing that drifts favours one, and always the
/// same (Fisher and Yates; std::shuffle differs between libraries).
std::vector<Job> shuffledJobs(std::size_t variants, const ConvergeLimits& limits) {
    std::vector<Job> jobs;
    for (std::size_t variant = 0; variant < variants; ++variant)
        for (std::uint32_t i = 0; i < limits.seeds; ++i) jobs.push_back({variant, limits.firstSeed + i});
    std::mt19937_64 random(1);
    for (std::size_t left = jobs.size(); left > 1; --left) std::swap(jobs[left - 1], jobs[random() % left]);
    return jobs;
}

/// Renders a little; how many seconds it took.
double warmUp(SeedRenderer& renderer) {
    const Stopwatch watch;
    const auto progress = [](double) { return interruptRequested() ? Continue::no : Continue::yes; };
    static_cast<void>(renderer.render({kWarmUpSeed, kWarmUpSamples, {}}, {}, progress));
    return watch.seconds();
}

/// Whether the seed is whole.
bool measureSeed(MeasuredVariant& measured, const Job& job, const ConvergeLimits& limits, const ErrorMeter& meter,
                 const ProgressCallback& progress) {
    SeedRecorder recorder(measured, limits, meter, job.seed);
    const SeedRequest request{job.seed, measured.variant.settings.sampleCount, measured.variant.stopping};
    const auto pass = [&](const Film& done) { return recorder.pass(done); };
    // How much of the samples that a render may take are done says little where something else ends it.
    const auto whole = [&](double) { return progress(recorder.fraction()); };
    const Film film = measured.renderer->render(request, pass, whole);
    if (interruptRequested() && !recorder.ended()) return false;
    recorder.finish(film);
    return true;
}

} // namespace

std::size_t MeasuredVariant::commonPowers() const {
    std::size_t common = seeds.empty() ? 0 : seeds.front().powers.size();
    for (const SeedSamples& seed : seeds) common = std::min(common, seed.powers.size());
    return common;
}

std::vector<ErrorSample> MeasuredVariant::samples() const {
    std::vector<ErrorSample> all;
    const std::size_t common = commonPowers();
    for (const SeedSamples& seed : seeds)
        for (std::size_t i = 0; i <= common; ++i) {
            all.push_back(i < common ? seed.powers[i] : seed.end);
            all.back().checkpoint = static_cast<std::uint32_t>(i);
        }
    std::stable_sort(all.begin(), all.end(),
                     [](const ErrorSample& a, const ErrorSample& b) { return a.seed < b.seed; });
    return all;
}

void MeasuredVariant::complete(VariantSummary& summary) const {
    summary.options = variant.options;
    const std::size_t common = commonPowers();
    for (std::size_t i = 0; i < summary.checkpoints.size(); ++i) {
        const CheckpointGatherer& gatherer = i < common ? powers[i] : *end;
        summary.checkpoints[i].biasSquared = gatherer.biasSquared();
        summary.checkpoints[i].calibration = gatherer.calibration();
    }
}

std::vector<MeasuredVariant> prepareVariants(const std::vector<Variant>& variants, const SceneRun& run,
                                             const Device* device, double dispatchSeconds) {
    std::vector<MeasuredVariant> measured;
    for (const Variant& variant : variants) {
        MeasuredVariant next{variant, makeSeedRenderer(device, run.scene, variant.settings, dispatchSeconds)};
        next.setupSeconds = run.loadSeconds + next.renderer->setupSeconds();
        warmUp(*next.renderer); // drivers, caches and the length of dispatches
        next.secondsPerSample = warmUp(*next.renderer) / kWarmUpSamples;
        measured.push_back(std::move(next));
    }
    return measured;
}

void measureVariants(std::vector<MeasuredVariant>& variants, const ConvergeLimits& limits, const ErrorMeter& meter,
                     ProgressBar& bar) {
    const std::vector<Job> jobs = shuffledJobs(variants.size(), limits);
    const ProgressCallback whole = bar.callback();
    for (std::size_t done = 0; done < jobs.size(); ++done) {
        const auto progress = [&](double part) {
            return whole((static_cast<double>(done) + part) / static_cast<double>(jobs.size()));
        };
        if (!measureSeed(variants[jobs[done].variant], jobs[done], limits, meter, progress)) return;
        if (progress(1.0) == Continue::no) return;
    }
}

} // namespace isolux
