// Two images block by block: where the means of their luminance differ by more than noise explains, under one error
// budget for the whole image.
#pragma once

#include "film/image.h"
#include "report/image_view.h"
#include "report/statistics.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace isolux {

/// Blocks of about 16 x 16 pixels: equal in number of columns and rows but for rounding, so that none is a narrow
/// remainder.
class BlockGrid {
public:
    BlockGrid(std::size_t width, std::size_t height);

    [[nodiscard]] std::size_t count() const { return columns_ * rows_; }
    /// The block of a pixel; blocks and pixels are counted row by row.
    [[nodiscard]] std::size_t of(std::size_t pixel) const {
        return pixel / width_ * rows_ / height_ * columns_ + pixel % width_ * columns_ / width_;
    }
    /// The first column and row of pixels of a block.
    [[nodiscard]] std::size_t left(std::size_t block) const { return firstPixel(block % columns_, width_, columns_); }
    [[nodiscard]] std::size_t top(std::size_t block) const { return firstPixel(block / columns_, height_, rows_); }
    [[nodiscard]] std::size_t columns() const { return columns_; }
    [[nodiscard]] std::size_t rows() const { return rows_; }

private:
    /// The smallest p with p * parts / size >= part.
    [[nodiscard]] static std::size_t firstPixel(std::size_t part, std::size_t size, std::size_t parts) {
        return (part * size + parts - 1) / parts;
    }

    std::size_t width_, height_, columns_, rows_;
};

/// What one block, or the whole image, says of the difference image - reference of mean luminance.
struct BlockDifference {
    std::uint32_t x = 0; ///< first column of pixels
    std::uint32_t y = 0; ///< first row
    std::size_t pixelCount = 0;
    double difference = 0.0;
    double standardError = 0.0; ///< of the difference, both images' variances counted
    /// The part of the difference that float32 storage does not explain, over the standard error: normal if the images
    /// agree. Without a standard error it is 0 (equal) or infinite (different). NaN if a pixel is NaN or infinite.
    double z = 0.0;
};

/// The probability that images which agree are found to differ, over all blocks and the mean together.
inline constexpr double kFamilyError = 0.01;

struct BlockComparison {
    BlockGrid grid;
    std::vector<BlockDifference> blocks; ///< those with selected pixels, row by row
    BlockDifference whole;               ///< all selected pixels
    std::size_t excludedPixels = 0;      ///< left out by the mask
    std::size_t noisyBlocks = 0;         ///< with a standard error above 0; the others are held to equality
    std::size_t beyond95 = 0;            ///< noisy blocks with |z| > 1.96: 5 % of them if the images agree
    std::size_t beyondLimit = 0;         ///< blocks with |z| > zLimit, or NaN
    std::size_t worst = 0;               ///< index into `blocks` of the largest |z|; NaN counts as larger than any
    double limit = 0.0;                  ///< zLimit(noisyBlocks + 1, kFamilyError)

    /// Whether neither the mean nor any block is beyond the limit. Nothing selected is no agreement.
    [[nodiscard]] bool agree() const;
};

/// Nothing if neither image carries variance; one that does not is then taken as exact. `mask` selects pixels (those
/// not 0); without one all are. The images must have the same size; throws Error (bad input) otherwise. The variance of
/// luminance is variance.Y where there is one, or else an upper bound (see ImageView), which makes |z| too small rather
/// than too large. Both images' noise must be independent: shared random numbers make |z| too small.
[[nodiscard]] std::optional<BlockComparison> compareBlocks(const Image& image, const Image& reference,
                                                           std::span<const std::uint8_t> mask = {});

/// The |z| that the largest of `tests` two-sided normal tests exceeds with probability `familyError` (Sidak 1967:
/// exact for independent tests, conservative for correlated ones, as the mean is with its blocks).
[[nodiscard]] double zLimit(std::size_t tests, double familyError);

/// `z` of a BlockDifference for a single pixel.
[[nodiscard]] double pixelZ(const ImageView& image, const ImageView& reference, std::size_t pixel);

[[nodiscard]] nlohmann::ordered_json toJson(const BlockComparison& comparison);

} // namespace isolux
