#include "report/comparison.h"
#include "report/format.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace isolux {
namespace {

using nlohmann::ordered_json;

const char* rangeName(DynamicRange range) { return range == DynamicRange::low ? "low" : "high"; }

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

std::string outlierText(const Outliers& outliers) {
    std::string text = outliers.beyondNoise ? fmt::format("{} pixels beyond {} standard errors", *outliers.beyondNoise,
                                                          formatNumber(outliers.zLimit))
                                            : "no variance to judge noise by";
    return text + fmt::format(", fireflies {} in the image, {} in the reference", outliers.imageFireflies,
                              outliers.referenceFireflies);
}

std::string blockText(const BlockComparison& comparison) {
    const BlockDifference& worst = comparison.blocks[comparison.worst];
    std::string text = formatLine("blocks", fmt::format("{} x {}, z of the mean {:+.3g}, largest {:+.3g} at ({}, {})",
                                                        comparison.grid.columns(), comparison.grid.rows(),
                                                        comparison.whole.z, worst.z, worst.x, worst.y));
    text += formatLine(
        "", fmt::format("{} of {} with noise beyond 1.96 (5 % expected)", comparison.beyond95, comparison.noisyBlocks));
    return text + formatLine("", fmt::format("{} beyond {:.3g}: blocks and mean {} at a family-wise error of {:.2g} %",
                                             comparison.beyondLimit, comparison.limit,
                                             comparison.agree() ? "agree" : "DIFFER", 100.0 * kFamilyError));
}

std::string flipText(const FlipResult& flip) {
    std::string text =
        fmt::format("{}  largest {}, {} dynamic range, {:.4g} pixels per degree", formatNumber(flip.mean),
                    formatNumber(flip.largest), rangeName(flip.options.range), flip.options.pixelsPerDegree);
    if (!flip.exposures) return text;
    return text + fmt::format(", {} exposures from {:+.3g} to {:+.3g}", flip.exposures->count, flip.exposures->start,
                              flip.exposures->stop);
}

// --- JSON ---

ordered_json outliersJson(const Outliers& outliers) {
    return {{"beyondNoise", outliers.beyondNoise ? ordered_json(*outliers.beyondNoise) : ordered_json()},
            {"zLimit", outliers.zLimit},
            {"fireflyFactor", kFireflyFactor},
            {"imageFireflies", outliers.imageFireflies},
            {"referenceFireflies", outliers.referenceFireflies}};
}

ordered_json flipJson(const FlipResult& flip) {
    ordered_json json{{"mean", flip.mean},
                      {"largest", flip.largest},
                      {"range", rangeName(flip.options.range)},
                      {"pixelsPerDegree", flip.options.pixelsPerDegree},
                      {"exposures", nullptr}};
    if (flip.exposures) {
        json["exposures"] = {
            {"start", flip.exposures->start}, {"stop", flip.exposures->stop}, {"count", flip.exposures->count}};
    }
    return json;
}

ordered_json heatmapJson(const HeatmapRange& range) {
    return {{"file", range.file}, {"quantity", range.quantity}, {"low", range.low}, {"high", range.high}};
}

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
    if (report.flip) text += formatLine("FLIP", flipText(*report.flip));
    text += biasText(report.bias);
    text += formatLine("outliers", outlierText(report.outliers));
    if (report.blocks) text += blockText(*report.blocks);
    text += formatLine("mean luminance", fmt::format("{}, {}", meansText("image", errors.imageMean),
                                                     meansText("reference", errors.referenceMean)));
    if (report.heatmap) {
        text +=
            formatLine("heatmap", fmt::format("{}, {} from {} to {}", report.heatmap->file, report.heatmap->quantity,
                                              formatNumber(report.heatmap->low), formatNumber(report.heatmap->high)));
    }
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
        {"flip", report.flip ? flipJson(*report.flip) : ordered_json()},
        {"outliers", outliersJson(report.outliers)},
        {"blocks", report.blocks ? toJson(*report.blocks) : ordered_json()},
        {"heatmap", report.heatmap ? heatmapJson(*report.heatmap) : ordered_json()},
        {"relativeBias", biasJson(report.bias)},
        {"mean", {{"image", meanJson(errors.imageMean)}, {"reference", meanJson(errors.referenceMean)}}},
        {"defects", {{"image", defectsJson(errors.imageDefects)}, {"reference", defectsJson(errors.referenceDefects)}}},
        {"notes", report.notes},
        {"limits", limitsJson(report.limits)}};
}

} // namespace isolux
