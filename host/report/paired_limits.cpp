#include "report/paired_limits.h"

#include "report/comparison.h"
#include "report/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

std::string percentText(double share) { return formatNumber(100.0 * share) + " %"; }

double agreementOf(const PairedDifferences& differences) {
    if (differences.litPixels == 0) return 1.0;
    return static_cast<double>(differences.withinTolerance) / static_cast<double>(differences.litPixels);
}

/// Whether the whole interval lies between -limit and +limit.
bool isKnownWithin(const Interval& value, double limit) {
    return value.known() && std::max(std::abs(value.low), std::abs(value.high)) <= limit;
}

} // namespace

std::vector<std::string> exceededLimits(const PairedDifferences& differences, const PairedLimits& limits) {
    std::vector<std::string> exceeded;
    if (differences.unexplained > 0)
        exceeded.push_back(fmt::format("{} pixels are unexplained, none may be", differences.unexplained));
    const std::string bias = formatPercentInterval(differences.luminanceBias);
    const std::string limit = percentText(limits.relativeBias);
    if (checkLimit(differences.luminanceBias, limits.relativeBias) == Verdict::exceeded) {
        exceeded.push_back(fmt::format("the relative bias, {}, lies beyond {}", bias, limit));
    } else if (const double agreement = agreementOf(differences);
               agreement < limits.agreement && !isKnownWithin(differences.luminanceBias, limits.relativeBias)) {
        exceeded.push_back(
            fmt::format("{} of the lit pixels are within tolerance, less than {}, and the relative bias, "
                        "{}, is not known to be within {}: more samples may show it",
                        percentText(agreement), percentText(limits.agreement), bias, limit));
    }
    return exceeded;
}

} // namespace isolux
