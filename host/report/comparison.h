// `compare`: an image against a reference, the limits it must keep, and the report as text and as JSON.
#pragma once

#include "report/bias.h"
#include "report/metrics.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// What a comparison must not exceed. A limit is exceeded only if the whole interval lies beyond it; where there is no
/// interval the estimate decides, and a figure that is NaN or infinite exceeds every limit.
struct ComparisonLimits {
    std::optional<double> maxRelativeBias; ///< of luminance and of R, G and B each: all above +X or all below -X
    std::optional<double> maxRelMse;
};

enum class Verdict { within, exceeded };

struct LimitCheck {
    std::string name; ///< "relative bias of luminance", ..., "relMSE"
    double limit = 0.0;
    Interval value;
    Verdict verdict = Verdict::within;
};

struct ComparisonReport {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    ImageErrors errors;
    RelativeBias bias;
    std::vector<std::string> notes; ///< what a reader must know to trust the figures
    std::vector<LimitCheck> limits;

    [[nodiscard]] Verdict verdict() const;
};

/// Throws Error (bad input) if the sizes differ or an image has no channels R, G and B.
[[nodiscard]] ComparisonReport compareImages(const Image& image, const Image& reference,
                                             const ComparisonLimits& limits = {});

/// Whether the whole interval lies beyond -limit or +limit (see ComparisonLimits).
[[nodiscard]] Verdict checkLimit(const Interval& value, double limit);

[[nodiscard]] std::string toText(const ComparisonReport& report);
[[nodiscard]] nlohmann::ordered_json toJson(const ComparisonReport& report);

} // namespace isolux
