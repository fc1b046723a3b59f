#include "report/blocks.h"

#include "core/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace isolux {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kBlockSize = 16;

/// Half a unit in the last place of a float32: the relative error of storing a value.
constexpr double kStorageError = 0x1p-24;

/// Sums over the pixels of a block.
struct BlockSum {
    std::size_t pixelCount = 0;
    double difference = 0.0;
    double variance = 0.0; ///< of `difference`
    double rounding = 0.0; ///< the most that float32 storage adds to `difference`

    void add(const BlockSum& other) {
        pixelCount += other.pixelCount;
        difference += other.difference;
        variance += other.variance;
        rounding += other.rounding;
    }
};

double countedVariance(const ImageView& view, std::size_t pixel) {
    return view.varianceSource() == VarianceSource::none ? 0.0 : view.pixelVariance(pixel, Quantity::luminance);
}

/// Each channel is stored within 2^-24 of itself, and so luminance within 2^-24 of that of the absolute values.
BlockSum pixelSum(const ImageView& image, const ImageView& reference, std::size_t pixel) {
    const Vec3d a = image.color(pixel);
    const Vec3d b = reference.color(pixel);
    return {1, luminance(a) - luminance(b), countedVariance(image, pixel) + countedVariance(reference, pixel),
            kStorageError * (luminance(Vec3d(glm::abs(a))) + luminance(Vec3d(glm::abs(b))))};
}

double standardise(double difference, double rounding, double standardError) {
    if (!std::isfinite(difference) || !std::isfinite(standardError)) return std::numeric_limits<double>::quiet_NaN();
    const double unexplained = std::max(0.0, std::abs(difference) - rounding);
    if (unexplained == 0.0) return 0.0;
    return std::copysign(unexplained / standardError, difference);
}

BlockDifference describe(const BlockSum& sum, std::size_t x, std::size_t y) {
    const double count = static_cast<double>(sum.pixelCount);
    BlockDifference block{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),   sum.pixelCount,
                          sum.difference / count,        std::sqrt(sum.variance) / count, 0.0};
    block.z = standardise(block.difference, sum.rounding / count, block.standardError);
    return block;
}

bool within(double z, double limit) { return std::abs(z) <= limit; }

void judge(BlockComparison& comparison) {
    const double limit95 = normalQuantile(0.5 + 0.5 * kConfidence);
    for (const BlockDifference& block : comparison.blocks) {
        if (block.standardError == 0.0) continue;
        ++comparison.noisyBlocks;
        comparison.beyond95 += !within(block.z, limit95);
    }
    comparison.limit = zLimit(comparison.noisyBlocks + 1, kFamilyError);
    for (std::size_t i = 0; i < comparison.blocks.size(); ++i) {
        const double z = comparison.blocks[i].z;
        comparison.beyondLimit += !within(z, comparison.limit);
        const double worst = comparison.blocks[comparison.worst].z;
        if (!std::isnan(worst) && !within(z, std::abs(worst))) comparison.worst = i;
    }
}

ordered_json blockJson(const BlockDifference& block) {
    return {{"x", block.x},
            {"y", block.y},
            {"pixels", block.pixelCount},
            {"difference", block.difference},
            {"standardError", block.standardError},
            {"z", block.z}};
}

} // namespace

BlockGrid::BlockGrid(std::size_t width, std::size_t height)
    : width_(width), height_(height), columns_(std::max<std::size_t>(1, width / kBlockSize)),
      rows_(std::max<std::size_t>(1, height / kBlockSize)) {}

bool BlockComparison::agree() const { return whole.pixelCount != 0 && beyondLimit == 0 && within(whole.z, limit); }

std::optional<BlockComparison> compareBlocks(const Image& image, const Image& reference,
                                             std::span<const std::uint8_t> mask) {
    const ImageView imageView(image, "image");
    const ImageView referenceView(reference, "reference");
    if (image.width != reference.width || image.height != reference.height)
        throwBadInput("compare", "the images differ in size");
    assert(mask.empty() || mask.size() == image.pixelCount());
    if (imageView.varianceSource() == VarianceSource::none && referenceView.varianceSource() == VarianceSource::none)
        return std::nullopt;
    BlockComparison comparison{BlockGrid(image.width, image.height), {}, {}};
    std::vector<BlockSum> sums(comparison.grid.count());
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        if (!mask.empty() && mask[pixel] == 0)
            ++comparison.excludedPixels;
        else
            sums[comparison.grid.of(pixel)].add(pixelSum(imageView, referenceView, pixel));
    }
    BlockSum whole;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (sums[i].pixelCount == 0) continue;
        comparison.blocks.push_back(describe(sums[i], comparison.grid.left(i), comparison.grid.top(i)));
        whole.add(sums[i]);
    }
    if (whole.pixelCount != 0) comparison.whole = describe(whole, 0, 0);
    judge(comparison);
    return comparison;
}

double zLimit(std::size_t tests, double familyError) {
    const double perTest = -std::expm1(std::log1p(-familyError) / static_cast<double>(tests));
    return -normalQuantile(0.5 * perTest);
}

double pixelZ(const ImageView& image, const ImageView& reference, std::size_t pixel) {
    return describe(pixelSum(image, reference, pixel), 0, 0).z;
}

ordered_json toJson(const BlockComparison& comparison) {
    return {{"blocks", comparison.blocks.size()},
            {"columns", comparison.grid.columns()},
            {"rows", comparison.grid.rows()},
            {"noisyBlocks", comparison.noisyBlocks},
            {"excludedPixels", comparison.excludedPixels},
            {"beyond95", comparison.beyond95},
            {"beyondLimit", comparison.beyondLimit},
            {"familyError", kFamilyError},
            {"zLimit", comparison.limit},
            {"whole", blockJson(comparison.whole)},
            {"worst", comparison.blocks.empty() ? ordered_json() : blockJson(comparison.blocks[comparison.worst])},
            {"agree", comparison.agree()}};
}

} // namespace isolux
