// The relative difference of two images' means, with its interval: a bias that noise in single pixels hides.
#pragma once

#include "report/image_view.h"
#include "report/statistics.h"

#include <array>
#include <span>

namespace isolux {

/// What an interval of a bias rests on.
enum class BiasMethod {
    none,          ///< neither image carries variance: there is no interval
    independent,   ///< the variances of both
    imageOnly,     ///< the image's variance; the reference is taken as exact
    referenceOnly, ///< the reference's variance; the image is taken as exact
    paired         ///< the images share random numbers: the differences of their pixels
};
[[nodiscard]] const char* biasMethodName(BiasMethod method);

/// (mean(image) - mean(reference)) / mean(reference), with 95 % intervals.
struct RelativeBias {
    BiasMethod method = BiasMethod::none;
    Interval luminance;
    std::array<Interval, 3> channels; ///< R, G, B

    [[nodiscard]] const Interval& of(Quantity quantity) const;
};

/// Whether two images come from random numbers they share: same seed, overlapping ranges of samples
/// (isolux/sampleFirst, isolux/sampleCount), and nothing that says their scenes differ (isolux/sceneHash).
[[nodiscard]] bool shareSamples(const Metadata& a, const Metadata& b);

/// The images must have as many pixels as each other. Images that share samples are compared in pairs; others by their
/// variances, and the interval of the ratio is that of the delta method.
[[nodiscard]] RelativeBias relativeBias(const Image& image, const Image& reference);

/// Relative bias of paired pixels: the variance of the mean difference is sum (d_i - mean d)^2 / (N (N - 1)). It counts
/// as noise what differs between pixels, so it is too wide rather than too narrow.
[[nodiscard]] Interval pairedRelativeBias(std::span<const double> image, std::span<const double> reference);

} // namespace isolux
