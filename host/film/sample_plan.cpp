#include "film/sample_plan.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

constexpr double kNormalQuantile = 1.96; // two-sided, 95 %
constexpr std::uint32_t kLeastForError = 16;
/// An error that is unknown after so many samples, since the image is black or holds NaN, may stay so for ever.
constexpr std::uint32_t kPatienceForError = 1024;

/// The rule for a pixel alone. NaN satisfies nothing.
bool satisfied(const PixelStatistics& pixel, const AdaptiveRule& rule) {
    if (pixel.sampleCount < 2) return false;
    const double mean = luminance(pixel.mean);
    const double variance = pixel.luminanceVariance();
    const double squaredError = (variance < 0.0 ? 0.0 : variance) / static_cast<double>(pixel.sampleCount);
    if (mean == 0.0 && pixel.hitCount > 0 &&
        pixel.sampleCount < std::uint64_t{AdaptiveRule::kBlackPatience} * rule.minSamples)
        return false;
    return kNormalQuantile * std::sqrt(squaredError) <= rule.tolerance * mean;
}

/// Whether all of the 3 x 3 entries around (x, y) that exist are true.
bool allAround(const std::vector<bool>& flags, const Film& film, std::uint32_t x, std::uint32_t y) {
    for (std::uint32_t row = y - std::min(y, 1u); row <= std::min(y + 1, film.height - 1); ++row)
        for (std::uint32_t column = x - std::min(x, 1u); column <= std::min(x + 1, film.width - 1); ++column)
            if (!flags[std::size_t{row} * film.width + column]) return false;
    return true;
}

} // namespace

std::vector<bool> satisfiedPixels(const Film& film, const AdaptiveRule& rule) {
    std::vector<bool> alone(film.pixels.size());
    for (std::size_t i = 0; i < alone.size(); ++i) alone[i] = satisfied(film.pixels[i], rule);
    std::vector<bool> together(alone.size());
    for (std::uint32_t y = 0; y < film.height; ++y)
        for (std::uint32_t x = 0; x < film.width; ++x)
            together[std::size_t{y} * film.width + x] = allAround(alone, film, x, y);
    return together;
}

SamplePlan::SamplePlan(const StoppingRule& rule, const SampleRange& samples, FirstPasses firstPasses,
                       std::vector<std::uint32_t> pixels)
    : rule_(rule), samples_(samples), firstPasses_(firstPasses), pacing_(rule.seconds, kLargestPass),
      pixels_(std::move(pixels)) {
    assert(!rule.adaptive || rule.adaptive->batch > 0);
}

std::optional<Pass> SamplePlan::next(const Film& film) {
    done_ += passSamples_;
    taken_ += std::uint64_t{passSamples_} * pixels_.size();
    passSamples_ = 0;
    judgeError(film);
    dropFinishedPixels(film);
    if (pixels_.empty() || errorFraction_ >= 1.0) return std::nullopt;
    passSamples_ = nextPassSamples();
    if (passSamples_ == 0) return std::nullopt;
    return Pass{samples_.first + done_, passSamples_, pixels_};
}

double SamplePlan::fraction(double part) const {
    const auto active = static_cast<double>(pixels_.size());
    const double taken = static_cast<double>(taken_) + active * passSamples_ * part;
    const double left = active * (samples_.count - done_ - passSamples_ * part);
    const double ofSamples = left > 0.0 ? taken / (taken + left) : 1.0;
    return std::max(errorFraction_, pacing_.fraction(ofSamples, 1));
}

void SamplePlan::judgeError(const Film& film) {
    if (!rule_.relativeError || done_ < kLeastForError) return;
    const double ratio = *rule_.relativeError / estimatedRelativeRmse(film);
    if (ratio > 0.0) errorFraction_ = std::clamp(ratio * ratio, errorFraction_, 1.0);
    if (std::isnan(ratio) && done_ >= kPatienceForError) errorFraction_ = 1.0;
}

void SamplePlan::dropFinishedPixels(const Film& film) {
    if (!rule_.adaptive || done_ == 0 || done_ < rule_.adaptive->minSamples ||
        samplesUntilTest() != rule_.adaptive->batch)
        return;
    const std::vector<bool> finished = satisfiedPixels(film, *rule_.adaptive);
    std::erase_if(pixels_, [&](std::uint32_t pixel) {
        return finished[std::size_t{pixelY(pixel)} * film.width + pixelX(pixel)];
    });
}

/// At a test point: until the next.
std::uint32_t SamplePlan::samplesUntilTest() const {
    const AdaptiveRule& rule = *rule_.adaptive;
    return done_ < rule.minSamples ? rule.minSamples - done_ : rule.batch - (done_ - rule.minSamples) % rule.batch;
}

std::uint32_t SamplePlan::nextPassSamples() const {
    std::uint32_t samples = pacing_.nextPass(done_, samples_.count);
    if (firstPasses_ == FirstPasses::growing) samples = std::min(samples, std::max(done_, 1u));
    return rule_.adaptive ? std::min(samples, samplesUntilTest()) : samples;
}

} // namespace isolux
