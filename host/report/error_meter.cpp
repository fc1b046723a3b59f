#include "report/error_meter.h"

#include "core/error.h"
#include "report/bias.h"
#include "report/flip.h"
#include "report/image_view.h"
#include "report/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

void requireFinite(const ImageView& view, std::uint32_t width) {
    for (std::size_t pixel = 0; pixel < view.pixelCount(); ++pixel) {
        if (!isFinite(view.color(pixel)))
            throwBadInput("reference", fmt::format("pixel ({}, {}) is not finite", pixel % width, pixel / width));
    }
}

void requirePair(const Image& first, const Image& second) {
    if (first.width != second.width || first.height != second.height) {
        throwBadInput("reference", fmt::format("the two references differ in size: {} x {} and {} x {}", first.width,
                                               first.height, second.width, second.height));
    }
    if (shareSamples(first.metadata, second.metadata))
        throwBadInput("reference", "the two references share random numbers: their noise would count as error");
}

/// Of one image; 0 if it does not say.
double samplesPerPixel(const Image& image) {
    const auto channel = image.channel("samples.Y");
    if (!channel) return static_cast<double>(metadataUnsigned(image.metadata, "isolux/sampleCount").value_or(0));
    double sum = 0.0;
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) sum += image.value(pixel, *channel);
    return sum / static_cast<double>(image.pixelCount());
}

Image meanImage(const Image& size, const std::vector<ReferencePixel>& pixels) {
    Image image;
    image.width = size.width;
    image.height = size.height;
    image.channels = {"R", "G", "B"};
    image.values.reserve(3 * pixels.size());
    for (const ReferencePixel& pixel : pixels) {
        const Vec3d mean = pixel.mean();
        for (int c = 0; c < 3; ++c) image.values.push_back(static_cast<float>(mean[c]));
    }
    return image;
}

double meanOfChannels(const std::vector<ReferencePixel>& pixels) {
    double sum = 0.0;
    for (const ReferencePixel& pixel : pixels) sum += channelMean(pixel.mean());
    return sum / static_cast<double>(pixels.size());
}

double meanLuminance(const std::vector<ReferencePixel>& pixels) {
    double sum = 0.0;
    for (const ReferencePixel& pixel : pixels) sum += luminance(pixel.mean());
    return sum / static_cast<double>(pixels.size());
}

/// Pixels of a reference are independent: the variance of their mean is the mean of their variances over their number.
ReferenceQuality qualityOf(const std::vector<ReferencePixel>& pixels, double mse, double luminanceVariance) {
    ReferenceQuality quality;
    quality.mean = meanOfChannels(pixels);
    quality.mse = mse;
    quality.pixels = pixels.size();
    quality.relativeBiasError =
        std::sqrt(luminanceVariance / static_cast<double>(pixels.size())) / meanLuminance(pixels);
    return quality;
}

bool isFinite(const Film& film) {
    return std::all_of(film.pixels.begin(), film.pixels.end(),
                       [](const PixelStatistics& pixel) { return isolux::isFinite(pixel.mean); });
}

ErrorSample unknownErrors(const Film& film) {
    ErrorSample sample;
    for (double ErrorSample::*figure : {&ErrorSample::mse, &ErrorSample::relMse, &ErrorSample::relMseTrimmed,
                                        &ErrorSample::mae, &ErrorSample::bias, &ErrorSample::relativeRmse})
        sample.*figure = kUnknown;
    sample.estimate = estimatedRelativeRmse(film);
    return sample;
}

} // namespace

ErrorMeter::ErrorMeter(const Image& first, const Image& second) {
    requirePair(first, second);
    const ImageView a(first, "first reference");
    const ImageView b(second, "second reference");
    requireFinite(a, first.width);
    requireFinite(b, second.width);
    const bool known = a.varianceSource() != VarianceSource::none && b.varianceSource() != VarianceSource::none;
    double squares = 0.0;
    double luminanceSquares = 0.0;
    for (std::size_t i = 0; i < first.pixelCount(); ++i) {
        ReferencePixel& pixel = pixels_.emplace_back(ReferencePixel{a.color(i), b.color(i), Vec3d(0.0), 0.0});
        const Vec3d half = 0.5 * (pixel.first - pixel.second); // its square has the expectation Var((a + b)/2)
        pixel.luminanceVariance =
            known ? 0.25 * (a.pixelVariance(i, Quantity::luminance) + b.pixelVariance(i, Quantity::luminance))
                  : luminance(half) * luminance(half);
        squares += channelMean(half * half);
        luminanceSquares += luminance(half) * luminance(half);
    }
    const double count = static_cast<double>(pixels_.size());
    mean_ = meanImage(first, pixels_);
    quality_ = qualityOf(pixels_, squares / count, luminanceSquares / count);
    const double samples = samplesPerPixel(first);
    const double others = samplesPerPixel(second);
    quality_.samplesPerPixel = samples > 0.0 && others > 0.0 ? samples + others : 0.0;
}

ErrorMeter::ErrorMeter(const Image& reference) {
    const ImageView view(reference, "reference");
    requireFinite(view, reference.width);
    if (view.varianceSource() == VarianceSource::none) {
        throwBadInput("reference", "carries no variance (layers variance and samples, or se, with two samples a pixel "
                                   "at least): its noise cannot be told from error");
    }
    double variances = 0.0;
    double luminanceVariances = 0.0;
    for (std::size_t i = 0; i < reference.pixelCount(); ++i) {
        const Vec3d color = view.color(i);
        pixels_.push_back({color, color, view.pixelVariance(i), view.pixelVariance(i, Quantity::luminance)});
        variances += channelMean(pixels_.back().noise);
        luminanceVariances += pixels_.back().luminanceVariance;
    }
    const double count = static_cast<double>(pixels_.size());
    mean_ = meanImage(reference, pixels_);
    quality_ = qualityOf(pixels_, variances / count, luminanceVariances / count);
    quality_.samplesPerPixel = samplesPerPixel(reference);
}

ErrorSample ErrorMeter::measure(const Film& film, MeasureFlip measureFlip) const {
    if (film.width != mean_.width || film.height != mean_.height) {
        throwBadInput("reference",
                      fmt::format("is {} x {}, the image {} x {}", mean_.width, mean_.height, film.width, film.height));
    }
    ErrorSample sample = unknownErrors(film);
    if (!isFinite(film)) return sample;
    std::vector<double> relativeErrors;
    relativeErrors.reserve(pixels_.size());
    double squares = 0.0, absolutes = 0.0, light = 0.0, referenceLight = 0.0;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Vec3d& x = film.pixels[i].mean;
        const Vec3d r = pixels_[i].mean();
        const Vec3d squared = pixels_[i].squaredError(x);
        squares += channelMean(squared);
        relativeErrors.push_back(channelMean(squared / (r * r + kRelMseOffset)));
        absolutes += channelMean(glm::abs(x - r));
        light += luminance(x);
        referenceLight += luminance(r);
    }
    const double count = static_cast<double>(pixels_.size());
    sample.mse = squares / count;
    sample.relMse = mean(relativeErrors);
    sample.relMseTrimmed = trimmedMean(std::move(relativeErrors));
    sample.mae = absolutes / count;
    sample.bias = (light - referenceLight) / referenceLight;
    sample.relativeRmse = std::copysign(std::sqrt(std::abs(sample.mse)), sample.mse) / quality_.mean;
    if (measureFlip == MeasureFlip::yes) sample.flip = flip(imageFromFilm(film, {}), mean_).mean;
    return sample;
}

} // namespace isolux
