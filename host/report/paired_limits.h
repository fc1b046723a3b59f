// What two renders of the same random numbers may differ by, and what of it they exceed.
#pragma once

#include "report/paired.h"

#include <string>
#include <vector>

namespace isolux {

/// An unexplained pixel is always one too many. Pixels on other branches, and those that single precision errs in
/// anyway, are no mistakes; but if they are many, only the mean can tell whether the branches were taken rightly, and
/// it must be known well enough to do so.
struct PairedLimits {
    double agreement = 0.98; ///< share of lit pixels within the tolerance for which nothing more is asked of the mean
    double relativeBias = 1e-4; ///< of the mean luminance
};

/// A line for each that is exceeded, with figure and limit; none: the two renders agree.
[[nodiscard]] std::vector<std::string> exceededLimits(const PairedDifferences& differences, const PairedLimits& limits);

} // namespace isolux
