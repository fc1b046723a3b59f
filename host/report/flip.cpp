#include "report/flip.h"

#include "core/error.h"
#include "report/filter.h"
#include "report/image_view.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

using Colors = std::vector<Vec3d>;

/// Names of constants, values and stages follow Andersson et al. 2020.
constexpr double kQc = 0.7;          ///< exponent of the colour difference
constexpr double kPc = 0.4;          ///< share of the largest colour difference ...
constexpr double kPt = 0.95;         ///< ... that is mapped to this error
constexpr double kQf = 0.5;          ///< exponent of the feature difference
constexpr double kEdgeWidth = 0.082; ///< degrees: width of the edges the eye is most sensitive to

template <typename Function> void forEachIndex(std::size_t count, const Function& function) {
    tbb::parallel_for(std::size_t{0}, count, function);
}

// --- Colour spaces ---

/// XYZ of a chromaticity at Y = 1.
Vec3d xyzOfChromaticity(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

/// The colour spaces of FLIP: Rec. 709 primaries and D65 (CIE 1931 xy of the white point to five digits).
struct ColorSpaces {
    Vec3d white = xyzOfChromaticity(0.31271, 0.32902);
    Mat3d xyzFromRgb;
    Mat3d rgbFromXyz;

    ColorSpaces() {
        const Mat3d primaries(xyzOfChromaticity(0.64, 0.33), xyzOfChromaticity(0.30, 0.60),
                              xyzOfChromaticity(0.15, 0.06));
        const Vec3d scale = glm::inverse(primaries) * white; // so that (1, 1, 1) is white
        xyzFromRgb = Mat3d(primaries[0] * scale.x, primaries[1] * scale.y, primaries[2] * scale.z);
        rgbFromXyz = glm::inverse(xyzFromRgb);
    }
};

const ColorSpaces& colorSpaces() {
    static const ColorSpaces spaces;
    return spaces;
}

/// YCxCz, opponent and linear in XYZ (Flohr et al. 1993): luminance, red-green, blue-yellow.
Vec3d opponentFromRgb(const Vec3d& rgb) {
    const Vec3d xyz = colorSpaces().xyzFromRgb * rgb / colorSpaces().white;
    return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

Vec3d rgbFromOpponent(const Vec3d& opponent) {
    const double y = (opponent.x + 16.0) / 116.0;
    const Vec3d xyz(y + opponent.y / 500.0, y, y - opponent.z / 200.0);
    return colorSpaces().rgbFromXyz * (xyz * colorSpaces().white);
}

/// The cube root of CIELAB with its linear part (CIE 15:2004).
double labRoot(double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

/// CIELAB with chroma scaled by lightness: dark colours look less colourful (Hunt effect; section 4.1.2).
Vec3d huntLabFromRgb(const Vec3d& rgb) {
    const Vec3d xyz = colorSpaces().xyzFromRgb * rgb / colorSpaces().white;
    const double lightness = 116.0 * labRoot(xyz.y) - 16.0;
    const double a = 500.0 * (labRoot(xyz.x) - labRoot(xyz.y));
    const double b = 200.0 * (labRoot(xyz.y) - labRoot(xyz.z));
    return {lightness, 0.01 * lightness * a, 0.01 * lightness * b};
}

/// HyAB (Abasi et al. 2020): city-block in lightness, Euclidean in chroma.
double hyab(const Vec3d& a, const Vec3d& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// --- Filters ---

/// The filters for a number of pixels per degree.
struct FlipFilters {
    GaussianSum luminance; ///< contrast sensitivity of the three opponent channels (section 4.1.1, table 1)
    GaussianSum redGreen;
    GaussianSum blueYellow;
    Kernel smooth; ///< Gaussian and its derivatives (section 4.2)
    Kernel edge;
    Kernel point;

    explicit FlipFilters(double pixelsPerDegree) {
        constexpr double kWidest = 0.04; // the largest b below: all channels share its radius
        const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidest / (2.0 * kPi * kPi)) * pixelsPerDegree));
        luminance = contrastSensitivity({{{1.0, 0.0047}}}, radius, pixelsPerDegree);
        redGreen = contrastSensitivity({{{1.0, 0.0053}}}, radius, pixelsPerDegree);
        blueYellow = contrastSensitivity({{{34.1, 0.04}, {13.5, 0.025}}}, radius, pixelsPerDegree);
        const double deviation = 0.5 * kEdgeWidth * pixelsPerDegree;
        smooth = gaussianKernel(deviation);
        edge = gaussianSlopeKernel(deviation);
        point = gaussianCurvatureKernel(deviation);
    }
};

/// What the eye still resolves of a colour image at the viewing distance, as Hunt-adjusted CIELAB.
Colors filterColors(const Colors& colors, const GridSize& size, const FlipFilters& filters) {
    std::array<Plane, 3> planes{Plane(colors.size()), Plane(colors.size()), Plane(colors.size())};
    forEachIndex(colors.size(), [&](std::size_t pixel) {
        const Vec3d opponent = opponentFromRgb(colors[pixel]);
        for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)][pixel] = opponent[c];
    });
    planes = {convolve(planes[0], size, filters.luminance), convolve(planes[1], size, filters.redGreen),
              convolve(planes[2], size, filters.blueYellow)};
    Colors result(colors.size());
    forEachIndex(colors.size(), [&](std::size_t pixel) {
        const Vec3d rgb = rgbFromOpponent({planes[0][pixel], planes[1][pixel], planes[2][pixel]});
        result[pixel] = huntLabFromRgb(glm::clamp(rgb, Vec3d(0.0), Vec3d(1.0)));
    });
    return result;
}

