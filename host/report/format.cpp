#include "report/format.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace isolux {

using nlohmann::ordered_json;

std::string formatNumber(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.4g}", value); }

std::string formatPercent(double fraction) {
    return std::isnan(fraction) ? "nan" : fmt::format("{:+#.3g} %", 100.0 * fraction);
}

std::string formatInterval(const Interval& interval) {
    std::string estimate = formatNumber(interval.estimate);
    if (!interval.known()) return estimate;
    return fmt::format("{} [{}, {}]", estimate, formatNumber(interval.low), formatNumber(interval.high));
}

std::string formatPercentInterval(const Interval& interval) {
    std::string estimate = formatPercent(interval.estimate);
    if (!interval.known()) return estimate;
    return fmt::format("{} [{}, {}]", estimate, formatPercent(interval.low), formatPercent(interval.high));
}

std::string formatColor(const Vec3d& rgb) {
    return fmt::format("({}, {}, {})", formatNumber(rgb.x), formatNumber(rgb.y), formatNumber(rgb.z));
}

std::string formatLine(std::string_view label, std::string_view value) {
    return fmt::format("{:<18}{}\n", label, value);
}

std::string formatDiagnostics(const Diagnostics& diagnostics) {
    std::string text;
    const auto append = [&](std::uint64_t count, std::string_view what) {
        if (count != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    };
    append(diagnostics.nonFiniteSamples, "samples NaN or infinite");
    append(diagnostics.negativeSamples, "samples negative");
    append(diagnostics.stackOverflows, "traversal stack overflows");
    append(diagnostics.invalidIndices, "invalid indices");
    return text.empty() ? "no faults" : text;
}

ordered_json toJson(const Interval& interval) {
    return ordered_json::array({interval.low, interval.estimate, interval.high});
}

ordered_json toJson(const Vec3d& rgb) { return ordered_json::array({rgb.x, rgb.y, rgb.z}); }

ordered_json toJson(const Diagnostics& diagnostics) {
    return {{"nonFiniteSamples", diagnostics.nonFiniteSamples},
            {"negativeSamples", diagnostics.negativeSamples},
            {"stackOverflows", diagnostics.stackOverflows},
            {"invalidIndices", diagnostics.invalidIndices}};
}

std::string escapedHtml(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else if (c == '>')
            escaped += "&gt;";
        else if (c == '"')
            escaped += "&quot;";
        else
            escaped += c;
    }
    return escaped;
}

std::string jsonText(const ordered_json& document) {
    return document.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

} // namespace isolux
