// The samples of one variant as curves over its checkpoints: by seed, and averaged over seeds or resamples of them.
#pragma once

#include "report/convergence.h"

#include <span>
#include <string>
#include <vector>

namespace isolux {

/// Figures by checkpoint and seed: [checkpoint][seed].
using SeedTable = std::vector<std::vector<double>>;

/// The samples of one variant. Every seed has every checkpoint.
struct SeedCurves {
    std::string name;
    std::vector<std::uint64_t> seeds;                         ///< ascending
    std::vector<std::vector<const ErrorSample*>> checkpoints; ///< [checkpoint][seed]

    [[nodiscard]] SeedTable table(double ErrorSample::*figure) const;
};

/// The variants in the order in which they first appear. Throws Error (bad input) as `summarise` does. Points into
/// `samples`.
[[nodiscard]] std::vector<SeedCurves> curvesOf(const std::vector<ErrorSample>& samples);

/// What fits are made to: means over seeds of samples and MSE, the median of seconds.
struct MeanCurve {
    std::vector<double> samples;
    std::vector<double> seconds;
    std::vector<double> mse;

    [[nodiscard]] std::size_t size() const { return mse.size(); }
};

/// The curve of all seeds, and those of resamples of them: a seed is drawn with its whole curve, since the checkpoints
/// of one seed share samples. Two variants with the same seeds are resampled alike.
struct ResampledCurves {
    MeanCurve all;
    std::vector<MeanCurve> resamples; ///< none of a single seed
    std::size_t seeds = 0;
};
[[nodiscard]] ResampledCurves resampleCurves(const SeedCurves& curves, std::uint32_t resamples);

/// The middle value, or the mean of the two in the middle; NaN of nothing.
[[nodiscard]] double median(std::vector<double> values);

} // namespace isolux
