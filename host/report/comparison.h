// `compare`: an image against a reference, the limits it must keep, and the report as text and as JSON.
#pragma once

#include "report/bias.h"
#include "report/blocks.h"
#include "report/flip.h"
#include "report/metrics.h"
#include "report/outliers.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// Whether the blocks' error budget (BlockComparison::agree) is a limit.
enum class BlockCheck { reported, enforced };

/// What a comparison must not exceed. A limit is exceeded only if the whole interval lies beyond it; where there is no
/// interval the estimate decides, and a figure that is NaN or infinite exceeds every limit.
struct ComparisonLimits {
    std::optional<double> maxRelativeBias; ///< of luminance and of R, G and B each: all above +X or all below -X
    std::optional<double> maxRelMse;
    std::optional<double> maxFlip = {}; ///< of mean FLIP
    BlockCheck blocks = BlockCheck::reported;
};

enum class Verdict { within, exceeded };

struct LimitCheck {
    std::string name; ///< "relative bias of luminance", ..., "relMSE", "FLIP", "largest |z| of blocks"
    double limit = 0.0;
    Interval value;
    Verdict verdict = Verdict::within;
};

/// What the ends of a heatmap's colours mean.
struct HeatmapRange {
    std::string quantity;
    double low = 0.0;
    double high = 0.0;
    std::string file = {}; ///< where it was written
};

struct ComparisonReport {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    ImageErrors errors;
    RelativeBias bias;
    Outliers outliers;
    std::optional<BlockComparison> blocks; ///< nothing if neither image carries variance
    std::optional<FlipResult> flip;        ///< if it was asked for
    std::optional<HeatmapRange> heatmap;   ///< if one was written
    std::vector<std::string> notes;        ///< what a reader must know to trust the figures
    std::vector<LimitCheck> limits;

    [[nodiscard]] Verdict verdict() const;
};

/// FLIP is computed only with options for it. Throws Error (bad input) if the sizes differ, an image has no channels R,
/// G and B, or what a limit is about cannot be known: FLIP without options, blocks if neither image carries variance.
[[nodiscard]] ComparisonReport compareImages(const Image& image, const Image& reference,
                                             const ComparisonLimits& limits = {},
                                             const std::optional<FlipOptions>& flipOptions = {});

/// Whether the whole interval lies beyond -limit or +limit (see ComparisonLimits).
[[nodiscard]] Verdict checkLimit(const Interval& value, double limit);

[[nodiscard]] std::string toText(const ComparisonReport& report);
[[nodiscard]] nlohmann::ordered_json toJson(const ComparisonReport& report);

} // namespace isolux
