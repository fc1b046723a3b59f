#include "report/comparison.h"

#include "core/error.h"
#include "report/format.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

using nlohmann::ordered_json;

void requireSameSize(const Image& image, const Image& reference) {
    if (image.width == reference.width && image.height == reference.height) return;
    throwBadInput("compare", fmt::format("the images differ in size: {} x {} and {} x {}", image.width, image.height,
                                         reference.width, reference.height));
}

std::vector<LimitCheck> checkLimits(const ComparisonReport& report, const ComparisonLimits& limits) {
    std::vector<LimitCheck> checks;
    const auto check = [&](std::string name, const Interval& value, double limit) {
        checks.push_back({std::move(name), limit, value, checkLimit(value, limit)});
    };
    if (limits.maxRelativeBias) {
        for (const Quantity quantity : kQuantities) {
            check(fmt::format("relative bias of {}", quantityName(quantity)), report.bias.of(quantity),
                  *limits.maxRelativeBias);
        }
    }
    if (limits.maxRelMse) check("relMSE", report.errors.relMse, *limits.maxRelMse);
    return checks;
}

// --- Notes ---

void noteDefects(std::vector<std::string>& notes, const char* role, const PixelDefects& defects) {
    if (!defects.finite()) {
        notes.push_back(fmt::format("{}: {} pixels hold NaN and {} infinity, so the errors are nan", role, defects.nan,
                                    defects.infinite));
    }
    if (defects.negative != 0) notes.push_back(fmt::format("{}: {} pixels are negative", role, defects.negative));
}

/// What the interval of the bias counts, where that is not simply both variances.
const char* methodNote(BiasMethod method) {
    switch (method) {
    case BiasMethod::none: return "neither image carries variance: the bias has no interval";
    case BiasMethod::imageOnly:
        return "the reference carries no variance: it is taken as exact, the interval counts the image's alone";
    case BiasMethod::referenceOnly:
        return "the image carries no variance: it is taken as exact, the interval counts the reference's alone";
    case BiasMethod::paired:
        return "the images share random numbers: the interval is that of the differences of their pixels";
    case BiasMethod::independent: break;
    }
    return nullptr;
}

bool boundsLuminance(const ImageView& view) {
    return view.varianceSource() == VarianceSource::channelsOnly ||
           view.varianceSource() == VarianceSource::standardErrors;
}

std::vector<std::string> makeNotes(const ComparisonReport& report, const ImageView& image, const ImageView& reference) {
    std::vector<std::string> notes;
    noteDefects(notes, "image", report.errors.imageDefects);
    noteDefects(notes, "reference", report.errors.referenceDefects);
    if (const char* note = methodNote(report.bias.method)) notes.emplace_back(note);
    if (report.bias.method != BiasMethod::paired && (boundsLuminance(image) || boundsLuminance(reference))) {
        notes.emplace_back(
            "no variance of luminance: its interval is an upper bound, as if the channels were fully correlated");
    }
    if (report.errors.litPixelCount == 0) notes.emplace_back("the reference is black");
    return notes;
}

// --- Text ---

std::string limitText(const LimitCheck& check) {
    return fmt::format("{} {:.4g}: {}", check.name, check.limit,
                       check.verdict == Verdict::within ? "within" : "EXCEEDED");
}

std::string meansText(const char* role, const ColorMean& mean) {
    return fmt::format("{} {} {}", role, formatNumber(mean.luminance), formatColor(mean.rgb));
}

std::string biasText(const RelativeBias& bias) {
    std::string text =
        formatLine("relative bias", fmt::format("{}  luminance, {}", formatPercentInterval(bias.luminance),
                                                biasMethodName(bias.method)));
    for (const Quantity quantity : {Quantity::red, Quantity::green, Quantity::blue}) {
        text += formatLine("", fmt::format("{}  {}", formatPercentInterval(bias.of(quantity)), quantityName(quantity)));
    }
    return text;
}

// --- JSON ---

ordered_json defectsJson(const PixelDefects& defects) {
    return {{"nan", defects.nan}, {"infinite", defects.infinite}, {"negative", defects.negative}};
}

