// What stress.h holds, as text and as JSON.
#include "report/format.h"
#include "report/stress.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

using nlohmann::ordered_json;
using Row = std::vector<std::string>;

std::vector<std::pair<std::uint64_t, const char*>> countsOf(const StressFaults& faults) {
    return {{faults.nonFinite, "NaN or infinite"},
            {faults.negative, "negative"},
            {faults.selfHits, "self-hits"},
            {faults.leaks, "leaks"},
            {faults.stackOverflows, "stack overflows"},
            {faults.invalidIndices, "invalid indices"},
            {faults.differentBits, "different bits"}};
}

bool anyError(const StressSweep& sweep) {
    return std::ranges::any_of(sweep.steps, [](const StressStep& step) {
        return std::ranges::any_of(step.figures, [](const auto& f) { return !std::isnan(f.error.estimate); });
    });
}

std::string shown(const Interval& interval) {
    return std::isnan(interval.estimate) ? "" : formatPercentInterval(interval);
}

std::string cell(const StressStep& step, const char* renderer, Interval StressFigures::*figure) {
    const StressFigures* figures = step.of(renderer);
    if (figures == nullptr) return "";
    return figures->failure.empty() ? shown(figures->*figure) : "failed";
}

/// Of the device; of others where it has none.
std::string faultCell(const StressStep& step) {
    std::string text;
    for (const StressFigures& figures : step.figures) {
        std::string what = figures.failure.empty() ? formatFaults(figures.faults) : figures.failure;
        if (what == "none") continue;
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", figures.renderer, what);
    }
    return text.empty() ? "none" : text;
}

enum class Columns { bias, biasAndError };

Row rowOf(const StressStep& step, Columns columns) {
    Row row{step.label, cell(step, kStressDevice, &StressFigures::bias),
            cell(step, kStressSingle, &StressFigures::bias)};
    if (columns == Columns::biasAndError) {
        row.push_back(cell(step, kStressDevice, &StressFigures::error));
        row.push_back(cell(step, kStressDouble, &StressFigures::error));
    }
    row.push_back(faultCell(step));
    return row;
}

