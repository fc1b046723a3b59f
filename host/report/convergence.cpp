#include "report/convergence.h"

#include "report/convergence_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a slope that is exactly -1 may come out as: far above the rounding of logarithms, far below any noise.
constexpr double kSlopeRounding = 1e-9;

/// The reference's variance may be so much of the MSE that it serves to measure.
constexpr double kReferenceShare = 0.01;

double signedRoot(double value) { return std::copysign(std::sqrt(std::abs(value)), value); }

Interval map(const Interval& interval, double (*function)(double)) {
    return {function(interval.low), function(interval.estimate), function(interval.high)};
}

Interval scaled(const Interval& interval, double factor) {
    return {interval.low * factor, interval.estimate * factor, interval.high * factor};
}

/// The interval where the estimate has another, independent standard error that is known for sure.
Interval widened(const Interval& interval, double standardError) {
    const double half =
        std::hypot(0.5 * (interval.high - interval.low), normalQuantile(0.5 + 0.5 * kConfidence) * standardError);
    return {interval.estimate - half, interval.estimate, interval.estimate + half};
}

/// The mean of the reference: as given, else as the samples' own relative errors have it.
double referenceMean(const SeedCurves& curves, const ReferenceQuality& reference) {
    if (reference.mean > 0.0) return reference.mean;
    for (const auto& samples : curves.checkpoints) {
        for (const ErrorSample* sample : samples) {
            const double mean = std::sqrt(std::abs(sample->mse)) / std::abs(sample->relativeRmse);
            if (mean > 0.0 && std::isfinite(mean)) return mean;
        }
    }
    return kUnknown;
}

// --- Checkpoints ---

std::vector<double> column(const std::vector<const ErrorSample*>& samples, double ErrorSample::*figure) {
    std::vector<double> values(samples.size());
    std::transform(samples.begin(), samples.end(), values.begin(),
                   [&](const ErrorSample* sample) { return sample->*figure; });
    return values;
}

/// Without those that were not taken: FLIP may be of some seeds alone.
std::vector<double> known(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    return values;
}

/// The root of the mean square over seeds, as the relative RMSE is: so that the two compare.
Interval rootMeanSquare(std::vector<double> values) {
    for (double& value : values) value *= value;
    return map(meanInterval(values), signedRoot);
}

double meanRays(const std::vector<const ErrorSample*>& samples) {
    double sum = 0.0;
    for (const ErrorSample* sample : samples) sum += static_cast<double>(sample->rays);
    return sum / static_cast<double>(samples.size());
}

CheckpointSummary summariseCheckpoint(const std::vector<const ErrorSample*>& samples, double referenceMean,
                                      const ReferenceQuality& reference) {
    const auto average = [&](double ErrorSample::*figure) { return meanInterval(column(samples, figure)); };
    CheckpointSummary summary;
    summary.samplesPerPixel = mean(column(samples, &ErrorSample::samplesPerPixel));
    summary.raysPerPixel = reference.pixels > 0 ? meanRays(samples) / static_cast<double>(reference.pixels) : kUnknown;
    summary.wallSeconds = median(column(samples, &ErrorSample::wallSeconds));
    summary.deviceSeconds = median(column(samples, &ErrorSample::deviceSeconds));
    summary.mse = average(&ErrorSample::mse);
    summary.relMse = average(&ErrorSample::relMse);
    summary.relMseTrimmed = average(&ErrorSample::relMseTrimmed);
    summary.mae = average(&ErrorSample::mae);
    summary.flip = meanInterval(known(column(samples, &ErrorSample::flip)));
    summary.bias = widened(average(&ErrorSample::bias), reference.relativeBiasError); // it is one for all seeds
    summary.relativeRmse = scaled(map(summary.mse, signedRoot), 1.0 / referenceMean);
    summary.estimate = rootMeanSquare(column(samples, &ErrorSample::estimate));
    return summary;
}

// --- Variants ---

/// A variant with what its ratios to others are made from.
struct FittedVariant {
    VariantSummary summary;
    std::vector<std::vector<double>> logTimes; ///< [error][resample]
    std::size_t seeds = 0;
};

double efficiencyOf(const MeanCurve& curve) {
    return curve.mse.back() > 0.0 ? 1.0 / (curve.mse.back() * curve.seconds.back()) : kUnknown;
}

/// -1 or steeper as far as its interval tells, and a floor that was looked for and not found.
bool slopeHolds(const VariantSummary& variant) {
    return variant.slopeSamples.low <= -1.0 + kSlopeRounding && variant.floor.known() && variant.floor.low <= 0.0;
}

void fitCurves(VariantSummary& variant, const ResampledCurves& curves, double referenceMean) {
    const std::size_t start = fitStart(curves.all);
    const auto slope = [&](std::vector<double> MeanCurve::*over) {
        return bootstrap(curves, [=](const MeanCurve& curve) { return logSlope(curve, over, start); });
    };
    variant.slopeTime = slope(&MeanCurve::seconds);
    variant.slopeSamples = slope(&MeanCurve::samples);
    variant.floor = scaled(bootstrap(curves, FloorFit(curves.all, start)), 1.0 / (referenceMean * referenceMean));
    variant.efficiency = bootstrap(curves, efficiencyOf);
    variant.slopeHolds = slopeHolds(variant);
}

std::string whySlopeFails(const VariantSummary& variant) {
    const auto text = [](const char* name, const Interval& value) {
        return fmt::format("{} {:.3g} [{:.3g}, {:.3g}]", name, value.estimate, value.low, value.high);
    };
    if (!variant.slopeSamples.known()) return "the slope has no interval";
    if (!(variant.slopeSamples.low <= -1.0 + kSlopeRounding))
        return text("slope", variant.slopeSamples) + " does not hold";
    if (!variant.floor.known()) return "a floor cannot be told from the slope";
    return text("floor", variant.floor) + " lies above 0";
}

