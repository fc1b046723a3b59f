#include "report/stress.h"

#include "core/error.h"
#include "report/format.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace isolux {
namespace {

using nlohmann::ordered_json;

/// A step without a figure is as good as its faults say.
bool holds(const StressFigures& figures) {
    if (!figures.failure.empty() || !figures.faults.clean()) return false;
    const StressVerdict verdict = verdictOf(figures.deviation(), kStressTolerance);
    return verdict == StressVerdict::within || verdict == StressVerdict::none;
}

/// A step as a range sees it.
struct Tried {
    const std::string* label = nullptr;
    bool counts = false;
    bool broken = false;
};

Tried judged(const StressStep& step, const StressFigures& figures, StressCriterion criterion) {
    const bool beyond = verdictOf(figures.deviation(), kStressBreakdown) == StressVerdict::beyond;
    const bool broken = beyond || !figures.failure.empty();
    return {&step.label, criterion == StressCriterion::holds ? holds(figures) : !broken, broken};
}

/// First and one past the last; both 0 without any.
std::pair<std::size_t, std::size_t> longestRun(const std::vector<Tried>& tried) {
    std::pair<std::size_t, std::size_t> best{0, 0};
    std::size_t begin = 0;
    for (std::size_t i = 0; i < tried.size(); ++i) {
        if (!tried[i].counts) begin = i + 1;
        if (i + 1 - begin > best.second - best.first) best = {begin, i + 1};
    }
    return best;
}

StressFamily* familyNamed(StressRun& run, const std::string& name) {
    const auto found = std::ranges::find(run.families, name, &StressFamily::name);
    return found == run.families.end() ? nullptr : &*found;
}

StressSweep* sweepNamed(StressFamily& family, const std::string& name) {
    const auto found = std::ranges::find(family.sweeps, name, &StressSweep::name);
    return found == family.sweeps.end() ? nullptr : &*found;
}

Interval intervalOf(const ordered_json& json) {
    const auto number = [](const ordered_json& value) {
        return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
    };
    return {number(json.at(0)), number(json.at(1)), number(json.at(2))};
}

StressFigures figuresOf(const ordered_json& json) {
    StressFigures figures;
    figures.renderer = json.at("renderer").get<std::string>();
    figures.bias = intervalOf(json.at("bias"));
    figures.error = intervalOf(json.at("error"));
    figures.faults.tried = json.at("tried").get<std::uint64_t>();
    figures.faults.nonFinite = json.at("nonFinite").get<std::uint64_t>();
    figures.failure = json.value("failure", std::string());
    figures.seconds = json.at("seconds").get<double>();
    return figures;
}

void addToSweep(StressSweep& sweep, const ordered_json& steps) {
    for (const ordered_json& step : steps) {
        const auto found = std::ranges::find(sweep.steps, step.at("label").get<std::string>(), &StressStep::label);
        if (found == sweep.steps.end()) continue;
        for (const ordered_json& figures : step.at("figures")) found->figures.push_back(figuresOf(figures));
    }
}

/// What no step may have, wherever it lies: a renderer that gives no figures, samples that are no light, and a
/// reference that says nothing of the device.
std::vector<std::string> unsound(const StressStep& step) {
    std::vector<std::string> found;
    const StressFigures& device = *step.of(kStressDevice);
    if (!device.failure.empty()) found.push_back(device.failure);
    if (!device.faults.sound()) found.push_back(formatFaults(device.faults));
    const StressFigures* reference = step.of(kStressDouble);
    if (reference == nullptr) return found;
    if (!reference->failure.empty()) found.push_back(fmt::format("{}: {}", kStressDouble, reference->failure));
    if (!reference->faults.sound())
        found.push_back(fmt::format("{}: {}", kStressDouble, formatFaults(reference->faults)));
    const bool isImage = !std::isnan(reference->mean);
    if (isImage && device.failure.empty() && std::isnan(device.bias.estimate))
        found.push_back("the device's image has nothing to be compared with");
    return found;
}

/// Hundreds of errors are asked: a 95 % interval times this reaches 4.5 standard errors, which none leaves by chance.
constexpr double kOfHundreds = 2.3;

bool contradicts(const Interval& error) {
    if (!error.known()) return false;
    const Interval wide{error.estimate - kOfHundreds * (error.estimate - error.low), error.estimate,
                        error.estimate + kOfHundreds * (error.high - error.estimate)};
    return verdictOf(wide, kStressTolerance) == StressVerdict::beyond;
}

} // namespace

const Interval& StressFigures::deviation() const { return std::isnan(bias.estimate) ? error : bias; }

const StressFigures* StressStep::of(const std::string& renderer) const {
    const auto found = std::ranges::find(figures, renderer, &StressFigures::renderer);
    return found == figures.end() ? nullptr : &*found;
}

StressVerdict verdictOf(const Interval& deviation, double tolerance) {
    if (std::isnan(deviation.estimate)) return StressVerdict::none;
    const double low = deviation.known() ? deviation.low : deviation.estimate;
    const double high = deviation.known() ? deviation.high : deviation.estimate;
    if (low >= -tolerance && high <= tolerance) return StressVerdict::within;
    return low > tolerance || high < -tolerance ? StressVerdict::beyond : StressVerdict::unknown;
}

