#include "app/converge_checkpoints.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isolux {

double samplesPerPixel(const Film& film) {
    std::uint64_t samples = 0;
    for (const PixelStatistics& pixel : film.pixels) samples += pixel.sampleCount;
    return static_cast<double>(samples) / static_cast<double>(film.pixels.size());
}

SeedRecorder::SeedRecorder(MeasuredVariant& measured, const ConvergeLimits& limits, const ErrorMeter& meter,
                           std::uint64_t seed)
    : measured_(measured), limits_(limits), meter_(meter), seed_(seed),
      deviceBefore_(measured.renderer->deviceSeconds()), powers_(measured.powers),
      end_(measured.end ? *measured.end : CheckpointGatherer(meter)) {}

Continue SeedRecorder::pass(const Film& film) {
    clock_.hold();
    taken_ = samplesPerPixel(film);
    if (taken_ >= nextPower_) takePower(film);
    ended_ = taken_ >= limits_.maxSamples || (!samples_.powers.empty() && timeIsUp());
    clock_.go();
    return ended_ ? Continue::no : Continue::yes;
}

double SeedRecorder::fraction() const {
    const double ofSamples = std::min(taken_ / limits_.maxSamples, 1.0);
    if (!limits_.maxSeconds || !measured_.checkpoints) return ofSamples;
    // Each checkpoint takes as long as all before it.
    return std::clamp(taken_ / std::exp2(static_cast<double>(*measured_.checkpoints) - 1.0), ofSamples, 1.0);
}

/// The first seed of a variant stops where the next checkpoint would come too late, the others where it did.
bool SeedRecorder::timeIsUp() const {
    if (!limits_.maxSeconds) return false;
    if (measured_.checkpoints) return samples_.powers.size() >= *measured_.checkpoints;
    return 2.0 * samples_.powers.back().wallSeconds > *limits_.maxSeconds;
}

ErrorSample SeedRecorder::measure(const Film& film) const {
    const bool flip = seed_ - limits_.firstSeed < limits_.flipSeeds;
    ErrorSample sample = meter_.measure(film, flip ? MeasureFlip::yes : MeasureFlip::no);
    sample.variant = measured_.variant.name;
    sample.seed = seed_;
    sample.samplesPerPixel = samplesPerPixel(film);
    sample.rays = film.rays;
    sample.wallSeconds = clock_.seconds();
    if (deviceBefore_) sample.deviceSeconds = *measured_.renderer->deviceSeconds() - *deviceBefore_;
    sample.setupSeconds = measured_.setupSeconds;
    return sample;
}

void SeedRecorder::takePower(const Film& film) {
    const std::size_t place = samples_.powers.size();
    if (place == powers_.size()) powers_.emplace_back(meter_);
    samples_.powers.push_back(measure(film));
    powers_[place].add(film, samples_.powers.back());
    while (nextPower_ <= samples_.powers.back().samplesPerPixel) nextPower_ *= 2.0;
}

void SeedRecorder::finish(const Film& film) {
    clock_.hold();
    std::vector<ErrorSample>& powers = samples_.powers;
    if (!measured_.checkpoints) measured_.checkpoints = powers.size();
    if (!powers.empty() && powers.back().samplesPerPixel == samplesPerPixel(film)) {
        samples_.end = powers.back();
        powers.pop_back();
    } else {
        samples_.end = measure(film);
    }
    end_.add(film, samples_.end);
    measured_.seeds.push_back(std::move(samples_));
    measured_.powers = std::move(powers_);
    measured_.end = std::move(end_);
    measured_.diagnostics.merge(film.diagnostics);
}

} // namespace isolux
