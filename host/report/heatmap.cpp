#include "report/heatmap.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace isolux {
namespace {

/// Share of the pixels whose value the colours tell apart, where the largest may be an outlier.
constexpr double kShownShare = 0.99;

/// A colour by lightness, chroma and hue in degrees, of Oklab (Ottosson 2020): equal steps look alike.
struct ControlPoint {
    double lightness;
    double chroma;
    double hue;
};

/// Lightness rises in equal steps from dark violet over magenta and orange to pale yellow.
constexpr std::array kSequential{ControlPoint{0.0500, 0.03, 285.0}, ControlPoint{0.2775, 0.14, 295.0},
                                 ControlPoint{0.5050, 0.19, 355.0}, ControlPoint{0.7325, 0.16, 50.0},
                                 ControlPoint{0.9600, 0.09, 105.0}};

/// Blue and red of equal lightness on either side of white.
constexpr std::array kDiverging{ControlPoint{0.35, 0.15, 262.0}, ControlPoint{0.66, 0.12, 250.0},
                                ControlPoint{0.97, 0.00, 0.0}, ControlPoint{0.66, 0.15, 38.0},
                                ControlPoint{0.35, 0.13, 25.0}};

Vec3d oklab(const ControlPoint& point) {
    const double angle = point.hue * kPi / 180.0;
    return {point.lightness, point.chroma * std::cos(angle), point.chroma * std::sin(angle)};
}

/// Linear Rec. 709 from Oklab (Ottosson 2020), clipped to what a display shows.
Vec3d rgbFromOklab(const Vec3d& lab) {
    const Vec3d root(lab.x + 0.3963377774 * lab.y + 0.2158037573 * lab.z,
                     lab.x - 0.1055613458 * lab.y - 0.0638541728 * lab.z,
                     lab.x - 0.0894841775 * lab.y - 1.2914855480 * lab.z);
    const Vec3d lms = root * root * root;
    const Vec3d rgb(4.0767416621 * lms.x - 3.3077115913 * lms.y + 0.2309699292 * lms.z,
                    -1.2684380046 * lms.x + 2.6097574011 * lms.y - 0.3413193965 * lms.z,
                    -0.0041960863 * lms.x - 0.7034186147 * lms.y + 1.7076147010 * lms.z);
    return glm::clamp(rgb, Vec3d(0.0), Vec3d(1.0));
}

std::vector<double> biasPixels(const ImageView& image, const ImageView& reference) {
    std::vector<double> values = image.values(Quantity::luminance);
    const std::vector<double> references = reference.values(Quantity::luminance);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = (values[i] - references[i]) / std::sqrt(references[i] * references[i] + kRelMseOffset);
    return values;
}

std::vector<double> blockPixels(const BlockComparison& comparison, std::size_t pixelCount) {
    std::vector<double> values(pixelCount);
    for (std::size_t pixel = 0; pixel < pixelCount; ++pixel)
        values[pixel] = comparison.blocks[comparison.grid.of(pixel)].z; // without a mask no block is missing
    return values;
}

/// The size that kShownShare of the finite values do not exceed; the largest if that is 0, and 1 if all are.
double shownSize(const std::vector<double>& values) {
    std::vector<double> sizes;
    for (const double value : values) {
        if (std::isfinite(value)) sizes.push_back(std::abs(value));
    }
    std::sort(sizes.begin(), sizes.end());
    if (sizes.empty() || sizes.back() == 0.0) return 1.0;
    const double shown = sizes[static_cast<std::size_t>(kShownShare * static_cast<double>(sizes.size() - 1))];
    return shown > 0.0 ? shown : sizes.back();
}

struct Shown {
    std::string name;
    Ramp ramp;
    double largest;
    std::vector<double> values;
};

Shown select(HeatmapQuantity quantity, const Image& image, const Image& reference, const ComparisonReport& report) {
    const ImageView imageView(image, "image");
    const ImageView referenceView(reference, "reference");
    switch (quantity) {
    case HeatmapQuantity::flip:
        if (!report.flip) throwBadInput("heatmap", "shows FLIP, which was not asked for");
        return {"FLIP", Ramp::sequential, 1.0, report.flip->errors};
    case HeatmapQuantity::blocks:
        if (!report.blocks) throwBadInput("heatmap", "neither image carries variance: blocks have no z values");
        return {"z of blocks", Ramp::diverging, report.blocks->limit, blockPixels(*report.blocks, image.pixelCount())};
    case HeatmapQuantity::relMse: {
        std::vector<double> values = relMsePixels(imageView, referenceView);
        return {"relMSE", Ramp::sequential, shownSize(values), std::move(values)};
    }
    case HeatmapQuantity::bias: break;
    }
    std::vector<double> values = biasPixels(imageView, referenceView);
    return {"bias of luminance", Ramp::diverging, shownSize(values), std::move(values)};
}

Image falseColors(const Shown& shown, const HeatmapRange& range, const Image& like) {
    Image image{like.width, like.height, {"R", "G", "B", "error.Y"}, {}, {}};
    image.values.reserve(4 * shown.values.size());
    for (const double value : shown.values) {
        const Vec3f color(rampColor(shown.ramp, (value - range.low) / (range.high - range.low)));
        image.values.insert(image.values.end(), {color.x, color.y, color.z, static_cast<float>(value)});
    }
    return image;
}

} // namespace

Vec3d rampColor(Ramp ramp, double t) {
    if (std::isnan(t)) return {0.0, 1.0, 0.0};
    const auto& points = ramp == Ramp::sequential ? kSequential : kDiverging;
    const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(points.size() - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(position), points.size() - 2);
    return rgbFromOklab(
        glm::mix(oklab(points[first]), oklab(points[first + 1]), position - static_cast<double>(first)));
}

Heatmap makeHeatmap(HeatmapQuantity quantity, const Image& image, const Image& reference,
                    const ComparisonReport& report) {
    const Shown shown = select(quantity, image, reference, report);
    const double low = shown.ramp == Ramp::diverging ? -shown.largest : 0.0;
    const HeatmapRange range{shown.name, low, shown.largest};
    return {range, falseColors(shown, range, image)};
}

} // namespace isolux
