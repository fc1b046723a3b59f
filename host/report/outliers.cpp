#include "report/outliers.h"

#include "report/blocks.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace isolux {
namespace {

/// The luminances of an image, of which those around a pixel are asked for.
class LuminanceGrid {
public:
    LuminanceGrid(const ImageView& view, std::uint32_t width, std::uint32_t height)
        : values_(view.values(Quantity::luminance)), width_(width), height_(height) {}

    [[nodiscard]] std::size_t count() const { return values_.size(); }
    [[nodiscard]] double at(std::size_t pixel) const { return values_[pixel]; }

    /// The finite ones of the 3 x 3 pixels around a pixel, inside the image.
    [[nodiscard]] std::vector<double> around(std::size_t pixel) const {
        std::vector<double> found = neighbours(pixel);
        if (std::isfinite(at(pixel))) found.push_back(at(pixel));
        return found;
    }
    /// The same without the pixel itself.
    [[nodiscard]] std::vector<double> neighbours(std::size_t pixel) const {
        const std::size_t x = pixel % width_;
        const std::size_t y = pixel / width_;
        std::vector<double> found;
        for (std::size_t row = y - std::min<std::size_t>(y, 1); row <= std::min(y + 1, height_ - 1); ++row) {
            for (std::size_t column = x - std::min<std::size_t>(x, 1); column <= std::min(x + 1, width_ - 1);
                 ++column) {
                const double value = values_[row * width_ + column];
                if ((column != x || row != y) && std::isfinite(value)) found.push_back(value);
            }
        }
        return found;
    }

private:
    std::vector<double> values_;
    std::size_t width_, height_;
};

/// Of nothing 0; of an even number the upper one.
double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double largestOf(const std::vector<double>& values) {
    return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

bool isFirefly(const LuminanceGrid& image, const LuminanceGrid& other, std::size_t pixel) {
    const double value = image.at(pixel);
    if (!std::isfinite(value) || !(value > kFireflyFactor * std::max(0.0, other.at(pixel)))) return false;
    return value > kFireflyFactor * std::max(0.0, largestOf(other.around(pixel))) &&
           value > kFireflyFactor * std::max(0.0, median(image.neighbours(pixel)));
}

std::uint64_t countFireflies(const LuminanceGrid& image, const LuminanceGrid& other) {
    std::uint64_t fireflies = 0;
    for (std::size_t pixel = 0; pixel < image.count(); ++pixel) fireflies += isFirefly(image, other, pixel);
    return fireflies;
}

} // namespace

Outliers findOutliers(const Image& image, const Image& reference) {
    assert(image.pixelCount() == reference.pixelCount());
    const ImageView imageView(image, "image");
    const ImageView referenceView(reference, "reference");
    const LuminanceGrid imageGrid(imageView, image.width, image.height);
    const LuminanceGrid referenceGrid(referenceView, reference.width, reference.height);
    Outliers outliers;
    outliers.imageFireflies = countFireflies(imageGrid, referenceGrid);
    outliers.referenceFireflies = countFireflies(referenceGrid, imageGrid);
    if (imageView.varianceSource() == VarianceSource::none && referenceView.varianceSource() == VarianceSource::none)
        return outliers;
    outliers.beyondNoise = 0;
    outliers.zLimit = zLimit(image.pixelCount(), kFamilyError);
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel)
        *outliers.beyondNoise += std::abs(pixelZ(imageView, referenceView, pixel)) > outliers.zLimit;
    return outliers;
}

} // namespace isolux