// --- Errors ---

/// Compresses large differences: up to kPc of the largest one, between the two colours of the display that differ most
/// (green and blue), linearly onto [0, kPt] (section 4.1.3).
double colorError(const Vec3d& a, const Vec3d& b) {
    static const double largest = std::pow(hyab(huntLabFromRgb({0, 1, 0}), huntLabFromRgb({0, 0, 1})), kQc);
    const double difference = std::pow(hyab(a, b), kQc);
    const double knee = kPc * largest;
    if (difference < knee) return kPt / knee * difference;
    return kPt + (difference - knee) / (largest - knee) * (1.0 - kPt);
}

/// The strengths of edges and of points in each pixel.
struct Features {
    Plane edges;
    Plane points;
};

Plane gradientLength(const Plane& plane, const GridSize& size, const Kernel& derivative, const Kernel& smooth) {
    const Plane x = convolve(plane, size, derivative, smooth);
    Plane length = convolve(plane, size, smooth, derivative);
    forEachIndex(length.size(), [&](std::size_t pixel) { length[pixel] = std::hypot(x[pixel], length[pixel]); });
    return length;
}

Features findFeatures(const Colors& colors, const GridSize& size, const FlipFilters& filters) {
    Plane luminances(colors.size());
    forEachIndex(colors.size(), [&](std::size_t pixel) {
        luminances[pixel] = (opponentFromRgb(colors[pixel]).x + 16.0) / 116.0; // achromatic, from 0 to 1
    });
    return {gradientLength(luminances, size, filters.edge, filters.smooth),
            gradientLength(luminances, size, filters.point, filters.smooth)};
}

/// LDR-FLIP of two images with values from 0 to 1; NaN in, NaN out.
Plane lowRangeErrors(const Colors& image, const Colors& reference, const GridSize& size, const FlipFilters& filters) {
    const Colors colors = filterColors(image, size, filters);
    const Colors referenceColors = filterColors(reference, size, filters);
    const Features features = findFeatures(image, size, filters);
    const Features referenceFeatures = findFeatures(reference, size, filters);
    Plane errors(image.size());
    forEachIndex(errors.size(), [&](std::size_t pixel) {
        const double edges = std::abs(features.edges[pixel] - referenceFeatures.edges[pixel]);
        const double points = std::abs(features.points[pixel] - referenceFeatures.points[pixel]);
        const double feature = std::pow(std::max(edges, points) / std::sqrt(2.0), kQf);
        errors[pixel] = std::pow(colorError(colors[pixel], referenceColors[pixel]), 1.0 - feature);
    });
    return errors;
}

// --- High dynamic range ---

/// (n2 x^2 + n1 x) / (d2 x^2 + d1 x + d0): the ACES fit of Narkowicz 2015 with the exposure of 0.6 folded in, as in
/// Andersson et al. 2021.
struct ToneCurve {
    double n2 = 0.6 * 0.6 * 2.51;
    double n1 = 0.6 * 0.03;
    double d2 = 0.6 * 0.6 * 2.43;
    double d1 = 0.6 * 0.59;
    double d0 = 0.14;

