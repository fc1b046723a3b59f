#include "report/bias.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>

namespace isolux {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// difference / reference, where two black images do not differ and a black reference makes any other image infinitely
/// too bright.
double relativeTo(double reference, double difference) { return difference == 0.0 ? 0.0 : difference / reference; }

BiasMethod chooseMethod(const ImageView& image, const ImageView& reference) {
    const bool imageKnown = image.varianceSource() != VarianceSource::none;
    const bool referenceKnown = reference.varianceSource() != VarianceSource::none;
    if (imageKnown && referenceKnown) return BiasMethod::independent;
    if (imageKnown) return BiasMethod::imageOnly;
    return referenceKnown ? BiasMethod::referenceOnly : BiasMethod::none;
}

/// The variance of an image's mean as far as the method counts it.
double countedVariance(const ImageView& view, Quantity quantity) {
    return view.varianceSource() == VarianceSource::none ? 0.0 : view.varianceOfMean(quantity);
}

/// Delta method for a ratio of independent means a/b: Var = (Var(a) + (a/b)^2 Var(b)) / b^2.
Interval independentRelativeBias(const ImageView& image, const ImageView& reference, Quantity quantity,
                                 BiasMethod method) {
    const double a = mean(image.values(quantity));
    const double b = mean(reference.values(quantity));
    const double estimate = relativeTo(b, a - b);
    if (method == BiasMethod::none || !std::isfinite(estimate)) return {kUnknown, estimate, kUnknown};
    const double ratio = 1.0 + estimate;
    const double deviation =
        std::sqrt(countedVariance(image, quantity) + ratio * ratio * countedVariance(reference, quantity));
    return normalInterval(estimate, relativeTo(std::abs(b), deviation));
}

Interval biasOf(const ImageView& image, const ImageView& reference, Quantity quantity, BiasMethod method) {
    if (method == BiasMethod::paired) return pairedRelativeBias(image.values(quantity), reference.values(quantity));
    return independentRelativeBias(image, reference, quantity, method);
}

struct SampleRange {
    std::uint64_t first;
    std::uint64_t count;
};

std::optional<SampleRange> sampleRange(const Metadata& metadata) {
    const auto count = metadataUnsigned(metadata, "isolux/sampleCount");
    if (!count) return std::nullopt;
    return SampleRange{metadataUnsigned(metadata, "isolux/sampleFirst").value_or(0), *count};
}

bool overlap(const SampleRange& a, const SampleRange& b) {
    return a.first <= b.first ? b.first - a.first < a.count : a.first - b.first < b.count;
}

} // namespace

const char* biasMethodName(BiasMethod method) {
    switch (method) {
    case BiasMethod::none: return "none";
    case BiasMethod::independent: return "independent";
    case BiasMethod::imageOnly: return "imageOnly";
    case BiasMethod::referenceOnly: return "referenceOnly";
    case BiasMethod::paired: return "paired";
    }
    return "";
}

const Interval& RelativeBias::of(Quantity quantity) const {
    switch (quantity) {
    case Quantity::red: return channels[0];
    case Quantity::green: return channels[1];
    case Quantity::blue: return channels[2];
    case Quantity::luminance: break;
    }
    return luminance;
}

bool shareSamples(const Metadata& a, const Metadata& b) {
    const auto seedA = metadataText(a, "isolux/seed");
    const auto rangeA = sampleRange(a);
    const auto rangeB = sampleRange(b);
    if (!seedA || !rangeA || !rangeB || seedA != metadataText(b, "isolux/seed") || !overlap(*rangeA, *rangeB))
        return false;
    const auto sceneA = metadataText(a, "isolux/sceneHash");
    const auto sceneB = metadataText(b, "isolux/sceneHash");
    return !sceneA || !sceneB || *sceneA == *sceneB;
}

RelativeBias relativeBias(const Image& image, const Image& reference) {
    const ImageView imageView(image, "image");
    const ImageView referenceView(reference, "reference");
    RelativeBias bias;
    bias.method =
        shareSamples(image.metadata, reference.metadata) ? BiasMethod::paired : chooseMethod(imageView, referenceView);
    bias.luminance = biasOf(imageView, referenceView, Quantity::luminance, bias.method);
    bias.channels = {biasOf(imageView, referenceView, Quantity::red, bias.method),
                     biasOf(imageView, referenceView, Quantity::green, bias.method),
                     biasOf(imageView, referenceView, Quantity::blue, bias.method)};
    return bias;
}

Interval pairedRelativeBias(std::span<const double> image, std::span<const double> reference) {
    assert(image.size() == reference.size());
    std::vector<double> differences(image.size());
    std::transform(image.begin(), image.end(), reference.begin(), differences.begin(), std::minus<>());
    const double b = mean(reference);
    const double estimate = relativeTo(b, mean(differences));
    if (!std::isfinite(estimate)) return {kUnknown, estimate, kUnknown};
    const double count = static_cast<double>(image.size());
    const double error = std::sqrt(variance(differences) / count);
    return studentInterval(estimate, relativeTo(std::abs(b), error), count - 1.0);
}

} // namespace isolux
