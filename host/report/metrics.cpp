#include "report/metrics.h"

#include "report/blocks.h"

#include <algorithm>
#include <cassert>

namespace isolux {
namespace {

PixelDefects findDefects(const ImageView& image) {
    PixelDefects defects;
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        const Vec3d color = image.color(pixel);
        defects.nan += std::isnan(color.x) || std::isnan(color.y) || std::isnan(color.z);
        defects.infinite += std::isinf(color.x) || std::isinf(color.y) || std::isinf(color.z);
        defects.negative += color.x < 0.0 || color.y < 0.0 || color.z < 0.0;
    }
    return defects;
}

ColorMean meanColor(const ImageView& image) {
    Vec3d sum(0.0);
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) sum += image.color(pixel);
    const Vec3d rgb = sum / static_cast<double>(image.pixelCount());
    return {rgb, luminance(rgb)};
}

double meanNoise(const ImageView& image) {
    if (image.varianceSource() == VarianceSource::none) return 0.0;
    double sum = 0.0;
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) sum += channelMean(image.pixelVariance(pixel));
    return sum / static_cast<double>(image.pixelCount());
}

void measureDifferences(ImageErrors& errors, const ImageView& image, const ImageView& reference) {
    double squares = 0.0;
    double absolutes = 0.0;
    double largest = 0.0;
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        const Vec3d difference = glm::abs(image.color(pixel) - reference.color(pixel));
        squares += channelMean(difference * difference);
        absolutes += channelMean(difference);
        largest = std::max(largest, maxComponent(difference));
    }
    const double count = static_cast<double>(image.pixelCount());
    errors.mse = squares / count;
    errors.rmse = std::sqrt(errors.mse);
    errors.relativeRmse = errors.rmse == 0.0 ? 0.0 : errors.rmse / channelMean(errors.referenceMean.rgb);
    errors.mae = absolutes / count;
    errors.maxAbs = largest;
}

std::uint64_t countLit(const ImageView& reference) {
    std::uint64_t lit = 0;
    for (std::size_t pixel = 0; pixel < reference.pixelCount(); ++pixel) lit += luminance(reference.color(pixel)) > 0.0;
    return lit;
}

struct BlockStatistics {
    double count = 0.0;
    double mean = 0.0;
    double squaredDeviation = 0.0;

    /// Welford 1962.
    void add(double value) {
        count += 1.0;
        const double before = value - mean;
        mean += before / count;
        squaredDeviation += before * (value - mean);
    }
};

} // namespace

std::vector<double> relMsePixels(const ImageView& image, const ImageView& reference) {
    std::vector<double> result(image.pixelCount());
    for (std::size_t pixel = 0; pixel < result.size(); ++pixel) {
        const Vec3d b = reference.color(pixel);
        const Vec3d difference = image.color(pixel) - b;
        result[pixel] = channelMean(difference * difference / (b * b + kRelMseOffset));
    }
    return result;
}

Interval stratifiedMean(std::span<const double> pixels, std::uint32_t width) {
    const BlockGrid blocks(width, pixels.size() / width);
    std::vector<BlockStatistics> statistics(blocks.count());
    for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) statistics[blocks.of(pixel)].add(pixels[pixel]);
    double variance = 0.0; // of the mean: sum of (n_k / N)^2 s_k^2 / n_k over the strata (Cochran 1977, 5.7)
    const double count = static_cast<double>(pixels.size());
    for (const BlockStatistics& block : statistics) {
        variance += block.count * block.squaredDeviation / (block.count - 1.0) / (count * count);
    }
    return studentInterval(mean(pixels), std::sqrt(variance), count - static_cast<double>(blocks.count()));
}

ImageErrors imageErrors(const ImageView& image, const ImageView& reference, std::uint32_t width) {
    assert(image.pixelCount() == reference.pixelCount());
    ImageErrors errors;
    errors.pixelCount = image.pixelCount();
    errors.litPixelCount = countLit(reference);
    errors.imageDefects = findDefects(image);
    errors.referenceDefects = findDefects(reference);
    errors.imageMean = meanColor(image);
    errors.referenceMean = meanColor(reference);
    if (!errors.imageDefects.finite() || !errors.referenceDefects.finite()) return errors;
    measureDifferences(errors, image, reference);
    const std::vector<double> relMse = relMsePixels(image, reference);
    errors.relMse = stratifiedMean(relMse, width);
    errors.relMseTrimmed = trimmedMean(relMse);
    if (image.varianceSource() != VarianceSource::none || reference.varianceSource() != VarianceSource::none) {
        errors.noiseMse = meanNoise(image) + meanNoise(reference);
    }
    return errors;
}

} // namespace isolux