/// Why there is no time, if there is none.
std::string whyUnknown(const VariantSummary& variant, double logTime) {
    if (std::isfinite(logTime)) return "";
    if (std::isnan(logTime)) return "the error is not known";
    if (logTime < 0.0)
        return fmt::format("reached at the first checkpoint: within {:.3g} s", variant.checkpoints.front().wallSeconds);
    if (variant.slopeHolds) return "not reached; the error does not fall";
    return "not reached; " + whySlopeFails(variant);
}

/// One error: when it is reached, and the logarithm of that over the resamples.
TimeToError timeTo(double error, const VariantSummary& variant, const ResampledCurves& curves, double referenceMean,
                   std::vector<double>& logTimes) {
    const std::size_t start = fitStart(curves.all);
    const double mse = error * referenceMean * error * referenceMean;
    const TimeFinder finder(mse, start, variant.slopeHolds ? BeyondRange::alongSlope : BeyondRange::unknown);
    const double logTime = finder(curves.all);
    logTimes = ofResamples(curves, finder);
    TimeToError time;
    time.error = error;
    time.reason = whyUnknown(variant, logTime);
    if (!time.reason.empty()) return time;
    time.seconds = map(percentileInterval(logTime, logTimes, curves.seeds), std::exp);
    time.extrapolated = std::isinf(TimeFinder(mse, start, BeyondRange::unknown)(curves.all));
    return time;
}

FittedVariant fitVariant(const SeedCurves& seedCurves, const ReferenceQuality& reference, const FitOptions& options) {
    const double mean = referenceMean(seedCurves, reference);
    FittedVariant fitted;
    fitted.seeds = seedCurves.seeds.size();
    VariantSummary& summary = fitted.summary;
    summary.name = seedCurves.name;
    summary.seeds = fitted.seeds;
    summary.setupSeconds = median(column(seedCurves.checkpoints.back(), &ErrorSample::setupSeconds));
    for (const auto& samples : seedCurves.checkpoints)
        summary.checkpoints.push_back(summariseCheckpoint(samples, mean, reference));
    const ResampledCurves curves = resampleCurves(seedCurves, options.resamples);
    fitCurves(summary, curves, mean);
    for (const double error : options.errors)
        summary.timeTo.push_back(timeTo(error, summary, curves, mean, fitted.logTimes.emplace_back()));
    return fitted;
}

// --- Ratios ---

/// How many times sooner `a` reaches an error than `b`: pairs of resamples, which drew the same seeds where both have
/// the same.
Interval timeRatio(const FittedVariant& a, const FittedVariant& b, std::size_t error) {
    const double estimate =
        std::log(b.summary.timeTo[error].seconds.estimate) - std::log(a.summary.timeTo[error].seconds.estimate);
    std::vector<double> logRatios(std::min(a.logTimes[error].size(), b.logTimes[error].size()));
    for (std::size_t i = 0; i < logRatios.size(); ++i) logRatios[i] = b.logTimes[error][i] - a.logTimes[error][i];
    return map(percentileInterval(estimate, logRatios, std::min(a.seeds, b.seeds)), std::exp);
}

void addRatios(ConvergenceReport& report, const std::vector<FittedVariant>& variants, std::size_t error) {
    for (std::size_t i = 0; i < variants.size(); ++i) {
        for (std::size_t j = i + 1; j < variants.size(); ++j) {
            const TimeToError& first = variants[i].summary.timeTo[error];
            const TimeToError& second = variants[j].summary.timeTo[error];
            if (!first.reason.empty() || !second.reason.empty()) continue;
            const bool firstFaster = first.seconds.estimate <= second.seconds.estimate;
            const FittedVariant& faster = variants[firstFaster ? i : j];
            const FittedVariant& slower = variants[firstFaster ? j : i];
            report.ratios.push_back({faster.summary.name, slower.summary.name, first.error,
                                     timeRatio(faster, slower, error), first.extrapolated || second.extrapolated});
        }
    }
}

} // namespace

double ReferenceQuality::relativeRmse() const { return mean > 0.0 ? signedRoot(mse) / mean : kUnknown; }

/// Wilson 1927, equation 9 there in today's notation.
Interval Coverage::share() const {
    if (total == 0) return {};
    const double n = static_cast<double>(total);
    const double p = static_cast<double>(inside) / n;
    const double z = normalQuantile(0.5 + 0.5 * kConfidence);
    const double center = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / (1.0 + z * z / n);
    return {std::max(center - half, 0.0), p, std::min(center + half, 1.0)};
}

ConvergenceReport summarise(const std::vector<ErrorSample>& samples, const ReferenceQuality& reference,
                            const FitOptions& options) {
    std::vector<FittedVariant> variants;
    for (const SeedCurves& curves : curvesOf(samples)) variants.push_back(fitVariant(curves, reference, options));
    ConvergenceReport report;
    for (std::size_t error = 0; error < options.errors.size(); ++error) addRatios(report, variants, error);
    for (FittedVariant& variant : variants) report.variants.push_back(std::move(variant.summary));
    return report;
}

std::vector<std::string> tooNoisyFor(const ConvergenceReport& report, const ReferenceQuality& reference) {
    std::vector<std::string> names;
    for (const VariantSummary& variant : report.variants) {
        for (std::size_t i = 0; i < variant.checkpoints.size(); ++i) {
            if (reference.mse > kReferenceShare * variant.checkpoints[i].mse.estimate)
                names.push_back(fmt::format("{}@{}", variant.name, i));
        }
    }
    return names;
}

} // namespace isolux
