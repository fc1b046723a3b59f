#include "app/converge_checkpoints.h"

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
    const double samples = samplesPerPixel(film);
    if (samples >= nextPower_) takePower(film);
    ended_ = samples >= limits_.maxSamples || (!samples_.powers.empty() && timeIsUp());
    clock_.go();
    return ended_ ? Continue::no : Continue::yes;
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