ordered_json meanJson(const ColorMean& mean) { return {{"luminance", mean.luminance}, {"rgb", toJson(mean.rgb)}}; }

ordered_json biasJson(const RelativeBias& bias) {
    ordered_json json{{"method", biasMethodName(bias.method)}, {"confidence", kConfidence}};
    for (const Quantity quantity : kQuantities) json[quantityName(quantity)] = toJson(bias.of(quantity));
    return json;
}

ordered_json limitsJson(const std::vector<LimitCheck>& limits) {
    ordered_json json = ordered_json::array();
    for (const LimitCheck& check : limits) {
        json.push_back({{"name", check.name},
                        {"limit", check.limit},
                        {"value", toJson(check.value)},
                        {"exceeded", check.verdict == Verdict::exceeded}});
    }
    return json;
}

} // namespace

Verdict ComparisonReport::verdict() const {
    const bool exceeded = std::any_of(limits.begin(), limits.end(),
                                      [](const LimitCheck& check) { return check.verdict == Verdict::exceeded; });
    return exceeded ? Verdict::exceeded : Verdict::within;
}

Verdict checkLimit(const Interval& value, double limit) {
    if (!std::isfinite(value.estimate)) return Verdict::exceeded;
    const double low = value.known() ? value.low : value.estimate;
    const double high = value.known() ? value.high : value.estimate;
    return low > limit || high < -limit ? Verdict::exceeded : Verdict::within;
}

ComparisonReport compareImages(const Image& image, const Image& reference, const ComparisonLimits& limits) {
    requireSameSize(image, reference);
    const ImageView imageView(image, "image");
    const ImageView referenceView(reference, "reference");
    ComparisonReport report;
    report.width = image.width;
    report.height = image.height;
    report.errors = imageErrors(imageView, referenceView, image.width);
    report.bias = relativeBias(image, reference);
    report.notes = makeNotes(report, imageView, referenceView);
    report.limits = checkLimits(report, limits);
    return report;
}

std::string toText(const ComparisonReport& report) {
    const ImageErrors& errors = report.errors;
    std::string text = formatLine(
        "pixels", fmt::format("{} x {}, {} lit in the reference", report.width, report.height, errors.litPixelCount));
    text += formatLine("relative RMSE",
                       fmt::format("{}  RMSE {}, MAE {}, largest {}", formatNumber(errors.relativeRmse),
                                   formatNumber(errors.rmse), formatNumber(errors.mae), formatNumber(errors.maxAbs)));
    text += formatLine("MSE",
                       fmt::format("{}  of which noise {}", formatNumber(errors.mse), formatNumber(errors.noiseMse)));
    text += formatLine("relMSE", fmt::format("{}  without the worst 0.1 % {}", formatInterval(errors.relMse),
                                             formatNumber(errors.relMseTrimmed)));
    text += biasText(report.bias);
    text += formatLine("mean luminance", fmt::format("{}, {}", meansText("image", errors.imageMean),
                                                     meansText("reference", errors.referenceMean)));
    for (const std::string& note : report.notes) text += formatLine("note", note);
    for (const LimitCheck& check : report.limits) text += formatLine("limit", limitText(check));
    return text;
}

ordered_json toJson(const ComparisonReport& report) {
    const ImageErrors& errors = report.errors;
    return {
        {"schema", kReportSchema},
        {"report", "comparison"},
        {"width", report.width},
        {"height", report.height},
        {"litPixels", errors.litPixelCount},
        {"mse", errors.mse},
        {"noiseMse", errors.noiseMse},
        {"rmse", errors.rmse},
        {"relativeRmse", errors.relativeRmse},
        {"relMse", toJson(errors.relMse)},
        {"relMseTrimmed", errors.relMseTrimmed},
        {"mae", errors.mae},
        {"maxAbs", errors.maxAbs},
        {"relativeBias", biasJson(report.bias)},
        {"mean", {{"image", meanJson(errors.imageMean)}, {"reference", meanJson(errors.referenceMean)}}},
        {"defects", {{"image", defectsJson(errors.imageDefects)}, {"reference", defectsJson(errors.referenceDefects)}}},
        {"notes", report.notes},
        {"limits", limitsJson(report.limits)}};
}

} // namespace isolux
