#include "report/convergence_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace isolux {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Below that, passes that warm caches up and the first pixels' overhead are much of the time.
constexpr double kFirstFittedSamples = 4.0;
constexpr std::size_t kFewestFitted = 4;

/// The exponents that a floor is sought with: 1/2 is slower than any plain Monte Carlo, 3 the rate of scrambled nets
/// for smooth integrands (Owen 1997).
constexpr double kLeastExponent = 0.5;
constexpr double kLargestExponent = 3.0;

struct Line {
    double slope = kUnknown;
    double intercept = kUnknown;
};

/// Least squares; unknown of fewer than two different x.
Line fitLine(std::span<const double> x, std::span<const double> y) {
    if (x.size() < 2) return {};
    const double centerX = mean(x);
    const double centerY = mean(y);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        squares += (x[i] - centerX) * (x[i] - centerX);
        products += (x[i] - centerX) * (y[i] - centerY);
    }
    if (!(squares > 0.0)) return {};
    return {products / squares, centerY - products / squares * centerX};
}

/// Through log MSE over log `over`.
Line fitLogLine(const MeanCurve& curve, std::vector<double> MeanCurve::*over, std::size_t start) {
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t i = start; i < curve.size(); ++i) {
        if (std::isnan(curve.mse[i])) return {};
        if (!(curve.mse[i] > 0.0)) continue;
        x.push_back(std::log((curve.*over)[i]));
        y.push_back(std::log(curve.mse[i]));
    }
    return fitLine(x, y);
}

/// Where `value` is least between low and high, as far as it has one minimum there: golden section (Kiefer 1953).
template <typename Value> double goldenSection(double low, double high, const Value& value) {
    constexpr double kGolden = 0.61803398874989484820;
    constexpr double kResolution = 1e-7; // the root of the rounding of `value`
    std::array inner{high - kGolden * (high - low), low + kGolden * (high - low)};
    std::array values{value(inner[0]), value(inner[1])};
    while (high - low > kResolution) {
        if (values[0] <= values[1]) {
            high = inner[1];
            inner = {high - kGolden * (high - low), inner[0]};
            values = {value(inner[0]), values[0]};
        } else {
            low = inner[0];
            inner = {inner[1], low + kGolden * (high - low)};
            values = {values[1], value(inner[1])};
        }
    }
    return 0.5 * (low + high);
}

/// The points of one fit, relative to the curve they are weighted by.
class FloorPoints {
public:
    void add(double logSamples, double mse, double scale) {
        logSamples_.push_back(logSamples);
        ones_.push_back(1.0 / scale);
        values_.push_back(mse / scale);
        powers_.push_back(0.0);
    }

    struct Solution {
        double floor = 0.0;
        double residual = 0.0;
    };

    /// y = c u + f with u = n^-exponent, everything divided by the scale: normal equations, then the squares they
    /// leave.
    Solution solve(double exponent) {
        double sumOneOne = 0.0, sumOneU = 0.0, sumUU = 0.0, sumOneY = 0.0, sumUY = 0.0;
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const double u = powers_[i] = ones_[i] * std::exp(-exponent * logSamples_[i]);
            sumOneOne += ones_[i] * ones_[i];
            sumOneU += ones_[i] * u;
            sumUU += u * u;
            sumOneY += ones_[i] * values_[i];
            sumUY += u * values_[i];
        }
        const double determinant = sumOneOne * sumUU - sumOneU * sumOneU;
        const double factor = (sumOneOne * sumUY - sumOneU * sumOneY) / determinant;
        Solution solution{(sumUU * sumOneY - sumOneU * sumUY) / determinant, 0.0};
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const double residual = values_[i] - factor * powers_[i] - solution.floor * ones_[i];
            solution.residual += residual * residual;
        }
        return solution;
    }

private:
    std::vector<double> logSamples_;
    std::vector<double> ones_;
    std::vector<double> values_;
    std::vector<double> powers_;
};

/// A scan first: there may be more than one minimum.
double bestExponent(FloorPoints& points) {
    constexpr int kSteps = 10;
    constexpr double kStep = (kLargestExponent - kLeastExponent) / kSteps;
    const auto residual = [&](double exponent) { return points.solve(exponent).residual; };
    int best = 0;
    double least = kInfinity;
    for (int i = 0; i <= kSteps; ++i) {
        const double value = residual(kLeastExponent + i * kStep);
        if (value < least) {
            least = value;
            best = i;
        }
    }
    return goldenSection(kLeastExponent + std::max(best - 1, 0) * kStep,
                         kLeastExponent + std::min(best + 1, kSteps) * kStep, residual);
}

} // namespace

