#include "report/filter.h"

#include "core/math.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace isolux {
namespace {

template <typename Function> Kernel makeKernel(int radius, const Function& weight) {
    Kernel kernel;
    for (int offset = -radius; offset <= radius; ++offset) kernel.push_back(weight(static_cast<double>(offset)));
    return kernel;
}

int threeDeviations(double deviation) { return static_cast<int>(std::ceil(3.0 * deviation)); }

double gaussian(double x, double deviation) { return std::exp(-0.5 * x * x / (deviation * deviation)); }

/// Scales positive weights to sum to 1 and negative ones to -1.
Kernel balanced(Kernel kernel) {
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : kernel) (weight > 0.0 ? positive : negative) += weight;
    for (double& weight : kernel) weight /= weight > 0.0 ? positive : -negative;
    return kernel;
}

/// One row, its first and last pixels repeated `radius` times on either side.
void padRow(std::span<const double> row, std::vector<double>& padded, std::size_t radius) {
    padded.assign(row.size() + 2 * radius, row.front());
    std::copy(row.begin(), row.end(), padded.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill(padded.end() - static_cast<std::ptrdiff_t>(radius), padded.end(), row.back());
}

Plane convolveRows(const Plane& plane, const GridSize& size, const Kernel& kernel) {
    Plane result(plane.size(), 0.0);
    tbb::parallel_for(std::size_t{0}, size.height, [&](std::size_t y) {
        std::vector<double> padded;
        padRow(std::span(plane).subspan(y * size.width, size.width), padded, kernel.size() / 2);
        double* const row = result.data() + y * size.width;
        for (std::size_t k = 0; k < kernel.size(); ++k) {
            for (std::size_t x = 0; x < size.width; ++x) row[x] += kernel[k] * padded[x + k];
        }
    });
    return result;
}

Plane convolveColumns(const Plane& plane, const GridSize& size, const Kernel& kernel) {
    Plane result(plane.size(), 0.0);
    const std::size_t radius = kernel.size() / 2;
    tbb::parallel_for(std::size_t{0}, size.height, [&](std::size_t y) {
        double* const row = result.data() + y * size.width;
        for (std::size_t k = 0; k < kernel.size(); ++k) {
            const std::size_t source = std::clamp(y + k, radius, radius + size.height - 1) - radius;
            for (std::size_t x = 0; x < size.width; ++x) row[x] += kernel[k] * plane[source * size.width + x];
        }
    });
    return result;
}

} // namespace

Kernel gaussianKernel(double deviation) {
    return balanced(makeKernel(threeDeviations(deviation), [&](double x) { return gaussian(x, deviation); }));
}

Kernel gaussianSlopeKernel(double deviation) {
    return balanced(makeKernel(threeDeviations(deviation), [&](double x) { return -x * gaussian(x, deviation); }));
}

Kernel gaussianCurvatureKernel(double deviation) {
    return balanced(makeKernel(threeDeviations(deviation), [&](double x) {
        return (x * x / (deviation * deviation) - 1.0) * gaussian(x, deviation);
    }));
}

GaussianSum contrastSensitivity(std::span<const SensitivityTerm> terms, int radius, double pixelsPerDegree) {
    GaussianSum filter;
    double sum = 0.0; // of the two-dimensional weights
    for (const SensitivityTerm& term : terms) {
        // Two factors, one a dimension, make the term: each takes the root of the amplitude.
        const double amplitude = std::sqrt(term.amplitude * std::sqrt(kPi / term.width));
        filter.push_back(makeKernel(radius, [&](double pixels) {
            const double x = pixels / pixelsPerDegree;
            return amplitude * std::exp(-kPi * kPi * x * x / term.width);
        }));
        const double row = std::accumulate(filter.back().begin(), filter.back().end(), 0.0);
        sum += row * row;
    }
    for (Kernel& kernel : filter) {
        for (double& weight : kernel) weight /= std::sqrt(sum);
    }
    return filter;
}

Plane convolve(const Plane& plane, const GridSize& size, const Kernel& horizontal, const Kernel& vertical) {
    return convolveColumns(convolveRows(plane, size, horizontal), size, vertical);
}

Plane convolve(const Plane& plane, const GridSize& size, const GaussianSum& filter) {
    Plane result(plane.size(), 0.0);
    for (const Kernel& kernel : filter) {
        const Plane part = convolve(plane, size, kernel, kernel);
        for (std::size_t i = 0; i < result.size(); ++i) result[i] += part[i];
    }
    return result;
}

} // namespace isolux