std::string tableText(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const Row& row : rows) {
        std::string line = " ";
        for (std::size_t i = 0; i < row.size(); ++i)
            line += fmt::format(" {:<{}} ", row[i], i + 1 < row.size() ? widths[i] : 0);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string rangeText(const StressSweep& sweep, const std::string& renderer) {
    const StressRange range = rangeOf(sweep, renderer);
    if (range.steps == 0) return "";
    std::string text = range.within == 0 ? "at none" : fmt::format("from {} to {}", range.first, range.last);
    text += fmt::format(" ({} of {} steps)", range.within, range.steps);
    if (!range.broken.empty()) text += fmt::format(", beyond 1 % at {}", fmt::join(range.broken, " and "));
    return fmt::format("  {:<17} {}\n", renderer, text);
}

std::string promiseText(const StressSweep& sweep) {
    std::vector<const StressStep*> promised;
    for (const StressStep& step : sweep.steps)
        if (isPromised(sweep, step)) promised.push_back(&step);
    const std::string range =
        promised.empty() ? "of none" : fmt::format("from {} to {}", promised.front()->label, promised.back()->label);
    return fmt::format("  {:<17} {} ({} of {} steps)\n", "promised", range, promised.size(), sweep.steps.size());
}

std::string sweepText(const StressSweep& sweep) {
    const Columns columns = anyError(sweep) ? Columns::biasAndError : Columns::bias;
    std::vector<Row> rows{{sweep.axisTitle, "device", "single precision"}};
    if (columns == Columns::biasAndError) rows.front().insert(rows.front().end(), {"device, exact", "double, exact"});
    rows.front().push_back("faults");
    for (const StressStep& step : sweep.steps) rows.push_back(rowOf(step, columns));
    std::string text = fmt::format("{}: {}\n{}", sweep.name, sweep.title, tableText(rows));
    text += "within 0.1 %\n" + rangeText(sweep, kStressDevice) + rangeText(sweep, kStressSingle) + promiseText(sweep);
    return text + fmt::format("limit: {}\n", sweep.limit);
}

ordered_json toJson(const StressFigures& figures) {
    ordered_json json{{"renderer", figures.renderer},
                      {"mean", figures.mean},
                      {"bias", toJson(figures.bias)},
                      {"error", toJson(figures.error)},
                      {"tried", figures.faults.tried},
                      {"nonFinite", figures.faults.nonFinite},
                      {"negative", figures.faults.negative},
                      {"selfHits", figures.faults.selfHits},
                      {"leaks", figures.faults.leaks},
                      {"stackOverflows", figures.faults.stackOverflows},
                      {"invalidIndices", figures.faults.invalidIndices},
                      {"differentBits", figures.faults.differentBits},
                      {"seconds", figures.seconds}};
    if (!figures.failure.empty()) json["failure"] = figures.failure;
    return json;
}

ordered_json toJson(const StressRange& range) {
    return {{"first", range.first},
            {"last", range.last},
            {"within", range.within},
            {"steps", range.steps},
            {"broken", range.broken}};
}

/// Of every renderer but the one that biases are taken from.
ordered_json rangesJson(const StressSweep& sweep) {
    ordered_json json = ordered_json::object();
    for (const StressStep& step : sweep.steps)
        for (const StressFigures& figures : step.figures)
            if (figures.renderer != kStressDouble && !json.contains(figures.renderer))
                json[figures.renderer] = toJson(rangeOf(sweep, figures.renderer, criterionFor(figures.renderer)));
    return json;
}

ordered_json toJson(const StressSweep& sweep) {
    ordered_json json{{"name", sweep.name},
                      {"title", sweep.title},
                      {"axis", sweep.axisTitle},
                      {"logarithmic", sweep.axis == StressAxis::logarithmic},
                      {"limit", sweep.limit},
                      {"range", rangesJson(sweep)},
                      {"steps", ordered_json::array()}};
    for (const StressStep& step : sweep.steps) {
        ordered_json figures = ordered_json::array();
        for (const StressFigures& entry : step.figures) figures.push_back(toJson(entry));
        json["steps"].push_back({{"parameter", step.parameter},
                                 {"label", step.label},
                                 {"promised", isPromised(sweep, step)},
                                 {"figures", figures}});
    }
    return json;
}

} // namespace

std::string formatFaults(const StressFaults& faults) {
    std::string text;
    for (const auto& [count, what] : countsOf(faults))
        if (count != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    return text.empty() ? "none" : fmt::format("{} of {}", text, faults.tried);
}

std::string toText(const StressFamily& family) {
    std::string text = fmt::format("=== {}: {}\n", family.name, family.title);
    for (const StressSweep& sweep : family.sweeps) text += sweepText(sweep) + "\n";
    return text;
}

std::string toText(const StressSummary& summary) {
    std::string text = fmt::format("{} steps, {} of them promised", summary.steps, summary.promised);
    text += summary.broken == 0 ? ": none has a fault or a bias beyond 0.1 %"
                                : fmt::format(": promises are broken at {}", summary.broken);
    if (summary.unknown > 0) text += fmt::format("; at {} the interval is too wide to tell", summary.unknown);
    return text;
}

ordered_json toJson(const StressRun& run) {
    ordered_json json{{"schema", kReportSchema},
                      {"version", run.version},
                      {"device", run.device},
                      {"driver", run.driver},
                      {"quick", run.quick},
                      {"seconds", run.seconds},
                      {"tolerance", kStressTolerance},
                      {"families", ordered_json::array()}};
    for (const StressFamily& family : run.families) {
        ordered_json sweeps = ordered_json::array();
        for (const StressSweep& sweep : family.sweeps) sweeps.push_back(toJson(sweep));
        json["families"].push_back({{"name", family.name}, {"title", family.title}, {"sweeps", sweeps}});
    }
    const StressSummary summary = summarize(run.families);
    json["summary"] = {{"steps", summary.steps},
                       {"promised", summary.promised},
                       {"broken", summary.broken},
                       {"unknown", summary.unknown}};
    json["broken"] = brokenPromises(run.families);
    return json;
}

} // namespace isolux
