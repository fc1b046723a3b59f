#include "report/paired.h"

#include "core/error.h"
#include "report/bias.h"
#include "report/format.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace isolux {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kWorstCount = 10;
constexpr std::size_t kWorstPrinted = 3;

void requireComparable(const Film& film, const Film& reference) {
    if (film.width != reference.width || film.height != reference.height) {
        throwBadInput("paired comparison", "the films differ in size");
    }
    const bool sameCounts = std::equal(film.pixels.begin(), film.pixels.end(), reference.pixels.begin(),
                                       [](const auto& a, const auto& b) { return a.sampleCount == b.sampleCount; });
    if (!sameCounts) throwBadInput("paired comparison", "the films hold different numbers of samples");
}

bool isLit(const PairedPixel& pixel) { return pixel.value != Vec3d(0.0) || pixel.reference != Vec3d(0.0); }

/// Whether the films in single precision err in a pixel so much that rounding explains the difference there.
bool isRounding(double difference, const PixelStatistics& reference, std::span<const Film> singles, std::size_t index) {
    const auto onBranch = [&](const Film& single) {
        const std::uint64_t signature = single.pixels[index].pathSignature;
        return signature == 0 || signature == reference.pathSignature;
    };
    const auto errsAsMuch = [&](const Film& single) {
        return difference <= kRoundingFactor * relativeDifference(single.pixels[index].mean, reference.mean);
    };
    if (std::ranges::any_of(singles, [&](const Film& single) { return onBranch(single) && errsAsMuch(single); }))
        return true;
    return singles.size() >= kUntoldAfter && std::ranges::none_of(singles, onBranch) &&
           std::ranges::any_of(singles, errsAsMuch);
}

Explanation explain(const PairedPixel& pixel, const PixelStatistics& reference, const PairedOptions& options,
                    std::size_t index) {
    if (pixel.relativeDifference <= options.tolerance) return Explanation::withinTolerance;
    if (pixel.signature == Signature::different) return Explanation::otherBranch;
    return isRounding(pixel.relativeDifference, reference, options.singlePrecision, index) ? Explanation::rounding
                                                                                           : Explanation::none;
}

PairedPixel makePixel(const Film& film, const Film& reference, const PairedOptions& options, std::size_t index) {
    const PixelStatistics& a = film.pixels[index];
    const PixelStatistics& b = reference.pixels[index];
    PairedPixel pixel;
    pixel.x = static_cast<std::uint32_t>(index % film.width);
    pixel.y = static_cast<std::uint32_t>(index / film.width);
    pixel.value = a.mean;
    pixel.reference = b.mean;
    pixel.relativeDifference = relativeDifference(a.mean, b.mean);
    pixel.signature = a.pathSignature == b.pathSignature ? Signature::same : Signature::different;
    pixel.explanation = explain(pixel, b, options, index);
    return pixel;
}

std::vector<PairedPixel> litPixels(const Film& film, const Film& reference, const PairedOptions& options) {
    std::vector<PairedPixel> pixels;
    for (std::size_t index = 0; index < film.pixels.size(); ++index) {
        const PairedPixel pixel = makePixel(film, reference, options, index);
        if (isLit(pixel)) pixels.push_back(pixel);
    }
    return pixels;
}

void count(PairedDifferences& result, const PairedPixel& pixel) {
    ++result.litPixels;
    result.differentSignatures += pixel.signature == Signature::different;
    switch (pixel.explanation) {
    case Explanation::withinTolerance: ++result.withinTolerance; break;
    case Explanation::otherBranch: ++result.otherBranch; break;
    case Explanation::rounding: ++result.rounding; break;
    case Explanation::none: ++result.unexplained; break;
    }
}

/// The smallest value that at least the given share of the values does not exceed (nearest rank); 0 of nothing.
double percentile(const std::vector<PairedPixel>& ascending, double share) {
    if (ascending.empty()) return 0.0;
    const double rank = std::ceil(share * static_cast<double>(ascending.size()));
    const std::size_t index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
    return ascending[std::min(index, ascending.size() - 1)].relativeDifference;
}

std::vector<PairedPixel> worstPixels(std::vector<PairedPixel> pixels) {
    const auto explained = [&](const PairedPixel& p) { return p.explanation != Explanation::none; };
    const auto worse = [&](const PairedPixel& a, const PairedPixel& b) {
        return std::tuple(explained(a), -a.relativeDifference, a.y, a.x) <
               std::tuple(explained(b), -b.relativeDifference, b.y, b.x);
    };
    const std::size_t kept = std::min(kWorstCount, pixels.size());
    std::partial_sort(pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(kept), pixels.end(), worse);
    pixels.resize(kept);
    std::erase_if(pixels, [](const PairedPixel& p) { return p.relativeDifference == 0.0; });
    return pixels;
}

