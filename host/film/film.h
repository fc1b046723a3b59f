// What a render leaves: per-pixel mean, squared deviations and counts, accumulated in double from short batches.
#pragma once

#include "core/math.h"
#include "core/sample_sequence.h"

#include <array>
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
    std::uint64_t hitCount = 0;      ///< samples whose camera ray met a surface, or an environment that emits there
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

/// What the camera ray of one sample met first.
struct FirstHit {
    Vec3d albedo{0.0};        ///< base colour
    Vec3d normal{0.0};        ///< unit shading normal in the world, on the side of the camera
    double depth = 0.0;       ///< distance from the camera along its axis, not along the ray, in the world's unit
    std::uint32_t object = 0; ///< the scene's instances in order, then its spheres
};

/// The first hits of a pixel's samples. Sums, so that joining runs of samples is addition.
struct PixelAovs {
    struct Coverage {
        std::uint32_t object = 0;
        std::uint64_t samples = 0;

        friend bool operator==(const Coverage&, const Coverage&) = default;
    };
    Vec3d albedo{0.0};             ///< sum
    Vec3d normal{0.0};             ///< sum
    double depth = 0.0;            ///< sum
    std::vector<Coverage> objects; ///< how many samples met each object, by ascending object

    void add(const FirstHit& hit);
    void addCoverage(std::uint32_t object, std::uint64_t samples);
    void merge(const PixelAovs& other);
    /// How many samples met anything.
    [[nodiscard]] std::uint64_t hitCount() const;

    friend bool operator==(const PixelAovs&, const PixelAovs&) = default;
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

/// The sums of samples that were dealt to independently randomised replicates in turn. Samples of one replicate depend
/// on each other, so their scatter says nothing about the error of their mean; that of the replicates' means does.
struct PixelReplicates {
    static constexpr std::uint32_t kCount = kReplicates;
    std::array<Vec3d, kCount> sum{};
    std::array<std::uint32_t, kCount> sampleCount{};

    /// `sample` is the absolute index: it belongs to replicate sample mod kCount.
    void add(std::uint32_t sample, const Vec3d& radiance);
    /// Replaces the squared deviations of `pixel`, which holds the same samples, so that variance / samples is the
    /// variance of their mean: with n_r samples of mean m_r in each of R replicates, variance = sum n_r (m_r - m)^2 /
    /// (R - 1). Nothing changes while fewer than two replicates have samples.
    void refine(PixelStatistics& pixel) const;

    friend bool operator==(const PixelReplicates&, const PixelReplicates&) = default;
};

struct Film {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<PixelStatistics> pixels;     ///< row by row, top row first
    std::vector<PixelAovs> aovs;             ///< beside `pixels`, or empty if they were not asked for
    std::vector<PixelReplicates> replicates; ///< beside `pixels`, or empty if samples are independent
    Diagnostics diagnostics;
    std::uint64_t rays = 0;           ///< rays traced: camera, scattered and shadow rays
    std::uint64_t boxTests = 0;       ///< boxes that rays were tested against, if that was counted
    std::uint64_t primitiveTests = 0; ///< triangles and spheres, likewise

    Film() = default;
    Film(std::uint32_t filmWidth, std::uint32_t filmHeight)
        : width(filmWidth), height(filmHeight), pixels(std::size_t{filmWidth} * filmHeight) {}

    [[nodiscard]] PixelStatistics& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t{y} * width + x]; }
    [[nodiscard]] const PixelStatistics& at(std::uint32_t x, std::uint32_t y) const {
        return pixels[std::size_t{y} * width + x];
    }
    [[nodiscard]] PixelAovs& aovsAt(std::uint32_t x, std::uint32_t y) { return aovs[std::size_t{y} * width + x]; }
    void keepAovs() { aovs.resize(pixels.size()); }
    void keepReplicates() { replicates.resize(pixels.size()); }
    /// `PixelReplicates::refine` for every pixel; nothing without replicates. To be called when a pass is complete.
    void refineVariance();
    /// The least and most samples any pixel holds: they differ in interrupted and in adaptive renders.
    [[nodiscard]] std::uint64_t minSampleCount() const;
    [[nodiscard]] std::uint64_t maxSampleCount() const;
};

/// Relative RMSE of the image, estimated from its own variance: sqrt(mean of variance / samples) / mean, both means
/// over the pixels and R, G and B, which is what `compare` measures. NaN while a pixel has fewer than two samples, as
/// its variance is unknown.
[[nodiscard]] double estimatedRelativeRmse(const Film& film);

} // namespace isolux
