#include "report/statistics.h"

#include <algorithm>

namespace isolux {
namespace {

constexpr std::size_t kTrimmedShare = 1000; ///< one value in so many is left out of the trimmed mean
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// From here on Student's t is the normal distribution with four terms of correction, to 12 digits and more.
constexpr double kManyDegrees = 1e4;

/// x >= 0 with P(X > x) = tail <= 1/2: Abramowitz and Stegun 1964, 26.2.23 (within 4.5e-4), then Halley's steps on
/// log P(X > x), which is nearly a parabola far out in the tail.
double normalUpperQuantile(double tail) {
    constexpr double kInverseSqrtTwoPi = 0.39894228040143267794;
    const double t = std::sqrt(-2.0 * std::log(tail));
    double x = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    for (int step = 0; step < 3; ++step) {
        const double probability = 0.5 * std::erfc(x / std::sqrt(2.0));
        const double hazard = kInverseSqrtTwoPi * std::exp(-0.5 * x * x) / probability;
        const double excess = std::log(probability / tail);
        x += excess / (hazard + 0.5 * excess * (hazard - x));
    }
    return std::max(x, 0.0);
}

/// Coefficient n >= 1 of the continued fraction of the incomplete beta function (DLMF 8.17.23).
double betaCoefficient(int n, double x, double a, double b) {
    const double m = n / 2; // NOLINT(bugprone-integer-division): the coefficients come in pairs
    if (n % 2 == 0) return m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    return -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
}

/// I_x(a, b) for x below (a + 1)/(a + b + 2), where the continued fraction (DLMF 8.17.22) converges fast; evaluated
/// forwards by Lentz's method (Lentz 1976).
double incompleteBetaBelow(double x, double a, double b, double complement) {
    constexpr int kMaxTerms = 100000;
    double value = 1.0;
    double numerator = 1.0;
    double denominator = 0.0;
    for (int n = 1; n < kMaxTerms; ++n) {
        const double coefficient = betaCoefficient(n, x, a, b);
        denominator = 1.0 / (1.0 + coefficient * denominator);
        numerator = 1.0 + coefficient / numerator;
        value *= numerator * denominator;
        if (std::abs(numerator * denominator - 1.0) < 1e-16) break;
    }
    const double logBeta = std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
    return std::exp(a * std::log(x) + b * std::log(complement) - logBeta) / (a * value);
}

/// Regularised incomplete beta function; `complement` is 1 - x, given apart because it may be tiny.
double incompleteBeta(double x, double a, double b, double complement) {
    if (x <= 0.0) return 0.0;
    if (complement <= 0.0) return 1.0;
    if (x < (a + 1.0) / (a + b + 2.0)) return incompleteBetaBelow(x, a, b, complement);
    return 1.0 - incompleteBetaBelow(complement, b, a, x);
}

/// Abramowitz and Stegun 1964, 26.7.5.
double studentFromNormal(double z, double degrees) {
    const double z2 = z * z;
    const double g1 = z * (z2 + 1.0) / 4.0;
    const double g2 = z * (z2 * (5.0 * z2 + 16.0) + 3.0) / 96.0;
    const double g3 = z * (z2 * (z2 * (3.0 * z2 + 19.0) + 17.0) - 15.0) / 384.0;
    const double inverse = 1.0 / degrees;
    return z + inverse * (g1 + inverse * (g2 + inverse * g3));
}

/// t >= 0 with P(T > t) = tail, by bisection: the tail falls monotonically, and there is nothing to go wrong.
double studentUpperQuantile(double tail, double degrees) {
    double low = 0.0;
    double high = 1.0;
    while (studentUpperTail(high, degrees) > tail && high < 1e150) {
        low = high;
        high *= 2.0;
    }
    for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
        (studentUpperTail(middle, degrees) > tail ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

Interval around(double estimate, double halfWidth) { return {estimate - halfWidth, estimate, estimate + halfWidth}; }

} // namespace

double mean(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double trimmedMean(std::vector<double> values) {
    const std::size_t kept = values.size() - values.size() / kTrimmedShare;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(kept) - 1, values.end());
    return mean(std::span(values).first(kept));
}

double variance(std::span<const double> values) {
    if (values.size() < 2) return kNan;
    const double center = mean(values);
    double squares = 0.0;
    for (const double value : values) squares += (value - center) * (value - center);
    return squares / static_cast<double>(values.size() - 1);
}

double normalQuantile(double p) {
    if (!(p >= 0.0 && p <= 1.0)) return kNan;
    if (p == 0.0 || p == 1.0) return p == 0.0 ? -kInfinity : kInfinity;
    return p < 0.5 ? -normalUpperQuantile(p) : normalUpperQuantile(1.0 - p);
}

double studentUpperTail(double t, double degrees) {
    const double square = t * t;
    return 0.5 * incompleteBeta(degrees / (degrees + square), 0.5 * degrees, 0.5, square / (degrees + square));
}

double studentQuantile(double p, double degrees) {
    if (!(p >= 0.0 && p <= 1.0 && degrees > 0.0)) return kNan;
    if (p == 0.0 || p == 1.0) return p == 0.0 ? -kInfinity : kInfinity;
    if (degrees >= kManyDegrees) return studentFromNormal(normalQuantile(p), degrees);
    return p < 0.5 ? -studentUpperQuantile(p, degrees) : studentUpperQuantile(1.0 - p, degrees);
}

Interval normalInterval(double estimate, double standardError, double confidence) {
    return around(estimate, standardError * normalQuantile(0.5 + 0.5 * confidence));
}

Interval studentInterval(double estimate, double standardError, double degrees, double confidence) {
    return around(estimate, standardError * studentQuantile(0.5 + 0.5 * confidence, degrees));
}

Interval meanInterval(std::span<const double> values, double confidence) {
    const double count = static_cast<double>(values.size());
    return studentInterval(mean(values), std::sqrt(variance(values) / count), count - 1.0, confidence);
}

} // namespace isolux
