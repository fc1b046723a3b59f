// Separable filters over one channel of an image, whose border pixels repeat outside.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace isolux {

/// One channel of an image, row by row.
using Plane = std::vector<double>;

struct GridSize {
    std::size_t width = 0;
    std::size_t height = 0;
};

/// An odd number of weights, the middle one at offset 0.
using Kernel = std::vector<double>;

/// A two-dimensional filter that is the sum of separable ones, each the same in x and y.
using GaussianSum = std::vector<Kernel>;

/// Weights of a Gaussian of this standard deviation in pixels, out to three of them, which sum to 1.
[[nodiscard]] Kernel gaussianKernel(double deviation);
/// Its first derivative (towards larger offsets), positive and negative weights scaled to sum to 1 and -1.
[[nodiscard]] Kernel gaussianSlopeKernel(double deviation);
/// Its second derivative, scaled alike.
[[nodiscard]] Kernel gaussianCurvatureKernel(double deviation);

/// amplitude * sqrt(pi / width) * exp(-pi^2 x^2 / width), x in degrees.
struct SensitivityTerm {
    double amplitude;
    double width;
};
/// A sum of such terms over both dimensions, all weights together 1.
[[nodiscard]] GaussianSum contrastSensitivity(std::span<const SensitivityTerm> terms, int radius,
                                              double pixelsPerDegree);

[[nodiscard]] Plane convolve(const Plane& plane, const GridSize& size, const Kernel& horizontal,
                             const Kernel& vertical);
[[nodiscard]] Plane convolve(const Plane& plane, const GridSize& size, const GaussianSum& filter);

} // namespace isolux
