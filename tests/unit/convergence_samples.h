// Synthetic samples of convergence whose truth is known: pixels that are means of nested samples, as a renderer's are.
#pragma once

#include "report/convergence.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace isolux::convergence_test {

/// A variant whose pixels are gamma variables of mean 1: MSE is variance / n + bias^2, and time `secondsPerSample` n.
struct Synthetic {
    std::string name = "plain";
    double variance = 1.0; ///< of a sample
    double bias = 0.0;     ///< added to every pixel
    double secondsPerSample = 0.01;
    std::uint64_t firstSeed = 0;
    std::uint32_t seeds = 16;
    std::uint32_t checkpoints = 8; ///< at 1, 2, 4, ... samples
    std::uint32_t pixels = 64;
};

inline ErrorSample sampleAt(const Synthetic& variant, std::uint64_t seed, std::uint32_t checkpoint) {
    ErrorSample sample;
    sample.variant = variant.name;
    sample.seed = seed;
    sample.checkpoint = checkpoint;
    sample.samplesPerPixel = std::exp2(checkpoint);
    sample.wallSeconds = variant.secondsPerSample * sample.samplesPerPixel;
    return sample;
}

/// A sum of k gamma variables of shape a has shape k a, so that checkpoints need one draw a pixel.
inline std::vector<ErrorSample> renderSynthetic(const Synthetic& variant, std::mt19937_64& random) {
    std::vector<ErrorSample> samples;
    std::normal_distribution<double> jitter(0.0, 0.02);
    for (std::uint32_t s = 0; s < variant.seeds; ++s) {
        std::vector<double> sums(variant.pixels, 0.0);
        double taken = 0.0;
        for (std::uint32_t checkpoint = 0; checkpoint < variant.checkpoints; ++checkpoint) {
            ErrorSample sample = sampleAt(variant, variant.firstSeed + s, checkpoint);
            std::gamma_distribution<double> batch((sample.samplesPerPixel - taken) / variant.variance,
                                                  variant.variance);
            taken = sample.samplesPerPixel;
            for (double& sum : sums) {
                sum += batch(random);
                const double error = sum / taken + variant.bias - 1.0;
                sample.mse += error * error / variant.pixels;
            }
            sample.wallSeconds *= std::exp(jitter(random));
            sample.relativeRmse = std::sqrt(sample.mse);
            samples.push_back(sample);
        }
    }
    return samples;
}

/// Samples that follow the law exactly, every seed alike: MSE = factor n^-exponent + floor.
inline std::vector<ErrorSample> exactSamples(const Synthetic& variant, double exponent, double floor) {
    std::vector<ErrorSample> samples;
    for (std::uint32_t s = 0; s < variant.seeds; ++s) {
        for (std::uint32_t checkpoint = 0; checkpoint < variant.checkpoints; ++checkpoint) {
            ErrorSample sample = sampleAt(variant, variant.firstSeed + s, checkpoint);
            sample.mse = variant.variance * std::pow(sample.samplesPerPixel, -exponent) + floor;
            sample.relativeRmse = std::sqrt(sample.mse);
            samples.push_back(sample);
        }
    }
    return samples;
}

/// The mean of a reference of 1, free of noise.
inline ReferenceQuality exactReference() {
    ReferenceQuality reference;
    reference.mean = 1.0;
    return reference;
}

} // namespace isolux::convergence_test
