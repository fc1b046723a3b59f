// What stress tests found: families of sweeps of steps, renderer beside renderer, and how far each may be pushed.
#pragma once

#include "film/film.h"
#include "report/statistics.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

inline constexpr const char* kStressDevice = "device";
inline constexpr const char* kStressSingle = "single precision";
inline constexpr const char* kStressDouble = "double precision";

/// A relative bias within this counts as none.
inline constexpr double kStressTolerance = 1e-3;
/// Beyond this the image is wrong by what eyes can see.
inline constexpr double kStressBreakdown = 1e-2;

/// What should not happen, and how often it might have.
struct StressFaults {
    std::uint64_t tried = 0;     ///< samples or rays
    std::uint64_t nonFinite = 0; ///< samples that are NaN or infinite
    std::uint64_t negative = 0;
    std::uint64_t selfHits = 0; ///< rays that met the surface they leave
    std::uint64_t leaks = 0;    ///< rays that got through where nothing is open
    std::uint64_t stackOverflows = 0;
    std::uint64_t invalidIndices = 0;
    std::uint64_t differentBits = 0; ///< pixels or rays whose result should be another's to the last bit

    /// Without what no stiffness excuses.
    [[nodiscard]] bool sound() const { return nonFinite + negative + stackOverflows + invalidIndices == 0; }
    [[nodiscard]] bool clean() const { return sound() && selfHits + leaks + differentBits == 0; }
};

/// Of one renderer at one step.
struct StressFigures {
    std::string renderer;
    double mean = std::numeric_limits<double>::quiet_NaN(); ///< luminance of the image
    Interval bias;  ///< relative, from the double reference on the same random numbers; NaN of that itself
    Interval error; ///< relative, from the answer in closed form; NaN without one
    StressFaults faults;
    double seconds = 0.0;
    std::string failure; ///< why there are no figures, or what was not refused as it should be; else empty

    /// The bias or, without one, the error.
    [[nodiscard]] const Interval& deviation() const;
};

struct StressStep {
    double parameter = 0.0; ///< the stiffness, as the axis has it
    std::string label;      ///< the same in words: "2^-30"
    std::vector<StressFigures> figures;

    [[nodiscard]] const StressFigures* of(const std::string& renderer) const;
};

enum class StressAxis { logarithmic, linear };

struct StressSweep {
    std::string name;  ///< a word or two: "area"
    std::string title; ///< what is done: "a lamp of any size, as bright on the floor"
    std::string axisTitle;
    StressAxis axis = StressAxis::logarithmic;
    std::string limit; ///< what limits the range, derived where it can be
    std::vector<StressStep> steps{};
    /// The parameters between which the device is to be within the tolerance and without faults; beyond, steps show
    /// what happens there.
    double promisedFrom = -std::numeric_limits<double>::infinity();
    double promisedTo = std::numeric_limits<double>::infinity();
};

struct StressFamily {
    std::string name;
    std::string title;
    std::vector<StressSweep> sweeps{};
};

/// What an interval of a relative deviation says.
enum class StressVerdict {
    within,  ///< wholly inside the tolerance
    beyond,  ///< wholly outside
    unknown, ///< it takes more samples to tell
    none     ///< there is no figure
};
[[nodiscard]] StressVerdict verdictOf(const Interval& deviation, double tolerance);

/// What a step needs to count for a range.
enum class StressCriterion {
    holds,        ///< the deviation is within kStressTolerance, and nothing is counted that should not happen
    notBrokenDown ///< the deviation is not beyond kStressBreakdown: for renderers that share no random numbers with the
                  ///< truth
};

/// What is asked of a renderer: of ours that it holds.
[[nodiscard]] StressCriterion criterionFor(const std::string& renderer);

/// How far a renderer gets in a sweep: the longest run of steps that meet the criterion.
struct StressRange {
    std::string first; ///< label; empty without any
    std::string last;
    std::size_t within = 0; ///< steps in it
    std::size_t steps = 0;  ///< steps that the renderer tried
    /// The nearest before and after it, or the first of all without any, that failed or are beyond kStressBreakdown.
    std::vector<std::string> broken;
};
[[nodiscard]] StressRange rangeOf(const StressSweep& sweep, const std::string& renderer,
                                  StressCriterion criterion = StressCriterion::holds);

[[nodiscard]] StressFaults totalFaults(const StressFamily& family, const std::string& renderer);

/// Whether the device is to be right at a step.
[[nodiscard]] bool isPromised(const StressSweep& sweep, const StressStep& step);

/// How many steps the device has taken, and what is known of the promised ones.
struct StressSummary {
    std::size_t steps = 0;
    std::size_t promised = 0;
    std::size_t broken = 0;  ///< steps that break a promise
    std::size_t unknown = 0; ///< promised ones whose interval is too wide to tell
};
[[nodiscard]] StressSummary summarize(const std::vector<StressFamily>& families);
/// "of 652 steps 600 are promised: ..."
[[nodiscard]] std::string toText(const StressSummary& summary);

/// What was not kept to at a step, a line each: at any step a failure or samples that are no light, of the device or of
/// the double reference it is held to; at a promised one any other fault of the device, its bias if that is beyond the
/// tolerance, and an answer in closed form that device or reference contradict.
[[nodiscard]] std::vector<std::string> brokenPromises(const StressSweep& sweep, const StressStep& step);
/// Of all, each with its place.
[[nodiscard]] std::vector<std::string> brokenPromises(const std::vector<StressFamily>& families);

/// What was run on what.
struct StressRun {
    std::string version;
    std::string device;
    std::string driver;
    bool quick = false;
    double seconds = 0.0;
    std::vector<StressFamily> families;
};

/// "none", or every count that is not zero.
[[nodiscard]] std::string formatFaults(const StressFaults& faults);
[[nodiscard]] std::string toText(const StressFamily& family);
[[nodiscard]] nlohmann::ordered_json toJson(const StressRun& run);
/// Adds the figures of other renderers, as toJson writes them, to the steps of the same family, sweep and label. Throws
/// Error (bad input) if the document is none.
void addFigures(StressRun& run, const nlohmann::ordered_json& document, const std::string& file);
/// A page that needs no other file: deviation against stiffness, and every table.
[[nodiscard]] std::string toHtml(const StressRun& run);

} // namespace isolux