StressCriterion criterionFor(const std::string& renderer) {
    const bool ours = renderer == kStressDevice || renderer == kStressSingle || renderer == kStressDouble;
    return ours ? StressCriterion::holds : StressCriterion::notBrokenDown;
}

StressRange rangeOf(const StressSweep& sweep, const std::string& renderer, StressCriterion criterion) {
    std::vector<Tried> tried;
    for (const StressStep& step : sweep.steps)
        if (const StressFigures* figures = step.of(renderer)) tried.push_back(judged(step, *figures, criterion));
    const auto [begin, end] = longestRun(tried);
    StressRange range;
    range.steps = tried.size();
    range.within = end - begin;
    if (begin < end) {
        range.first = *tried[begin].label;
        range.last = *tried[end - 1].label;
    }
    const auto isBroken = [](const Tried& step) { return step.broken; };
    const auto start = tried.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto before = std::find_if(std::reverse_iterator(start), tried.rend(), isBroken);
    const auto after = std::find_if(tried.begin() + static_cast<std::ptrdiff_t>(end), tried.end(), isBroken);
    if (before != tried.rend()) range.broken.push_back(*before->label);
    if (after != tried.end()) range.broken.push_back(*after->label);
    return range;
}

StressFaults totalFaults(const StressFamily& family, const std::string& renderer) {
    StressFaults total;
    for (const StressSweep& sweep : family.sweeps)
        for (const StressStep& step : sweep.steps) {
            const StressFigures* figures = step.of(renderer);
            if (figures == nullptr) continue;
            const StressFaults& faults = figures->faults;
            total.tried += faults.tried;
            total.nonFinite += faults.nonFinite;
            total.negative += faults.negative;
            total.selfHits += faults.selfHits;
            total.leaks += faults.leaks;
            total.stackOverflows += faults.stackOverflows;
            total.invalidIndices += faults.invalidIndices;
            total.differentBits += faults.differentBits;
        }
    return total;
}

bool isPromised(const StressSweep& sweep, const StressStep& step) {
    return sweep.promisedFrom <= step.parameter && step.parameter <= sweep.promisedTo;
}

StressSummary summarize(const std::vector<StressFamily>& families) {
    StressSummary summary;
    for (const StressFamily& family : families)
        for (const StressSweep& sweep : family.sweeps)
            for (const StressStep& step : sweep.steps) {
                const StressFigures* device = step.of(kStressDevice);
                if (device == nullptr) continue;
                const bool promised = isPromised(sweep, step);
                const bool unknown = verdictOf(device->deviation(), kStressTolerance) == StressVerdict::unknown;
                ++summary.steps;
                summary.promised += promised ? 1 : 0;
                summary.broken += brokenPromises(sweep, step).empty() ? 0 : 1;
                summary.unknown += promised && unknown ? 1 : 0;
            }
    return summary;
}

std::vector<std::string> brokenPromises(const StressSweep& sweep, const StressStep& step) {
    const StressFigures* device = step.of(kStressDevice);
    if (device == nullptr) return {};
    std::vector<std::string> broken = unsound(step);
    if (!isPromised(sweep, step)) return broken;
    if (device->faults.sound() && !device->faults.clean()) broken.push_back(formatFaults(device->faults));
    if (verdictOf(device->deviation(), kStressTolerance) == StressVerdict::beyond)
        broken.push_back(formatPercentInterval(device->deviation()));
    for (const char* renderer : {kStressDevice, kStressDouble}) {
        const StressFigures* figures = step.of(renderer);
        if (figures != nullptr && contradicts(figures->error))
            broken.push_back(fmt::format("{} is {} from what is known in closed form", renderer,
                                         formatPercentInterval(figures->error)));
    }
    return broken;
}

std::vector<std::string> brokenPromises(const std::vector<StressFamily>& families) {
    std::vector<std::string> lines;
    for (const StressFamily& family : families)
        for (const StressSweep& sweep : family.sweeps)
            for (const StressStep& step : sweep.steps)
                for (const std::string& broken : brokenPromises(sweep, step))
                    lines.push_back(fmt::format("{}, {}, {}: {}", family.name, sweep.name, step.label, broken));
    return lines;
}

void addFigures(StressRun& run, const ordered_json& document, const std::string& file) {
    try {
        for (const ordered_json& family : document.at("families")) {
            StressFamily* ours = familyNamed(run, family.at("name").get<std::string>());
            if (ours == nullptr) continue;
            for (const ordered_json& sweep : family.at("sweeps"))
                if (StressSweep* into = sweepNamed(*ours, sweep.at("name").get<std::string>()))
                    addToSweep(*into, sweep.at("steps"));
        }
    } catch (const nlohmann::json::exception& error) {
        throwBadInput(file, fmt::format("it is no report of stress tests ({})", error.what()));
    }
}

} // namespace isolux
