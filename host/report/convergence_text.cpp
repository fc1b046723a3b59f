// What convergence.h finds, as text and as JSON.
#include "report/convergence.h"
#include "report/format.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace isolux {
namespace {

using nlohmann::ordered_json;

// --- Text ---

using Row = std::array<std::string, 6>;

std::string numberOrNothing(double value) { return std::isnan(value) ? "" : formatNumber(value); }

Row tableRow(const CheckpointSummary& checkpoint) {
    return {formatNumber(checkpoint.samplesPerPixel),
            formatNumber(checkpoint.wallSeconds),
            formatInterval(checkpoint.relativeRmse),
            formatPercentInterval(checkpoint.bias),
            numberOrNothing(checkpoint.flip.estimate),
            numberOrNothing(checkpoint.estimate.estimate / checkpoint.relativeRmse.estimate)};
}

std::string tableText(const VariantSummary& variant) {
    std::vector<Row> rows{{"samples", "seconds", "relative RMSE", "bias", "FLIP", "estimate/true"}};
    for (const CheckpointSummary& checkpoint : variant.checkpoints) rows.push_back(tableRow(checkpoint));
    std::array<std::size_t, std::tuple_size_v<Row>> widths{};
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line += fmt::format("{}{:>{}}", i == 0 ? "" : "  ", row[i], widths[i]);
        text += "  " + line + "\n";
    }
    return text;
}

std::string timeText(const TimeToError& time) {
    if (!time.reason.empty()) return time.reason;
    return fmt::format("{} s{}", formatInterval(time.seconds), time.extrapolated ? ", extrapolated" : "");
}

std::string calibrationText(const Calibration& calibration) {
    std::string text = fmt::format("95 % intervals hold the mean luminance of {} of {} seeds, pixels",
                                   calibration.meanLuminance.inside, calibration.meanLuminance.total);
    for (const Coverage& pixels : calibration.pixels) text += fmt::format(" {:.1f}", 100.0 * pixels.share().estimate);
    return text + " % (dark to bright)";
}

std::string variantText(const VariantSummary& variant) {
    std::string text = formatLine("variant", fmt::format("{}{}{}, {} seeds, set-up {} s", variant.name,
                                                         variant.options.empty() ? "" : ": ", variant.options,
                                                         variant.seeds, formatNumber(variant.setupSeconds)));
    text += tableText(variant);
    text += formatLine("slope",
                       fmt::format("{} over samples, {} over time: {}", formatInterval(variant.slopeSamples),
                                   formatInterval(variant.slopeTime), variant.slopeHolds ? "holds" : "DOES NOT HOLD"));
    text += formatLine("floor", formatInterval(variant.floor) + " of relative MSE");
    text += formatLine("efficiency", formatInterval(variant.efficiency) + " 1/(MSE s)");
    if (!variant.checkpoints.empty() && variant.checkpoints.back().calibration)
        text += formatLine("calibration", calibrationText(*variant.checkpoints.back().calibration));
    for (const TimeToError& time : variant.timeTo)
        text += formatLine(fmt::format("time to {:.3g} %", 100.0 * time.error), timeText(time));
    return text;
}

/// Three digits, and no exponent.
std::string factorText(double factor) {
    return std::abs(factor) >= 1000.0 ? fmt::format("{:.0f}", factor) : fmt::format("{:.3g}", factor);
}

// --- JSON ---

ordered_json coverageJson(const Coverage& coverage) {
    return {{"inside", coverage.inside}, {"total", coverage.total}, {"share", toJson(coverage.share())}};
}

ordered_json calibrationJson(const Calibration& calibration) {
    ordered_json pixels = ordered_json::array();
    for (std::size_t i = 0; i < calibration.pixels.size(); ++i) {
        ordered_json fifth{{"below", calibration.brightness[i]}};
        fifth.update(coverageJson(calibration.pixels[i]));
        pixels.push_back(std::move(fifth));
    }
    return {{"meanLuminance", coverageJson(calibration.meanLuminance)},
            {"pixels", std::move(pixels)},
            {"estimateOverError", toJson(calibration.estimateOverError)}};
}

