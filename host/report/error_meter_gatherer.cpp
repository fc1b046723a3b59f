// How well films know their own error, and the bias that averaging over seeds lays bare.
#include "report/error_meter.h"

#include "report/run_report.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace isolux {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kFifths = 5;
constexpr std::uint8_t kUnlit = kFifths;

/// Renderers sum up to 16 samples in single precision: 15 roundings, and one more where the reference is stored.
constexpr double kSingleRounding = 16.0 * 0x1p-24;

/// The luminances that end the fifths of the lit pixels; nothing of a black image.
std::vector<double> fifthsOf(const std::vector<ReferencePixel>& pixels) {
    std::vector<double> lit;
    for (const ReferencePixel& pixel : pixels) {
        if (luminance(pixel.mean()) > 0.0) lit.push_back(luminance(pixel.mean()));
    }
    if (lit.empty()) return std::vector<double>(kFifths, 0.0);
    std::sort(lit.begin(), lit.end());
    std::vector<double> ends;
    for (std::size_t fifth = 1; fifth <= kFifths; ++fifth)
        ends.push_back(lit[std::max<std::size_t>(fifth * lit.size() / kFifths, 1) - 1]);
    return ends;
}

/// The quantile of a two-sided interval of `replicates` means, or of many independent samples if there are none.
double quantileOf(std::size_t replicates) {
    const double p = 0.5 + 0.5 * kConfidence;
    return replicates < 2 ? normalQuantile(p) : studentQuantile(p, static_cast<double>(replicates - 1));
}

/// `quantileOf` for as many replicates as a pixel may have.
std::vector<double> quantiles() {
    std::vector<double> values;
    for (std::size_t replicates = 0; replicates <= PixelReplicates::kCount; ++replicates)
        values.push_back(quantileOf(replicates));
    return values;
}

std::size_t replicatesOf(const Film& film, std::size_t pixel) {
    if (film.replicates.empty()) return 0;
    const auto& counts = film.replicates[pixel].sampleCount;
    return static_cast<std::size_t>(std::count_if(counts.begin(), counts.end(), [](auto n) { return n > 0; }));
}

double sum(const std::vector<double>& values) { return mean(values) * static_cast<double>(values.size()); }

/// Standard error from the estimates that leave one of `left.size()` parts out (Tukey 1958; Efron and Tibshirani 1993,
/// equation 11.5).
double jackknifeError(const std::vector<double>& left) {
    const double count = static_cast<double>(left.size());
    return std::sqrt(variance(left) * (count - 1.0) * (count - 1.0) / count);
}

/// log of the root of the ratio of sums.
double logRoot(double numerator, double denominator) {
    return numerator > 0.0 && denominator > 0.0 ? 0.5 * std::log(numerator / denominator) : kUnknown;
}

/// Root of the ratio of two means of squares, its interval by the jackknife on its logarithm.
Interval rootRatio(const std::vector<double>& numerators, const std::vector<double>& denominators) {
    if (numerators.empty()) return {};
    const double top = sum(numerators);
    const double bottom = sum(denominators);
    std::vector<double> left(numerators.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = logRoot(top - numerators[i], bottom - denominators[i]);
    const Interval log =
        studentInterval(logRoot(top, bottom), jackknifeError(left), static_cast<double>(left.size()) - 1.0);
    return {std::exp(log.low), std::exp(log.estimate), std::exp(log.high)};
}

} // namespace

CheckpointGatherer::CheckpointGatherer(const ErrorMeter& meter) : meter_(&meter) {
    gathered_.pixels.resize(kFifths);
    gathered_.brightness = fifthsOf(meter.pixels());
    for (const ReferencePixel& pixel : meter.pixels()) {
        const double brightness = luminance(pixel.mean());
        const auto fifth = std::lower_bound(gathered_.brightness.begin(), gathered_.brightness.end(), brightness);
        fifths_.push_back(brightness > 0.0 ? static_cast<std::uint8_t>(fifth - gathered_.brightness.begin()) : kUnlit);
    }
}

void CheckpointGatherer::add(const Film& film, const ErrorSample& sample) {
    assert(film.pixels.size() == meter_->pixels().size());
    addMeanLuminance(film);
    addPixels(film);
    addDeviations(film);
    estimates_.push_back(sample.estimate * sample.estimate);
    errors_.push_back(sample.relativeRmse * std::abs(sample.relativeRmse));
}