std::vector<double> luminances(const Film& film) {
    std::vector<double> values;
    values.reserve(film.pixels.size());
    for (const PixelStatistics& pixel : film.pixels) values.push_back(luminance(pixel.mean));
    return values;
}

const char* signatureText(Signature signature) { return signature == Signature::same ? "same paths" : "other paths"; }

std::string pixelText(const PairedPixel& pixel) {
    return fmt::format("({}, {})  {} against {}, {} apart, {}", pixel.x, pixel.y, formatColor(pixel.value),
                       formatColor(pixel.reference), formatNumber(pixel.relativeDifference),
                       signatureText(pixel.signature));
}

ordered_json pixelJson(const PairedPixel& pixel) {
    return {{"x", pixel.x},
            {"y", pixel.y},
            {"value", toJson(pixel.value)},
            {"reference", toJson(pixel.reference)},
            {"relativeDifference", pixel.relativeDifference},
            {"sameSignature", pixel.signature == Signature::same}};
}

} // namespace

double relativeDifference(const Vec3d& value, const Vec3d& reference) {
    const double floor = std::abs(luminance(reference));
    double worst = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double difference = std::abs(value[c] - reference[c]);
        if (difference == 0.0) continue;
        const double relative = difference / std::max(std::abs(reference[c]), floor);
        if (!std::isfinite(relative)) return std::numeric_limits<double>::infinity();
        worst = std::max(worst, relative);
    }
    return worst;
}

PairedDifferences pairedDifferences(const Film& film, const Film& reference, const PairedOptions& options) {
    requireComparable(film, reference);
    for (const Film& single : options.singlePrecision) requireComparable(single, reference);
    PairedDifferences result;
    result.tolerance = options.tolerance;
    result.pixelCount = film.pixels.size();
    std::vector<PairedPixel> pixels = litPixels(film, reference, options);
    for (const PairedPixel& pixel : pixels) count(result, pixel);
    result.worst = worstPixels(pixels);
    std::sort(pixels.begin(), pixels.end(),
              [](const auto& a, const auto& b) { return a.relativeDifference < b.relativeDifference; });
    result.medianDifference = percentile(pixels, 0.5);
    result.difference999 = percentile(pixels, 0.999);
    result.luminanceBias = pairedRelativeBias(luminances(film), luminances(reference));
    return result;
}

std::string toText(const PairedDifferences& differences) {
    std::string text = formatLine("lit pixels", fmt::format("{} of {}, {} with other paths", differences.litPixels,
                                                            differences.pixelCount, differences.differentSignatures));
    text += formatLine("within tolerance", fmt::format("{}  (relative {})", differences.withinTolerance,
                                                       formatNumber(differences.tolerance)));
    text += formatLine("another branch", fmt::format("{}", differences.otherBranch));
    text += formatLine("rounding",
                       fmt::format("{}  (single precision errs there on the CPU as well)", differences.rounding));
    text += formatLine("unexplained", fmt::format("{}", differences.unexplained));
    text += formatLine("difference",
                       fmt::format("median {}, 99.9th percentile {}", formatNumber(differences.medianDifference),
                                   formatNumber(differences.difference999)));
    text += formatLine("relative bias",
                       fmt::format("{}  luminance, paired", formatPercentInterval(differences.luminanceBias)));
    for (std::size_t i = 0; i < std::min(kWorstPrinted, differences.worst.size()); ++i)
        text += formatLine("worst pixel", pixelText(differences.worst[i]));
    return text;
}

ordered_json toJson(const PairedDifferences& differences) {
    ordered_json worst = ordered_json::array();
    for (const PairedPixel& pixel : differences.worst) worst.push_back(pixelJson(pixel));
    return {{"schema", kReportSchema},
            {"report", "paired"},
            {"tolerance", differences.tolerance},
            {"pixels", differences.pixelCount},
            {"litPixels", differences.litPixels},
            {"differentSignatures", differences.differentSignatures},
            {"withinTolerance", differences.withinTolerance},
            {"otherBranch", differences.otherBranch},
            {"rounding", differences.rounding},
            {"unexplained", differences.unexplained},
            {"medianDifference", differences.medianDifference},
            {"difference999", differences.difference999},
            {"relativeBias", toJson(differences.luminanceBias)},
            {"worst", worst}};
}

} // namespace isolux