ordered_json checkpointJson(const CheckpointSummary& checkpoint) {
    return {{"samplesPerPixel", checkpoint.samplesPerPixel},
            {"raysPerPixel", checkpoint.raysPerPixel},
            {"wallSeconds", checkpoint.wallSeconds},
            {"deviceSeconds", checkpoint.deviceSeconds},
            {"mse", toJson(checkpoint.mse)},
            {"relMse", toJson(checkpoint.relMse)},
            {"relMseTrimmed", toJson(checkpoint.relMseTrimmed)},
            {"mae", toJson(checkpoint.mae)},
            {"flip", toJson(checkpoint.flip)},
            {"bias", toJson(checkpoint.bias)},
            {"biasSquared", toJson(checkpoint.biasSquared)},
            {"relativeRmse", toJson(checkpoint.relativeRmse)},
            {"estimate", toJson(checkpoint.estimate)},
            {"calibration", checkpoint.calibration ? calibrationJson(*checkpoint.calibration) : ordered_json()}};
}

ordered_json timeJson(const TimeToError& time) {
    return {{"error", time.error},
            {"seconds", toJson(time.seconds)},
            {"extrapolated", time.extrapolated},
            {"reason", time.reason}};
}

template <typename Item> ordered_json arrayJson(const std::vector<Item>& items, ordered_json (*itemJson)(const Item&)) {
    ordered_json json = ordered_json::array();
    for (const Item& item : items) json.push_back(itemJson(item));
    return json;
}

ordered_json variantJson(const VariantSummary& variant) {
    return {{"name", variant.name},
            {"options", variant.options},
            {"seeds", variant.seeds},
            {"setupSeconds", variant.setupSeconds},
            {"checkpoints", arrayJson(variant.checkpoints, checkpointJson)},
            {"slopeTime", toJson(variant.slopeTime)},
            {"slopeSamples", toJson(variant.slopeSamples)},
            {"floor", toJson(variant.floor)},
            {"slopeHolds", variant.slopeHolds},
            {"efficiency", toJson(variant.efficiency)},
            {"timeTo", arrayJson(variant.timeTo, timeJson)}};
}

ordered_json ratioJson(const SpeedRatio& ratio) {
    return {{"faster", ratio.faster},
            {"slower", ratio.slower},
            {"error", ratio.error},
            {"ratio", toJson(ratio.ratio)},
            {"extrapolated", ratio.extrapolated},
            {"text", sentence(ratio)}};
}

} // namespace

std::string sentence(const SpeedRatio& ratio) {
    const std::string interval =
        ratio.ratio.known() ? fmt::format(" ({}-{})", factorText(ratio.ratio.low), factorText(ratio.ratio.high)) : "";
    return fmt::format("{} reaches {:.3g} % relative RMSE {}{} times sooner than {}{}", ratio.faster,
                       100.0 * ratio.error, factorText(ratio.ratio.estimate), interval, ratio.slower,
                       ratio.extrapolated ? ", extrapolated" : "");
}

std::string toText(const ConvergenceReport& report) {
    std::string text;
    for (const VariantSummary& variant : report.variants) text += variantText(variant) + "\n";
    for (const SpeedRatio& ratio : report.ratios) text += sentence(ratio) + "\n";
    return text;
}

ordered_json toJson(const ConvergenceReport& report) {
    ordered_json errors = ordered_json::array();
    if (!report.variants.empty()) {
        for (const TimeToError& time : report.variants.front().timeTo) errors.push_back(time.error);
    }
    return {{"errors", std::move(errors)},
            {"variants", arrayJson(report.variants, variantJson)},
            {"ratios", arrayJson(report.ratios, ratioJson)}};
}

ordered_json toJson(const ReferenceQuality& reference) {
    return {
        {"samplesPerPixel", reference.samplesPerPixel > 0.0 ? ordered_json(reference.samplesPerPixel) : ordered_json()},
        {"relativeRmse", reference.relativeRmse()},
        {"relativeBiasError", reference.relativeBiasError}};
}

} // namespace isolux
