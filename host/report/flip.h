// FLIP: how strongly a viewer who alternates between two images sees them differ, pixel by pixel from 0 to 1.
#pragma once

#include "core/math.h"
#include "film/image.h"

#include <optional>
#include <span>
#include <vector>

namespace isolux {

/// What the pixels are: colours of a display from 0 to 1, or radiance of any size, which a display shows at some
/// exposure.
enum class DynamicRange { low, high };

/// A display of 3840 pixels and 0.7 m across, seen from 0.7 m: 67.02 pixels per degree of visual angle (Andersson et
/// al. 2020, section 3).
inline constexpr double kPixelsPerDegree = 0.7 * (3840.0 / 0.7) * (kPi / 180.0);

struct FlipOptions {
    DynamicRange range = DynamicRange::high;
    double pixelsPerDegree = kPixelsPerDegree; ///< above 0
};

/// The exposures, in stops, at which images of high dynamic range are compared.
struct ExposureRange {
    double start = 0.0;
    double stop = 0.0;
    std::size_t count = 0;
};

struct FlipResult {
    FlipOptions options;
    std::optional<ExposureRange> exposures; ///< of high dynamic range
    double mean = 0.0;                      ///< NaN if any pixel is
    double largest = 0.0;                   ///< NaN if any pixel is
    std::vector<double> errors; ///< of each pixel; NaN around pixels that are NaN or infinite, as far as filters reach
};

/// LDR-FLIP (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020) or HDR-FLIP (Andersson, Nilsson,
/// Shirley and Akenine-Moller 2021: the largest LDR-FLIP of each pixel over the exposures). Linear Rec. 709 in,
/// negative values count as 0. The images must have the same size and channels R, G, B; throws Error (bad input)
/// otherwise.
[[nodiscard]] FlipResult flip(const Image& image, const Image& reference, const FlipOptions& options = {});

/// From the exposure that brings the brightest pixel of the reference to the display's range to the one that brings the
/// median there, about one stop apart and at least two (Andersson et al. 2021, section 3). Pixels that are NaN or
/// infinite are left out; a black pixel counts as 2^-23, so that exposures are finite.
[[nodiscard]] ExposureRange automaticExposures(std::span<const Vec3d> reference);

} // namespace isolux
