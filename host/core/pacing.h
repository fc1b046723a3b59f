// How many samples a pixel to take before looking up from the work: what makes a time limit and Ctrl-C prompt.
#pragma once

#include "core/stopwatch.h"

#include <cstdint>
#include <optional>

namespace isolux {

/// The sizes of the passes over an image. Without a time limit they are all `largest`. With one they begin at 1 and
/// grow, and shrink again so that the last one ends about when time is up: then the number of samples depends on the
/// machine, and with it the order of summation.
class Pacing {
public:
    /// The clock starts here. `seconds`: nothing for no limit.
    Pacing(std::optional<double> seconds, std::uint32_t largest) : limit_(seconds), largest_(largest) {}

    /// The next pass's samples after `done` of `total` samples; 0 when all are taken or time is up. The first pass is
    /// never refused.
    [[nodiscard]] std::uint32_t nextPass(std::uint32_t done, std::uint32_t total) const;

    /// In [0, 1], of the samples or of the time, whichever ends first. `done` may be between two passes.
    [[nodiscard]] double fraction(double done, std::uint32_t total) const;

private:
    std::optional<double> limit_;
    std::uint32_t largest_;
    Stopwatch watch_;
};

} // namespace isolux
