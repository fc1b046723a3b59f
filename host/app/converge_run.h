// Measures the variants: every seed of each, in random order, with the error at checkpoints.
#pragma once

#include "app/converge_variants.h"
#include "app/seed_renderer.h"
#include "report/error_meter.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace isolux {

struct ConvergeLimits {
    std::uint32_t seeds = 16;
    std::uint64_t firstSeed = 0;
    std::uint32_t maxSamples = 64;    ///< a pixel, the mean over the pixels
    std::optional<double> maxSeconds; ///< of rendering one seed: as many checkpoints as are reached in it
    std::uint32_t flipSeeds = 0;      ///< how many of the seeds have FLIP taken
};

/// The mean over the pixels.
[[nodiscard]] double samplesPerPixel(const Film& film);

/// One seed of a variant, whole.
struct SeedSamples {
    std::vector<ErrorSample> powers; ///< at 1, 2, 4, ... samples a pixel, before the end
    ErrorSample end;
};

/// A variant while it is measured.
struct MeasuredVariant {
    Variant variant;
    std::unique_ptr<SeedRenderer> renderer;
    double setupSeconds = 0.0;                   ///< loading the scene included
    double secondsPerSample = 0.0;               ///< of a sample of all pixels, as the warm-up found it
    std::optional<std::size_t> checkpoints = {}; ///< that --max-time allows, as the first seed found
    std::vector<SeedSamples> seeds = {};
    std::vector<CheckpointGatherer> powers = {};
    std::optional<CheckpointGatherer> end = {};
    Diagnostics diagnostics = {};

    /// The samples of all seeds at the checkpoints that all of them have: powers of two, and the end.
    [[nodiscard]] std::vector<ErrorSample> samples() const;
    /// Adds what takes more than samples to know: calibration and squared bias of the checkpoints of `samples`.
    void complete(VariantSummary& summary) const;

private:
    [[nodiscard]] std::size_t commonPowers() const;
};

/// Renderers of all variants, each warmed up by a few samples that do not count.
[[nodiscard]] std::vector<MeasuredVariant> prepareVariants(const std::vector<Variant>& variants, const SceneRun& run,
                                                           const Device* device, double dispatchSeconds);

/// Renders all seeds; interrupted, those that are whole stay.
void measureVariants(std::vector<MeasuredVariant>& variants, const ConvergeLimits& limits, const ErrorMeter& meter,
                     ProgressBar& bar);

} // namespace isolux
