// What a render leaves: per-pixel mean, squared deviations and counts, accumulated in double from short batches.
#pragma once

#include "core/math.h"

#include <cstdint>
#include <vector>

namespace isolux {

/// Statistics of a run of samples of one pixel. Radiance is linear Rec. 709, W/(sr m^2).
struct PixelStatistics {
    Vec3d mean{0.0};
    Vec3d squaredDeviation{0.0}; ///< sum of (x - mean)^2 per channel
    double luminanceSquaredDeviation =
        0.0; ///< the same for luminance: channels share random numbers, so it cannot be derived
    std::uint64_t sampleCount = 0;
    std::uint64_t hitCount = 0;      ///< samples whose camera ray met a surface
    std::uint32_t pathSignature = 0; ///< sum over samples of the hash of their discrete events; host/scene/README.md

    /// Takes one sample in (Welford 1962).
    void add(const Vec3d& radiance);
    /// Joins two runs of samples (Chan, Golub and LeVeque 1979).
    void merge(const PixelStatistics& other);
    /// Variance of one sample, unbiased; zero with fewer than two samples.
    [[nodiscard]] Vec3d variance() const;
    [[nodiscard]] double luminanceVariance() const;

    friend bool operator==(const PixelStatistics&, const PixelStatistics&) = default;
};

/// What should not happen, counted instead of hidden.
struct Diagnostics {
    std::uint64_t nonFiniteSamples = 0; ///< samples whose radiance was NaN or infinite; they stay in the mean
    std::uint64_t negativeSamples = 0;
    std::uint64_t stackOverflows = 0; ///< traversal stacks that were too small
    std::uint64_t invalidIndices = 0;

    [[nodiscard]] bool clean() const {
        return nonFiniteSamples + negativeSamples + stackOverflows + invalidIndices == 0;
    }
    void merge(const Diagnostics& other);
};

struct Film {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<PixelStatistics> pixels; ///< row by row, top row first
    Diagnostics diagnostics;
    std::uint64_t rays = 0; ///< rays traced: camera, scattered and shadow rays

    Film() = default;
    Film(std::uint32_t filmWidth, std::uint32_t filmHeight)
        : width(filmWidth), height(filmHeight), pixels(std::size_t{filmWidth} * filmHeight) {}

    [[nodiscard]] PixelStatistics& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t{y} * width + x]; }
    [[nodiscard]] const PixelStatistics& at(std::uint32_t x, std::uint32_t y) const {
        return pixels[std::size_t{y} * width + x];
    }
    /// The least and most samples any pixel holds: they differ only in an interrupted render.
    [[nodiscard]] std::uint64_t minSampleCount() const;
    [[nodiscard]] std::uint64_t maxSampleCount() const;
};

} // namespace isolux
