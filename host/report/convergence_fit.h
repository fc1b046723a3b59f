// Lines and floors fitted to curves of error, when they reach an error, and intervals of all that by the bootstrap.
#pragma once

#include "report/convergence_curves.h"

#include <functional>

namespace isolux {

/// A figure of a curve; NaN where the curve does not tell.
using CurveFigure = std::function<double(const MeanCurve&)>;

/// The interval of a figure whose estimate and whose values over the resamples are given, by expanded percentiles
/// (Hesterberg 2015, section 4.5): those of the normal distribution at sqrt(K/(K - 1)) t, with K seeds and t of K - 1
/// degrees of freedom, which makes up for the bootstrap's variance being (K - 1)/K of the seeds' and for few seeds.
/// Infinite values stay in; no interval where more than 5 % of the values are NaN.
[[nodiscard]] Interval percentileInterval(double estimate, std::vector<double> resampled, std::size_t seeds);

/// The figure of every resample.
[[nodiscard]] std::vector<double> ofResamples(const ResampledCurves& curves, const CurveFigure& figure);
/// The figure of the curve of all seeds with its interval over the resamples.
[[nodiscard]] Interval bootstrap(const ResampledCurves& curves, const CurveFigure& figure);

/// From which checkpoint on lines are fitted: the first of at least 4 samples per pixel, or 0 if there are fewer than 4
/// such.
[[nodiscard]] std::size_t fitStart(const MeanCurve& curve);

/// The slope of log MSE over the log of `over`, by least squares, from checkpoint `start` on. Checkpoints whose MSE is
/// not above 0 have no logarithm and are left out; NaN of fewer than two.
[[nodiscard]] double logSlope(const MeanCurve& curve, std::vector<double> MeanCurve::*over, std::size_t start);

/// f of MSE = c n^-b + f. For a given b it is linear least squares in c and f; b from 0.5 to 3 is what leaves the
/// least. Squares are relative to `scale`, a smooth curve through the errors. Checkpoints that are not above 0 count
/// like any.
class FloorFit {
public:
    /// Weights by the line through `curve` in logarithms.
    FloorFit(const MeanCurve& curve, std::size_t start);
    /// NaN of fewer than four checkpoints.
    [[nodiscard]] double operator()(const MeanCurve& curve) const;

private:
    std::size_t start_;
    std::vector<double> scale_; ///< of each checkpoint
};

/// How the time to an error beyond the last checkpoint is told.
enum class BeyondRange { unknown, alongSlope };

/// log seconds at which the curve first reaches log MSE `target`, in logarithms straight between checkpoints with MSE
/// above 0. -infinity: it is below the target from the first; +infinity: it does not reach it. Along the slope, samples
/// follow from the slope of log MSE over log samples, from the last checkpoint on, and time is proportional to samples.
class TimeFinder {
public:
    TimeFinder(double mse, std::size_t start, BeyondRange beyond) : mse_(mse), start_(start), beyond_(beyond) {}
    [[nodiscard]] double operator()(const MeanCurve& curve) const;

private:
    [[nodiscard]] double beyond(const MeanCurve& curve, std::size_t last) const;

    double mse_;
    std::size_t start_;
    BeyondRange beyond_;
};

} // namespace isolux