    [[nodiscard]] Vec3d operator()(const Vec3d& x) const {
        return glm::clamp((x * (n2 * x + n1)) / (x * (d2 * x + d1) + d0), Vec3d(0.0), Vec3d(1.0));
    }
    /// The positive x that is mapped to `value`.
    [[nodiscard]] double inverse(double value) const {
        const double a = n2 - value * d2;
        const double b = n1 - value * d1;
        return (-b + std::sqrt(b * b + 4.0 * a * value * d0)) / (2.0 * a);
    }
};

Colors atExposure(const Colors& colors, double stops) {
    const ToneCurve curve;
    const double scale = std::exp2(stops);
    Colors result(colors.size());
    forEachIndex(colors.size(), [&](std::size_t pixel) { result[pixel] = curve(scale * colors[pixel]); });
    return result;
}

Plane highRangeErrors(const Colors& image, const Colors& reference, const GridSize& size, const FlipFilters& filters,
                      const ExposureRange& exposures) {
    Plane worst(image.size(), 0.0);
    const double step = (exposures.stop - exposures.start) / static_cast<double>(exposures.count - 1);
    for (std::size_t i = 0; i < exposures.count; ++i) {
        const double stops = exposures.start + static_cast<double>(i) * step;
        const Plane errors = lowRangeErrors(atExposure(image, stops), atExposure(reference, stops), size, filters);
        for (std::size_t pixel = 0; pixel < worst.size(); ++pixel) {
            if (!(errors[pixel] <= worst[pixel])) worst[pixel] = errors[pixel]; // NaN stays
        }
    }
    return worst;
}

/// The colours that are compared: none below 0, none above `largest`, NaN where any channel is NaN or infinite.
Colors preparedColors(const ImageView& view, double largest) {
    Colors colors(view.pixelCount());
    for (std::size_t pixel = 0; pixel < colors.size(); ++pixel) {
        const Vec3d color = view.color(pixel);
        colors[pixel] = isFinite(color) ? glm::clamp(color, Vec3d(0.0), Vec3d(largest))
                                        : Vec3d(std::numeric_limits<double>::quiet_NaN());
    }
    return colors;
}

void summarise(FlipResult& result) {
    double sum = 0.0;
    for (const double error : result.errors) {
        sum += error;
        if (!(error <= result.largest)) result.largest = error;
    }
    result.mean = sum / static_cast<double>(result.errors.size());
    if (std::isnan(result.mean)) result.largest = result.mean;
}

} // namespace

ExposureRange automaticExposures(std::span<const Vec3d> reference) {
    constexpr double kDarkest = std::numeric_limits<float>::epsilon();
    constexpr double kShown = 0.85; // tone-mapped value the luminances are brought to
    std::vector<double> luminances;
    for (const Vec3d& color : reference) {
        if (isFinite(color)) luminances.push_back(luminance(color));
    }
    if (luminances.empty()) luminances.push_back(0.0);
    const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
    std::nth_element(luminances.begin(), middle, luminances.end());
    const double median = std::max(*middle, kDarkest);
    const double brightest = std::max(*std::max_element(middle, luminances.end()), kDarkest);
    const double shown = ToneCurve{}.inverse(kShown);
    ExposureRange range{std::log2(shown / brightest), std::log2(shown / median), 0};
    range.count = static_cast<std::size_t>(std::max(2.0, std::ceil(range.stop - range.start)));
    return range;
}

FlipResult flip(const Image& image, const Image& reference, const FlipOptions& options) {
    const ImageView imageView(image, "image");
    const ImageView referenceView(reference, "reference");
    if (image.width != reference.width || image.height != reference.height)
        throwBadInput("FLIP", "the images differ in size");
    const GridSize size{image.width, image.height};
    const FlipFilters filters(options.pixelsPerDegree);
    const double largest = options.range == DynamicRange::low ? 1.0 : std::numeric_limits<double>::max();
    const Colors colors = preparedColors(imageView, largest);
    const Colors referenceColors = preparedColors(referenceView, largest);
    FlipResult result;
    result.options = options;
    if (options.range == DynamicRange::low) {
        result.errors = lowRangeErrors(colors, referenceColors, size, filters);
    } else {
        result.exposures = automaticExposures(referenceColors);
        result.errors = highRangeErrors(colors, referenceColors, size, filters, *result.exposures);
    }
    summarise(result);
    return result;
}

} // namespace isolux
