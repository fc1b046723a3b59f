// Takes the error of a render at 1, 2, 4, 8, ... samples a pixel and at its end, by a clock that stands still
// meanwhile.
#pragma once

#include "app/converge_run.h"
#include "core/stopwatch.h"

namespace isolux {

/// A stopwatch that can be held.
class RenderClock {
public:
    [[nodiscard]] double seconds() const { return (held_ ? *held_ : watch_.seconds()) - lost_; }
    void hold() { held_ = watch_.seconds(); }
    void go() {
        lost_ += watch_.seconds() - *held_;
        held_.reset();
    }

private:
    Stopwatch watch_;
    double lost_ = 0.0;
    std::optional<double> held_;
};

/// One seed of a variant on its way. The variant changes only when the seed is whole.
class SeedRecorder {
public:
    SeedRecorder(MeasuredVariant& measured, const ConvergeLimits& limits, const ErrorMeter& meter, std::uint64_t seed);

    /// After each pass: takes checkpoints, and says when the seed is done.
    [[nodiscard]] Continue pass(const Film& film);
    /// At the end of a whole seed: it becomes the variant's.
    void finish(const Film& film);
    [[nodiscard]] bool ended() const { return ended_; }
    /// Of the samples or of the checkpoints that a whole seed has.
    [[nodiscard]] double fraction() const;

private:
    [[nodiscard]] bool timeIsUp() const;
    [[nodiscard]] ErrorSample measure(const Film& film) const;
    void takePower(const Film& film);

    MeasuredVariant& measured_;
    const ConvergeLimits& limits_;
    const ErrorMeter& meter_;
    std::uint64_t seed_;
    std::optional<double> deviceBefore_;
    std::vector<CheckpointGatherer> powers_;
    CheckpointGatherer end_;
    SeedSamples samples_;
    double nextPower_ = 1.0; ///< samples a pixel
    double taken_ = 0.0;     ///< the same
    bool ended_ = false;
    RenderClock clock_;
};

} // namespace isolux
