#include "report/comparison.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

void requireSameSize(const Image& image, const Image& reference) {
    if (image.width == reference.width && image.height == reference.height) return;
    throwBadInput("compare", fmt::format("the images differ in size: {} x {} and {} x {}", image.width, image.height,
                                         reference.width, reference.height));
}

Interval withoutInterval(double estimate) {
    Interval interval;
    interval.estimate = estimate;
    return interval;
}

/// NaN if any is.
double largestZ(const BlockComparison& comparison) {
    const double mean = std::abs(comparison.whole.z);
    const double worst = std::abs(comparison.blocks[comparison.worst].z);
    return mean <= worst || std::isnan(worst) ? worst : mean;
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
    if (limits.maxFlip) {
        if (!report.flip) throwBadInput("compare", "a limit for FLIP, which was not asked for");
        check("FLIP", withoutInterval(report.flip->mean), *limits.maxFlip);
    }
    if (limits.blocks == BlockCheck::enforced) {
        if (!report.blocks) throwBadInput("compare", "neither image carries variance: blocks cannot be checked");
        check("largest |z| of blocks and mean", withoutInterval(largestZ(*report.blocks)), report.blocks->limit);
    }
    return checks;
}

// --- Notes ---

void noteDefects(std::vector<std::string>& notes, const char* role, const PixelDefects& defects) {
    if (!defects.finite()) {
        notes.push_back(fmt::format("{}: {} pixels hold NaN and {} infinity, so the errors and FLIP are nan", role,
                                    defects.nan, defects.infinite));
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
        return "the images share random numbers: the interval is that of the differences of their pixels, and the z "
               "values of blocks are too small";
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

} // namespace

Verdict ComparisonReport::verdict() const {
    const bool exceeded = std::any_of(limits.begin(), limits.end(),
                                      [](const LimitCheck& check) { return check.verdict == Verdict::exceeded; });
    return exceeded ? Verdict::exceeded : Verdict::within;
}

Verdict checkLimit(const Interval& value, double limit) {
    if (!std::isfinite(value.estimate) || std::isnan(limit)) return Verdict::exceeded;
    const double low = value.known() ? value.low : value.estimate;
    const double high = value.known() ? value.high : value.estimate;
    return low > limit || high < -limit ? Verdict::exceeded : Verdict::within;
}

ComparisonReport compareImages(const Image& image, const Image& reference, const ComparisonLimits& limits,
                               const std::optional<FlipOptions>& flipOptions) {
    requireSameSize(image, reference);
    const ImageView imageView(image, "image");
    const ImageView referenceView(reference, "reference");
    ComparisonReport report;
    report.width = image.width;
    report.height = image.height;
    report.errors = imageErrors(imageView, referenceView, image.width);
    report.bias = relativeBias(image, reference);
    report.outliers = findOutliers(image, reference);
    report.blocks = compareBlocks(image, reference);
    if (flipOptions) report.flip = flip(image, reference, *flipOptions);
    report.notes = makeNotes(report, imageView, referenceView);
    report.limits = checkLimits(report, limits);
    return report;
}

} // namespace isolux
