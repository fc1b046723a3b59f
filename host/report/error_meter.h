// Takes the error of films against two independent references, checkpoint by checkpoint, and how well films know it.
#pragma once

#include "film/film.h"
#include "film/image.h"
#include "report/convergence.h"

#include <array>
#include <vector>

namespace isolux {

enum class MeasureFlip { no, yes };

/// A pixel as the references have it. E[(x - first)(x - second)] - noise is the squared error of x: of two references
/// the noises drop out; where there is one it is both, and `noise` is its variance.
struct ReferencePixel {
    Vec3d first{0.0};
    Vec3d second{0.0};
    Vec3d noise{0.0};
    double luminanceVariance = 0.0; ///< of the mean of both

    [[nodiscard]] Vec3d mean() const { return 0.5 * (first + second); }
    [[nodiscard]] Vec3d squaredError(const Vec3d& x) const { return (x - first) * (x - second) - noise; }
};

class ErrorMeter {
public:
    /// Two images of the same size by independent random numbers. Throws Error (bad input) if sizes or channels do not
    /// fit, a pixel is not finite, or the metadata say that they share samples (`shareSamples`).
    ErrorMeter(const Image& first, const Image& second);
    /// One image that carries its own variance (`variance.R/G/B` with `samples.Y`, or `se.R/G/B`): E[(x - r)^2] minus
    /// the mean variance of r takes the place of the product of two differences. Throws Error if it carries none.
    explicit ErrorMeter(const Image& reference);

    [[nodiscard]] const ReferenceQuality& quality() const { return quality_; }
    [[nodiscard]] const Image& reference() const { return mean_; } ///< the mean of both: R, G and B
    [[nodiscard]] const std::vector<ReferencePixel>& pixels() const { return pixels_; }

    /// Fills in the errors and the estimate of the film; the rest of the sample is the caller's. A film with a pixel
    /// that is not finite has errors that are NaN. Throws Error (bad input) if it has another size.
    [[nodiscard]] ErrorSample measure(const Film& film, MeasureFlip flip) const;

private:
    Image mean_;
    std::vector<ReferencePixel> pixels_;
    ReferenceQuality quality_;
};

/// Gathers, over the seeds of one variant at one checkpoint, what Calibration and the squared bias need; a film may be
/// thrown away after `add`. The meter must outlive it. Takes 12 bytes a pixel and seed, up to 16 seeds; more share.
class CheckpointGatherer {
public:
    explicit CheckpointGatherer(const ErrorMeter& meter);
    /// `sample` as the meter measured it.
    void add(const Film& film, const ErrorSample& sample);
    [[nodiscard]] Calibration calibration() const;
    [[nodiscard]] Interval
    biasSquared() const; ///< relative to nothing: the unit of MSE; interval by jackknife over seeds

private:
    /// Seeds that the jackknife leaves out together.
    struct Group {
        double seeds = 0.0;
        double squaredErrors = 0.0;    ///< sum over seeds of the sum over pixels of (x - r1)(x - r2)
        std::vector<Vec3f> deviations; ///< sum over seeds of x - r
    };
    static constexpr std::size_t kGroups = 16;

    void addMeanLuminance(const Film& film);
    void addPixels(const Film& film);
    void addDeviations(const Film& film);
    [[nodiscard]] double biasSquaredWithout(const std::vector<Vec3d>& sum, const Group& left) const;

    const ErrorMeter* meter_;
    Calibration gathered_;
    std::vector<std::uint8_t> fifths_; ///< of each pixel; kUnlit where the reference is black
    std::array<Group, kGroups> groups_;
    std::vector<double> estimates_; ///< squared, relative, a seed each
    std::vector<double> errors_;    ///< squared, relative, true
};

} // namespace isolux
