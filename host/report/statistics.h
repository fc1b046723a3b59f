// Means, variances, quantiles and confidence intervals: the statistics every figure with an interval is made from.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace isolux {

/// The confidence of every interval that a command prints.
inline constexpr double kConfidence = 0.95;

/// An estimate between the ends of its confidence interval. The ends are NaN where nothing is known about the error.
struct Interval {
    double low = std::numeric_limits<double>::quiet_NaN();
    double estimate = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();

    [[nodiscard]] bool known() const { return !std::isnan(low) && !std::isnan(high); }
    [[nodiscard]] bool contains(double value) const { return low <= value && value <= high; }
};

/// The arithmetic mean; NaN of nothing.
[[nodiscard]] double mean(std::span<const double> values);

/// The mean without the largest thousandth of the values, which is not empty.
[[nodiscard]] double trimmedMean(std::vector<double> values);

/// The unbiased variance about the mean, in two passes; NaN of fewer than two values.
[[nodiscard]] double variance(std::span<const double> values);

/// The value below which a standard normal variable lies with probability p; infinite at 0 and 1, NaN outside.
[[nodiscard]] double normalQuantile(double p);

/// The same for Student's t with `degrees` > 0 degrees of freedom, which need not be whole.
[[nodiscard]] double studentQuantile(double p, double degrees);

/// P(T > t) of Student's t, t >= 0.
[[nodiscard]] double studentUpperTail(double t, double degrees);

/// estimate -+ quantile * standardError, by the normal distribution. A NaN standard error leaves the ends NaN.
[[nodiscard]] Interval normalInterval(double estimate, double standardError, double confidence = kConfidence);

/// The same by Student's t; without degrees of freedom the ends are NaN.
[[nodiscard]] Interval studentInterval(double estimate, double standardError, double degrees,
                                       double confidence = kConfidence);

/// The mean of independent values with its t interval; fewer than two values have no interval.
[[nodiscard]] Interval meanInterval(std::span<const double> values, double confidence = kConfidence);

} // namespace isolux
