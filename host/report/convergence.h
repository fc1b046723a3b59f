// Error against run time: what is measured of progressive renders, and what follows from it. A *variant* is a way to
// render the same image; each is rendered with several seeds, and its error is taken at *checkpoints*.
#pragma once

#include "report/statistics.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// One line of convergence.csv: the image of one variant and seed at one checkpoint. Errors are over all pixels and the
/// channels R, G and B, linear. `x` is the image, `r1` and `r2` two independent references, `r` their mean.
struct ErrorSample {
    std::string variant;
    std::uint64_t seed = 0;
    std::uint32_t checkpoint = 0; ///< 0, 1, ...; the same for all seeds of a variant
    double samplesPerPixel = 0.0; ///< the mean over the pixels
    std::uint64_t rays = 0;
    double deviceSeconds = std::numeric_limits<double>::quiet_NaN(); ///< NaN where it is not known
    double wallSeconds = 0.0;   ///< of rendering alone: without set-up, without measuring
    double setupSeconds = 0.0;  ///< load, build, upload, compile
    double mse = 0.0;           ///< mean[(x - r1)(x - r2)]: free of the references' noise; may be negative
    double relMse = 0.0;        ///< mean[(x - r1)(x - r2) / (r^2 + 0.01)]
    double relMseTrimmed = 0.0; ///< the same without the worst 0.1 % of pixels
    double mae = 0.0;           ///< mean |x - r|, the noise of r included
    double flip = std::numeric_limits<double>::quiet_NaN();     ///< mean FLIP; NaN where it was not asked for
    double bias = 0.0;                                          ///< (mean(x) - mean(r)) / mean(r) of luminance
    double relativeRmse = 0.0;                                  ///< sign(mse) sqrt(|mse|) / mean(r)
    double estimate = std::numeric_limits<double>::quiet_NaN(); ///< relative RMSE as the renderer estimates it
};

/// How sure the references are.
struct ReferenceQuality {
    double samplesPerPixel = 0.0;   ///< of both together; 0: unknown
    double mean = 0.0;              ///< of R, G and B; 0: unknown, then it follows from the samples
    double mse = 0.0;               ///< mean variance of r, the mean of both, from their difference
    double relativeBiasError = 0.0; ///< standard error of mean luminance, relative to it
    std::uint64_t pixels = 0;       ///< 0: unknown, as are then rays per pixel

    /// Of r itself; NaN if the mean is not known.
    [[nodiscard]] double relativeRmse() const;
};

/// How often intervals of 95 % hold what they should, over seeds (and pixels). Shares have Wilson's interval (1927).
struct Coverage {
    std::uint64_t inside = 0;
    std::uint64_t total = 0;
    [[nodiscard]] Interval share() const;
};

/// Calibration of one variant at one checkpoint.
struct Calibration {
    Coverage meanLuminance;         ///< over seeds: the interval of the image's mean luminance
    std::vector<Coverage> pixels;   ///< over seeds and pixels: by brightness of the reference, fifths of the lit pixels
    std::vector<double> brightness; ///< upper ends of the fifths, luminance
    Interval estimateOverError;     ///< estimated over true relative RMSE, root mean squares over seeds
};

/// Aggregated over the seeds of a variant; intervals over seeds.
struct CheckpointSummary {
    double samplesPerPixel = 0.0;
    double raysPerPixel = 0.0;  ///< NaN if the number of pixels is not known
    double wallSeconds = 0.0;   ///< median
    double deviceSeconds = 0.0; ///< median
    Interval mse, relMse, relMseTrimmed, mae, flip, bias, relativeRmse, estimate;
    Interval biasSquared; ///< mean over pixels of the squared bias: mean[(x_i - r1)(x_j - r2)], i and j different seeds
    std::optional<Calibration> calibration;
};

/// When an error is reached.
struct TimeToError {
    double error = 0.0; ///< relative RMSE
    Interval seconds;   ///< NaN if it cannot be said
    bool extrapolated = false;
    std::string reason; ///< why it cannot be said; empty if it can
};

struct VariantSummary {
    std::string name;
    std::string options; ///< as given
    std::uint64_t seeds = 0;
    double setupSeconds = 0.0; ///< median
    std::vector<CheckpointSummary> checkpoints;
    Interval slopeTime;    ///< of log MSE over log seconds
    Interval slopeSamples; ///< of log MSE over log samples
    Interval floor; ///< f of MSE = c n^-b + f, in relative MSE (over mean(r)^2): above 0 beyond its interval is bias
    bool slopeHolds = false; ///< -1 or steeper, and no floor: what extrapolation rests on
    Interval efficiency;     ///< 1 / (MSE seconds) at the last checkpoint
    std::vector<TimeToError> timeTo;
};

/// How many times sooner `faster` reaches an error than `slower`: paired bootstrap over seeds.
struct SpeedRatio {
    std::string faster;
    std::string slower;
    double error = 0.0;
    Interval ratio; ///< estimate >= 1
    bool extrapolated = false;
};

struct ConvergenceReport {
    std::vector<VariantSummary> variants;
    std::vector<SpeedRatio> ratios; ///< every pair of variants at every error that both can be said to reach
};

struct FitOptions {
    std::vector<double> errors{0.05, 0.01}; ///< relative RMSEs whose times are asked for
    std::uint32_t resamples = 2000;         ///< of the bootstrap
};

/// Everything that follows from the samples alone; biasSquared and calibration are the caller's to fill in. Variants in
/// the order in which they first appear; times are wall seconds of rendering. Throws Error (bad input) if a variant's
/// seeds have different checkpoints or a time is not above 0.
[[nodiscard]] ConvergenceReport summarise(const std::vector<ErrorSample>& samples, const ReferenceQuality& reference,
                                          const FitOptions& options);

/// The checkpoints ("variant@checkpoint") for which the reference is too noisy: its variance is above 1 % of their MSE.
[[nodiscard]] std::vector<std::string> tooNoisyFor(const ConvergenceReport& report, const ReferenceQuality& reference);

/// "variant B reaches 5 % relative RMSE 3.4 (3.1-3.7) times sooner than A"
[[nodiscard]] std::string sentence(const SpeedRatio& ratio);

[[nodiscard]] std::string toCsv(const std::vector<ErrorSample>& samples);
/// `where` names the file in errors. Throws Error (bad input) with the line.
[[nodiscard]] std::vector<ErrorSample> fromCsv(const std::string& text, const std::string& where);

[[nodiscard]] std::string toText(const ConvergenceReport& report);
/// {"errors", "variants", "ratios"}
[[nodiscard]] nlohmann::ordered_json toJson(const ConvergenceReport& report);
/// {"samplesPerPixel", "relativeRmse", "relativeBiasError"}
[[nodiscard]] nlohmann::ordered_json toJson(const ReferenceQuality& reference);

} // namespace isolux
