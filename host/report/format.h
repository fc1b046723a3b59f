// How figures look in text and in JSON, the same in every report.
#pragma once

#include "core/math.h"
#include "film/film.h"
#include "report/statistics.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace isolux {

/// The version of every JSON report: it changes when a field changes its meaning or goes.
inline constexpr int kReportSchema = 1;

/// Four significant digits; "nan" whatever its sign.
[[nodiscard]] std::string formatNumber(double value);
/// A fraction as a percentage with its sign: "+0.120 %".
[[nodiscard]] std::string formatPercent(double fraction);
/// "estimate [low, high]", or the estimate alone if nothing is known about its error.
[[nodiscard]] std::string formatInterval(const Interval& interval);
[[nodiscard]] std::string formatPercentInterval(const Interval& interval);
[[nodiscard]] std::string formatColor(const Vec3d& rgb);
/// A label, padded so that values line up, the value and an end of line.
[[nodiscard]] std::string formatLine(std::string_view label, std::string_view value);
/// "no faults", or every count that is not zero.
[[nodiscard]] std::string formatDiagnostics(const Diagnostics& diagnostics);

/// [low, estimate, high]; NaN and infinities are null, as JSON has no word for them.
[[nodiscard]] nlohmann::ordered_json toJson(const Interval& interval);
[[nodiscard]] nlohmann::ordered_json toJson(const Vec3d& rgb);
[[nodiscard]] nlohmann::ordered_json toJson(const Diagnostics& diagnostics);

/// The document as text, indented, with an end of line. Bytes that are not UTF-8 (a driver's name) are replaced.
[[nodiscard]] std::string jsonText(const nlohmann::ordered_json& document);

/// The text for a page, as content or between double quotes.
[[nodiscard]] std::string escapedHtml(const std::string& text);

} // namespace isolux
