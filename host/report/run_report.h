// What a render says of itself: what was rendered, on what, how long it took and how good the image is.
#pragma once

#include "film/film.h"
#include "film/sample_plan.h"
#include "report/statistics.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// What a film tells of its own error. NaN where a pixel has fewer than two samples, as its variance is unknown.
struct ImageQuality {
    Interval meanLuminance; ///< by the replicates' means where the film has them, else by the pixels' variances
    double relativeRmse = std::numeric_limits<double>::quiet_NaN(); ///< estimatedRelativeRmse
};
[[nodiscard]] ImageQuality imageQuality(const Film& film);

/// How a render went about it, where that is not the usual way: an option without its dashes and what it was given.
struct MethodChoice {
    std::string option;
    std::string value;

    friend bool operator==(const MethodChoice&, const MethodChoice&) = default;
};

/// "light-sampling light, roulette constant:0.3"
[[nodiscard]] std::string formatMethods(const std::vector<MethodChoice>& methods);
/// The options as keys.
[[nodiscard]] nlohmann::ordered_json toJson(const std::vector<MethodChoice>& methods);

/// What adaptive sampling did.
struct AdaptiveSummary {
    AdaptiveRule rule;
    std::uint64_t maximum = 0; ///< samples a pixel that were allowed
    std::uint64_t least = 0;   ///< samples a pixel that were taken
    std::uint64_t most = 0;
    double mean = 0.0;
    double stoppedShare = 0.0; ///< of the pixels: those with fewer samples than the maximum
};
[[nodiscard]] AdaptiveSummary summariseAdaptive(const Film& film, const AdaptiveRule& rule, std::uint64_t maximum);

/// Seconds. `render` is wall time from the first dispatch to the last result; start-up is the five before it.
struct RunTimings {
    double open = 0.0; ///< the device
    double load = 0.0;
    double build = 0.0;
    double upload = 0.0;
    double compile = 0.0;
    double render = 0.0;
    std::optional<double> device;     ///< of `render`, measured on the device itself
    std::optional<double> firstPixel; ///< from the start of the process until the first pixels had samples

    [[nodiscard]] double startUp() const { return open + load + build + upload + compile; }
};

enum class SkyOrigin { chosen, byDefault };

/// Radiance from infinitely far away, as far as a report tells of it.
struct EnvironmentSummary {
    Vec3d radiance{0.0};   ///< that of the map is multiplied by it
    std::string extent;    ///< in words: "sphere", "upper half"
    std::string map{};     ///< its file or name; empty: the radiance is the same in all directions
    double rotation = 0.0; ///< of the map, degrees counter-clockwise seen from above
    SkyOrigin origin = SkyOrigin::chosen;
};
[[nodiscard]] std::string toText(const EnvironmentSummary& environment);
[[nodiscard]] nlohmann::ordered_json toJson(const EnvironmentSummary& environment);

/// A part of the kernels that some scenes or options need.
struct FeatureUse {
    std::string name;
    bool used = false; ///< whether this render's kernels have it
    std::string reason;
};

/// A table: what the kernels have, what was left out of them, and why.
[[nodiscard]] std::string toText(const std::vector<FeatureUse>& features);
/// {"used", "reason"} by name.
[[nodiscard]] nlohmann::ordered_json toJson(const std::vector<FeatureUse>& features);

struct RunReport {
    std::string scene;
    std::string sceneHash;
    std::string backend;
    std::string deviceName;
    std::string driverName;
    std::string driverVersion;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint64_t samplesPerPixel = 0; ///< the most samples any pixel holds
    std::uint64_t firstSample = 0;
    std::uint64_t seed = 0;
    std::optional<std::uint32_t> maxDepth; ///< nothing: no limit
    std::string camera;                    ///< its name; empty: it has none
    std::optional<EnvironmentSummary> environment;
    std::vector<MethodChoice> methods;
    std::optional<double> timeLimit;   ///< seconds after which rendering stops, whatever the samples asked for
    std::optional<double> errorTarget; ///< relative RMSE at which rendering stops
    std::optional<AdaptiveSummary> adaptive;
    std::vector<std::string> layers; ///< what the image holds besides radiance: "albedo", ...
    RunTimings timings;
    std::uint64_t rays = 0;
    std::uint64_t boxTests = 0; ///< that and the next: 0 if they were not counted
    std::uint64_t primitiveTests = 0;
    std::uint64_t samples = 0; ///< of all pixels
    std::uint64_t dispatchCount = 0;
    double longestDispatch = 0.0; ///< seconds
    std::uint64_t sceneBytes = 0; ///< of the scene on the device
    std::vector<FeatureUse> features;
    std::map<std::uint32_t, std::uint32_t> specialization; ///< constants of the path kernel, by id
    Diagnostics diagnostics;
    std::vector<std::string> validationMessages; ///< of the Vulkan validation layers, if they were asked for
    ImageQuality quality;
    std::vector<std::string> explanations; ///< of a black or faulty image (explain.h)

    [[nodiscard]] double raysPerSecond() const; ///< of `timings.render`; NaN if that is 0
    [[nodiscard]] double samplesPerSecond() const;
    [[nodiscard]] bool errorTargetReached() const; ///< false while the error is unknown
};

/// "9.4 boxes and 0.84 primitives", of each ray.
[[nodiscard]] std::string formatTestsPerRay(std::uint64_t boxes, std::uint64_t primitives, std::uint64_t rays);

/// Sets what the film itself knows: size, sample counts, rays, tests, diagnostics and quality.
void describeFilm(RunReport& report, const Film& film);

[[nodiscard]] std::string toText(const RunReport& report);
[[nodiscard]] nlohmann::ordered_json toJson(const RunReport& report);

} // namespace isolux
