#include "report/stress_chart.h"

#include "report/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

constexpr double kWidth = 760.0;
constexpr double kHeight = 300.0;
constexpr double kLeft = 64.0;
constexpr double kRight = 16.0;
constexpr double kTop = 14.0;
constexpr double kBottom = 52.0;
/// Exponents of ten at the ends of the vertical axis: what is less is drawn at the lower end.
constexpr double kLeast = -9.0;
constexpr double kMost = 0.5;

double vertical(double deviation) {
    const double size = std::abs(deviation);
    const double exponent = std::clamp(size > 0.0 ? std::log10(size) : kLeast, kLeast, kMost);
    return kTop + (kMost - exponent) / (kMost - kLeast) * (kHeight - kTop - kBottom);
}

/// Where steps stand on the horizontal axis: by their parameters, or evenly where those do not say.
class Horizontal {
public:
    explicit Horizontal(const StressSweep& sweep) : axis_(sweep.axis) {
        for (const StressStep& step : sweep.steps) places_.push_back(placeOf(step.parameter));
        const bool usable = std::ranges::all_of(places_, [](double place) { return std::isfinite(place); });
        const auto [low, high] = std::ranges::minmax(places_);
        if (!usable || !(high > low))
            for (std::size_t i = 0; i < places_.size(); ++i) places_[i] = static_cast<double>(i);
        const auto [first, last] = std::ranges::minmax(places_);
        low_ = first;
        span_ = last > first ? last - first : 1.0;
    }

    [[nodiscard]] double at(std::size_t step) const {
        return kLeft + 10.0 + (places_[step] - low_) / span_ * (kWidth - kLeft - kRight - 20.0);
    }

private:
    [[nodiscard]] double placeOf(double parameter) const {
        return axis_ == StressAxis::logarithmic ? std::log10(parameter) : parameter;
    }

    StressAxis axis_;
    std::vector<double> places_;
    double low_ = 0.0;
    double span_ = 1.0;
};

std::string grid() {
    std::string svg;
    for (int exponent = -8; exponent <= 0; exponent += 2) {
        const double y = vertical(std::pow(10.0, exponent));
        svg += fmt::format("<path d=\"M{} {:.1f}H{}\" stroke=\"var(--line)\"/><text x=\"{}\" y=\"{:.1f}\" "
                           "text-anchor=end>{}</text>",
                           kLeft, y, kWidth - kRight, kLeft - 6.0, y + 4.0,
                           exponent == 0 ? "100 %" : formatNumber(100.0 * std::pow(10.0, exponent)) + " %");
    }
    const auto limit = [](double at, const char* dashes) {
        return fmt::format("<path d=\"M{} {:.1f}H{}\" stroke=\"var(--bad)\" stroke-dasharray=\"{}\"/>", kLeft,
                           vertical(at), kWidth - kRight, dashes);
    };
    return svg + limit(kStressTolerance, "6 4") + limit(kStressBreakdown, "2 4");
}

/// As many labels as there is room for, the first and the last among them.
std::string stepLabels(const StressSweep& sweep, const Horizontal& x) {
    std::string svg;
    double free = -1e9;
    const double last = x.at(sweep.steps.size() - 1);
    for (std::size_t i = 0; i < sweep.steps.size(); ++i) {
        const double half = 3.6 * static_cast<double>(sweep.steps[i].label.size()) + 4.0;
        const bool isLast = i + 1 == sweep.steps.size();
        if (!isLast && (x.at(i) - half < free || x.at(i) + half > last - half)) continue;
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"{}\">{}</text>", x.at(i), kHeight - 32.0,
                           isLast   ? "end"
                           : i == 0 ? "start"
                                    : "middle",
                           escapedHtml(sweep.steps[i].label));
        free = x.at(i) + half;
    }
    return svg + fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=middle>{}</text>", 0.5 * (kLeft + kWidth - kRight),
                             kHeight - 10.0, escapedHtml(sweep.axisTitle));
}

/// The end of the interval that lies farther from zero.
double farEnd(const Interval& interval) {
    return interval.known() ? std::max(std::abs(interval.low), std::abs(interval.high)) : std::abs(interval.estimate);
}

std::string marker(double x, const Interval& deviation, const std::string& title) {
    const double y = vertical(deviation.estimate);
    return fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=currentColor stroke-opacity=.55 /><circle "
                       "cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=3.5 fill=currentColor><title>{3}</title></circle>",
                       x, y, vertical(farEnd(deviation)), escapedHtml(title));
}

std::string curve(const StressSweep& sweep, const Horizontal& x, const std::string& renderer, double shift) {
    std::string line;
    std::string markers;
    for (std::size_t i = 0; i < sweep.steps.size(); ++i) {
        const StressFigures* figures = sweep.steps[i].of(renderer);
        const bool known = figures != nullptr && std::isfinite(figures->deviation().estimate);
        if (!known) {
            if (!line.empty() && line.back() != 'M') line += " M";
            continue;
        }
        const double at = x.at(i) + shift;
        const bool starts = line.empty() || line.back() == 'M';
        line += fmt::format("{}{:.1f} {:.1f}", starts ? (line.empty() ? "M" : "") : "L", at,
                            vertical(figures->deviation().estimate));
        markers += marker(
            at, figures->deviation(),
            fmt::format("{}, {}: {}", renderer, sweep.steps[i].label, formatPercentInterval(figures->deviation())));
    }
    if (markers.empty()) return "";
    while (!line.empty() && (line.back() == 'M' || line.back() == ' ')) line.pop_back();
    return fmt::format("<path d=\"{}\" fill=none stroke=currentColor stroke-width=1.5 />{}", line, markers);
}

} // namespace

std::string stressChart(const StressSweep& sweep, const std::vector<std::string>& renderers) {
    if (sweep.steps.size() < 2) return "";
    const Horizontal x(sweep);
    std::string curves;
    for (std::size_t i = renderers.size(); i-- > 0;) {
        const std::string drawn = curve(sweep, x, renderers[i], 3.0 * (static_cast<double>(i) - 1.0));
        if (!drawn.empty()) curves += fmt::format("<g class=s{}>{}</g>", std::min<std::size_t>(i, 4), drawn);
    }
    if (curves.empty()) return "";
    return fmt::format("<svg viewBox=\"0 0 {} {}\" role=img aria-label=\"deviation against {}\">{}{}{}</svg>", kWidth,
                       kHeight, escapedHtml(sweep.axisTitle), grid(), stepLabels(sweep, x), curves);
}

} // namespace isolux