/// The film's interval, widened by the reference's own error.
void CheckpointGatherer::addMeanLuminance(const Film& film) {
    const Interval interval = imageQuality(film).meanLuminance;
    if (!interval.known()) return;
    double reference = 0.0;
    for (const ReferencePixel& pixel : meter_->pixels()) reference += luminance(pixel.mean());
    reference /= static_cast<double>(meter_->pixels().size());
    const double quantile = quantileOf(film.replicates.empty() ? 0 : PixelReplicates::kCount);
    const double widening = quantile * meter_->quality().relativeBiasError * reference;
    const double half = std::hypot(0.5 * (interval.high - interval.low), widening);
    ++gathered_.meanLuminance.total;
    gathered_.meanLuminance.inside += std::abs(interval.estimate - reference) <= half + kSingleRounding * reference;
}

void CheckpointGatherer::addPixels(const Film& film) {
    static const std::vector<double> kQuantiles = quantiles();
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelStatistics& pixel = film.pixels[i];
        if (fifths_[i] == kUnlit || pixel.sampleCount < 2) continue;
        const ReferencePixel& reference = meter_->pixels()[i];
        const double x = luminance(pixel.mean);
        const double r = luminance(reference.mean());
        const double deviation =
            std::sqrt(pixel.luminanceVariance() / static_cast<double>(pixel.sampleCount) + reference.luminanceVariance);
        const double half = kQuantiles[replicatesOf(film, i)] * deviation + kSingleRounding * (std::abs(x) + r);
        Coverage& coverage = gathered_.pixels[fifths_[i]];
        ++coverage.total;
        coverage.inside += std::abs(x - r) <= half;
    }
}

void CheckpointGatherer::addDeviations(const Film& film) {
    Group& group = groups_[errors_.size() % kGroups];
    group.deviations.resize(film.pixels.size(), Vec3f(0.0f));
    group.seeds += 1.0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const ReferencePixel& reference = meter_->pixels()[i];
        const Vec3d& x = film.pixels[i].mean;
        const Vec3d squared = (x - reference.first) * (x - reference.second);
        group.squaredErrors += squared.x + squared.y + squared.z;
        group.deviations[i] += Vec3f(x - reference.mean());
    }
}

Calibration CheckpointGatherer::calibration() const {
    Calibration result = gathered_;
    result.estimateOverError = rootRatio(estimates_, errors_);
    return result;
}

/// With A and B the sums of a_i = x_i - r1 and b_i = x_i - r2 over K seeds, the mean of a_i b_j over i != j is
/// (A B - sum a_i b_i) / (K (K - 1)).
double CheckpointGatherer::biasSquaredWithout(const std::vector<Vec3d>& sum, const Group& left) const {
    double seeds = -left.seeds;
    double squaredErrors = -left.squaredErrors;
    for (const Group& group : groups_) {
        seeds += group.seeds;
        squaredErrors += group.squaredErrors;
    }
    double products = 0.0;
    double noise = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const ReferencePixel& reference = meter_->pixels()[i];
        const Vec3d deviation = left.deviations.empty() ? sum[i] : sum[i] - Vec3d(left.deviations[i]);
        const Vec3d apart = 0.5 * seeds * (reference.first - reference.second);
        const Vec3d product = (deviation - apart) * (deviation + apart);
        products += product.x + product.y + product.z;
        noise += reference.noise.x + reference.noise.y + reference.noise.z;
    }
    const double count = 3.0 * static_cast<double>(sum.size());
    return ((products - squaredErrors) / (seeds * (seeds - 1.0)) - noise) / count;
}

Interval CheckpointGatherer::biasSquared() const {
    if (errors_.size() < 2) return {};
    std::vector<Vec3d> sum(meter_->pixels().size(), Vec3d(0.0));
    for (const Group& group : groups_) {
        for (std::size_t i = 0; i < group.deviations.size(); ++i) sum[i] += Vec3d(group.deviations[i]);
    }
    const double estimate = biasSquaredWithout(sum, {});
    if (errors_.size() < 3) return {kUnknown, estimate, kUnknown};
    std::vector<double> left;
    for (const Group& group : groups_) {
        if (group.seeds > 0.0) left.push_back(biasSquaredWithout(sum, group));
    }
    return studentInterval(estimate, jackknifeError(left), static_cast<double>(left.size()) - 1.0);
}

} // namespace isolux