Interval percentileInterval(double estimate, std::vector<double> resampled, std::size_t seeds) {
    constexpr double kMostUnknown = 0.05;
    const std::size_t total = resampled.size();
    std::erase_if(resampled, [](double value) { return std::isnan(value); });
    if (std::isnan(estimate) || resampled.empty() ||
        static_cast<double>(total - resampled.size()) > kMostUnknown * static_cast<double>(total))
        return {kUnknown, estimate, kUnknown};
    std::sort(resampled.begin(), resampled.end());
    const double degrees = static_cast<double>(seeds - 1);
    const double t = studentQuantile(0.5 + 0.5 * kConfidence, degrees);
    const double tail = 0.5 * std::erfc(std::sqrt((degrees + 1.0) / degrees) * t / std::sqrt(2.0));
    const auto last = resampled.size() - 1;
    const auto rank = static_cast<std::size_t>(std::floor(tail * static_cast<double>(last)));
    return {resampled[rank], estimate, resampled[last - rank]};
}

std::vector<double> ofResamples(const ResampledCurves& curves, const CurveFigure& figure) {
    std::vector<double> values(curves.resamples.size());
    std::transform(curves.resamples.begin(), curves.resamples.end(), values.begin(), figure);
    return values;
}

Interval bootstrap(const ResampledCurves& curves, const CurveFigure& figure) {
    return percentileInterval(figure(curves.all), ofResamples(curves, figure), curves.seeds);
}

std::size_t fitStart(const MeanCurve& curve) {
    for (std::size_t i = 0; i + kFewestFitted <= curve.size(); ++i) {
        if (curve.samples[i] >= kFirstFittedSamples) return i;
    }
    return 0;
}

double logSlope(const MeanCurve& curve, std::vector<double> MeanCurve::*over, std::size_t start) {
    return fitLogLine(curve, over, start).slope;
}

// --- Floor ---

FloorFit::FloorFit(const MeanCurve& curve, std::size_t start) : start_(start) {
    const Line line = fitLogLine(curve, &MeanCurve::samples, start);
    for (const double samples : curve.samples)
        scale_.push_back(std::exp(line.intercept + line.slope * std::log(samples)));
}

double FloorFit::operator()(const MeanCurve& curve) const {
    // What an exponent that is off by the resolution of its search, times the logarithm of the range of samples, may
    // leave of an exact power; far below any noise.
    constexpr double kRounding = 1e-5;
    if (curve.size() - start_ < kFewestFitted || std::isnan(scale_.back())) return kUnknown;
    FloorPoints points;
    for (std::size_t i = start_; i < curve.size(); ++i)
        points.add(std::log(curve.samples[i] / curve.samples.back()), curve.mse[i], scale_[i]);
    const double floor = points.solve(bestExponent(points)).floor;
    return std::abs(floor) < kRounding * scale_.back() ? 0.0 : floor;
}

// --- Times ---

double TimeFinder::operator()(const MeanCurve& curve) const {
    const double target = std::log(mse_);
    std::optional<std::size_t> before;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (std::isnan(curve.mse[i])) return kUnknown;
        if (!(curve.mse[i] > 0.0)) continue;
        const double logMse = std::log(curve.mse[i]);
        if (logMse <= target) {
            if (!before) return -kInfinity;
            const double logBefore = std::log(curve.mse[*before]);
            const double start = std::log(curve.seconds[*before]);
            return start + (std::log(curve.seconds[i]) - start) * (logBefore - target) / (logBefore - logMse);
        }
        before = i;
    }
    return before && !std::isnan(target) ? beyond(curve, *before) : kUnknown;
}

double TimeFinder::beyond(const MeanCurve& curve, std::size_t last) const {
    if (beyond_ == BeyondRange::unknown) return kInfinity;
    const double slope = logSlope(curve, &MeanCurve::samples, start_);
    if (!(slope < 0.0)) return kInfinity;
    return std::log(curve.seconds[last]) + (std::log(mse_) - std::log(curve.mse[last])) / slope;
}

} // namespace isolux
