// Takes the error of films against two independent references, checkpoint by checkpoint, and how well films know it.
#pragma once

#include "film/film.h"
#include "film/image.h"
#include "report/convergence.h"

#include <optional>
#include <vector>

namespace isolux {

enum class MeasureFlip { no, yes };

class ErrorMeter {
public:
    /// Two images of the same size by independent random numbers. Throws Error (bad input) if sizes or channels do not
    /// fit, or a pixel is not finite.
    ErrorMeter(Image first, Image second);
    /// One image that carries its own variance (`variance.R/G/B` with `samples.Y`, or `se.R/G/B`): E[(x - r)^2] minus
    /// the mean variance of r takes the place of the product of two differences. Throws Error if it carries none.
    explicit ErrorMeter(Image reference);

    [[nodiscard]] const ReferenceQuality& quality() const;
    [[nodiscard]] const Image& reference() const; ///< the mean of both

    /// Fills in the errors and the estimate of the film; the rest of the sample is the caller's.
    [[nodiscard]] ErrorSample measure(const Film& film, MeasureFlip flip) const;

private:
    Image mean_;
    std::optional<Image> first_, second_;
    ReferenceQuality quality_;
};

/// Gathers, over the seeds of one variant at one checkpoint, what Calibration and the squared bias need; a film may be
/// thrown away after `add`.
class CheckpointGatherer {
public:
    explicit CheckpointGatherer(const ErrorMeter& meter);
    void add(const Film& film, const ErrorSample& sample);
    [[nodiscard]] Calibration calibration() const;
    [[nodiscard]] Interval
    biasSquared() const; ///< relative to nothing: the unit of MSE; interval by jackknife over seeds

private:
    const ErrorMeter* meter_;
};

} // namespace isolux
