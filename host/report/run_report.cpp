#include "report/run_report.h"

#include "report/format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

using nlohmann::ordered_json;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double perSecond(std::uint64_t count, double seconds) {
    return seconds > 0.0 ? static_cast<double>(count) / seconds : kUnknown;
}

double ratio(std::uint64_t count, std::uint64_t whole) {
    return whole > 0 ? static_cast<double>(count) / static_cast<double>(whole) : kUnknown;
}

/// The variance of a pixel's mean luminance.
double luminanceError(const PixelStatistics& pixel) {
    return pixel.sampleCount < 2 ? kUnknown : pixel.luminanceVariance() / static_cast<double>(pixel.sampleCount);
}

/// Samples of replicate r of every pixel, as one estimate of the image's mean luminance.
struct ReplicateMean {
    double luminance = 0.0;
    double weight = 0.0; ///< samples; 0 if a pixel has none
};

ReplicateMean replicateMean(const Film& film, std::size_t replicate) {
    double luminanceSum = 0.0;
    double samples = 0.0;
    for (const PixelReplicates& pixel : film.replicates) {
        const auto count = static_cast<double>(pixel.sampleCount[replicate]);
        if (count == 0.0) return {};
        luminanceSum += luminance(pixel.sum[replicate]) / count;
        samples += count;
    }
    return {luminanceSum / static_cast<double>(film.replicates.size()), samples};
}

/// Samples depend on each other within a replicate, and pixels may; replicates do not. With weights w, the variance of
/// the weighted mean is sum w (m_r - m)^2 / ((R - 1) sum w), as each m_r has a variance in proportion to 1 / w.
Interval replicateInterval(double estimate, const Film& film) {
    std::vector<ReplicateMean> means;
    double weight = 0.0;
    double center = 0.0;
    for (std::size_t i = 0; i < PixelReplicates::kCount; ++i) {
        const ReplicateMean mean = replicateMean(film, i);
        if (mean.weight == 0.0) continue;
        means.push_back(mean);
        weight += mean.weight;
        center += mean.weight * mean.luminance;
    }
    if (means.size() < 2) return {kUnknown, estimate, kUnknown};
    center /= weight;
    double squares = 0.0;
    for (const ReplicateMean& mean : means)
        squares += mean.weight * (mean.luminance - center) * (mean.luminance - center);
    const double degrees = static_cast<double>(means.size() - 1);
    return studentInterval(estimate, std::sqrt(squares / (degrees * weight)), degrees);
}

/// The same of independent samples, by the variances of the pixels.
Interval pixelInterval(double estimate, const Film& film) {
    double varianceSum = 0.0;
    for (const PixelStatistics& pixel : film.pixels) varianceSum += luminanceError(pixel);
    return normalInterval(estimate, std::sqrt(varianceSum) / static_cast<double>(film.pixels.size()));
}

// --- Text ---

std::string sceneText(const RunReport& report) {
    const std::string depth =
        report.maxDepth ? fmt::format("{} bounces at most", *report.maxDepth) : "no limit of bounces";
    return fmt::format("{} ({}), {} x {}, {}{} samples from {}, seed {}, {}", report.scene, report.sceneHash,
                       report.width, report.height, report.adaptive ? "up to " : "", report.samplesPerPixel,
                       report.firstSample, report.seed, depth);
}

std::string adaptiveText(const AdaptiveSummary& adaptive) {
    return formatLine("adaptive",
                      fmt::format("tolerance {}, {} to {} samples a pixel, {} on average, {:.1f} % of the "
                                  "pixels below the maximum of {}",
                                  formatNumber(adaptive.rule.tolerance), adaptive.least, adaptive.most,
                                  formatNumber(adaptive.mean), 100.0 * adaptive.stoppedShare, adaptive.maximum)) +
           formatLine("", "biased: pixels stop by the noise they happen to have (host/film/README.md says how much)");
}

std::string errorTargetText(const RunReport& report) {
    return fmt::format("relative RMSE {}: {} after {} samples a pixel", formatNumber(*report.errorTarget),
                       report.errorTargetReached() ? "reached" : "not reached", report.samplesPerPixel);
}

std::string deviceText(const RunReport& report) {
    const std::string driver =
        report.driverName.empty() ? "" : fmt::format(", {} {}", report.driverName, report.driverVersion);
    return fmt::format("{}, {}{}", report.deviceName, report.backend, driver);
}

std::string startUpText(const RunTimings& timings) {
    std::string text =
        fmt::format("{:.3f} s: open {:.3f}, load {:.3f}, build {:.3f}, upload {:.3f}, compile {:.3f}",
                    timings.startUp(), timings.open, timings.load, timings.build, timings.upload, timings.compile);
    if (timings.firstPixel) text += fmt::format("; first pixel after {:.2f}", *timings.firstPixel);
    return text;
}

std::string renderText(const RunReport& report) {
    std::string text = fmt::format("{:.3f} s", report.timings.render);
    if (report.timings.device) text += fmt::format(", on the device {:.3f} s", *report.timings.device);
    if (report.dispatchCount == 0) return text;
    return text + fmt::format(", {} dispatches, the longest {:.3f} s", report.dispatchCount, report.longestDispatch);
}

std::string speedText(const RunReport& report) {
    return fmt::format("{} Mrays/s, {} Msamples/s, {} rays", formatNumber(1e-6 * report.raysPerSecond()),
                       formatNumber(1e-6 * report.samplesPerSecond()), report.rays);
}

std::string qualityText(const ImageQuality& quality) {
    return fmt::format("mean luminance {}, estimated relative RMSE {}", formatInterval(quality.meanLuminance),
                       formatNumber(quality.relativeRmse));
}

/// What was asked for besides the scene, a line each; nothing where nothing was.
std::string requestText(const RunReport& report) {
    std::string text;
    if (!report.camera.empty()) text += formatLine("camera", report.camera);
    if (report.environment) text += formatLine("environment", toText(*report.environment));
    if (!report.methods.empty()) text += formatLine("methods", formatMethods(report.methods));
    if (report.timeLimit) text += formatLine("time limit", fmt::format("{} s", formatNumber(*report.timeLimit)));
    if (!report.layers.empty()) text += formatLine("layers", fmt::format("{}", fmt::join(report.layers, ", ")));
    return text;
}

ordered_json adaptiveJson(const RunReport& report) {
    if (!report.adaptive) return {};
    const AdaptiveSummary& adaptive = *report.adaptive;
    return {{"tolerance", adaptive.rule.tolerance},
            {"batch", adaptive.rule.batch},
            {"minSamples", adaptive.rule.minSamples},
            {"maxSamples", adaptive.maximum},
            {"samplesPerPixel", {{"min", adaptive.least}, {"mean", adaptive.mean}, {"max", adaptive.most}}},
            {"stoppedShare", adaptive.stoppedShare},
            {"biased", true}};
}

ordered_json errorTargetJson(const RunReport& report) {
    if (!report.errorTarget) return {};
    return {{"asked", *report.errorTarget},
            {"reached", report.errorTargetReached()},
            {"relativeRmse", report.quality.relativeRmse},
            {"samplesPerPixel", report.samplesPerPixel}};
}

ordered_json testsJson(const RunReport& report) {
    if (report.boxTests + report.primitiveTests == 0) return {};
    return {{"boxes", report.boxTests},
            {"primitives", report.primitiveTests},
            {"boxesPerRay", ratio(report.boxTests, report.rays)},
            {"primitivesPerRay", ratio(report.primitiveTests, report.rays)}};
}

ordered_json timingsJson(const RunTimings& timings) {
    return {{"open", timings.open},
            {"load", timings.load},
            {"build", timings.build},
            {"upload", timings.upload},
            {"compile", timings.compile},
            {"render", timings.render},
            {"device", timings.device.value_or(kUnknown)}};
}

ordered_json specializationJson(const RunReport& report) {
    ordered_json json = ordered_json::object();
    for (const auto& [id, value] : report.specialization) json[std::to_string(id)] = value;
    return json;
}

ordered_json deviceJson(const RunReport& report) {
    return {{"backend", report.backend},
            {"name", report.deviceName},
            {"driver", report.driverName},
            {"driverVersion", report.driverVersion}};
}

} // namespace

std::string formatMethods(const std::vector<MethodChoice>& methods) {
    std::string text;
    for (const MethodChoice& method : methods)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", method.option, method.value);
    return text;
}

ordered_json toJson(const std::vector<MethodChoice>& methods) {
    ordered_json json = ordered_json::object();
    for (const MethodChoice& method : methods) json[method.option] = method.value;
    return json;
}

std::string toText(const EnvironmentSummary& environment) {
    const char* origin = environment.origin == SkyOrigin::byDefault ? ", the sky of scenes without a light" : "";
    const std::string color = formatColor(environment.radiance);
    if (environment.map.empty()) return fmt::format("{}, {}{}", color, environment.extent, origin);
    return fmt::format("{}, times {}, turned by {} degrees", environment.map, color,
                       formatNumber(environment.rotation));
}

ordered_json toJson(const EnvironmentSummary& environment) {
    const bool constant = environment.map.empty();
    return {{"radiance", toJson(environment.radiance)},
            {"extent", environment.extent},
            {"map", constant ? ordered_json() : ordered_json(environment.map)},
            {"rotationDegrees", constant ? ordered_json() : ordered_json(environment.rotation)},
            {"default", environment.origin == SkyOrigin::byDefault}};
}

std::string toText(const std::vector<FeatureUse>& features) {
    std::size_t width = 0;
    for (const FeatureUse& feature : features) width = std::max(width, feature.name.size());
    std::string text;
    for (const FeatureUse& feature : features)
        text +=
            formatLine(text.empty() ? "kernels" : "", fmt::format("{:{}}  {:8}  {}", feature.name, width,
                                                                  feature.used ? "has" : "left out", feature.reason));
    return text;
}

ordered_json toJson(const std::vector<FeatureUse>& features) {
    ordered_json json = ordered_json::object();
    for (const FeatureUse& feature : features)
        json[feature.name] = {{"used", feature.used}, {"reason", feature.reason}};
    return json;
}

ImageQuality imageQuality(const Film& film) {
    double luminanceSum = 0.0;
    for (const PixelStatistics& pixel : film.pixels) luminanceSum += luminance(pixel.mean);
    const double estimate = luminanceSum / static_cast<double>(film.pixels.size());
    return {film.replicates.empty() ? pixelInterval(estimate, film) : replicateInterval(estimate, film),
            estimatedRelativeRmse(film)};
}

AdaptiveSummary summariseAdaptive(const Film& film, const AdaptiveRule& rule, std::uint64_t maximum) {
    std::uint64_t samples = 0;
    std::uint64_t stopped = 0;
    for (const PixelStatistics& pixel : film.pixels) {
        samples += pixel.sampleCount;
        stopped += pixel.sampleCount < maximum ? 1 : 0;
    }
    const std::uint64_t pixels = film.pixels.size();
    return {
        rule, maximum, film.minSampleCount(), film.maxSampleCount(), ratio(samples, pixels), ratio(stopped, pixels)};
}

std::string formatTestsPerRay(std::uint64_t boxes, std::uint64_t primitives, std::uint64_t rays) {
    return fmt::format("{} boxes and {} primitives", formatNumber(ratio(boxes, rays)),
                       formatNumber(ratio(primitives, rays)));
}

void describeFilm(RunReport& report, const Film& film) {
    report.width = film.width;
    report.height = film.height;
    report.samplesPerPixel = film.maxSampleCount();
    report.samples = 0;
    for (const PixelStatistics& pixel : film.pixels) report.samples += pixel.sampleCount;
    report.rays = film.rays;
    report.boxTests = film.boxTests;
    report.primitiveTests = film.primitiveTests;
    report.diagnostics = film.diagnostics;
    report.quality = imageQuality(film);
}

double RunReport::raysPerSecond() const { return perSecond(rays, timings.render); }

double RunReport::samplesPerSecond() const { return perSecond(samples, timings.render); }

bool RunReport::errorTargetReached() const { return errorTarget && quality.relativeRmse <= *errorTarget; }

std::string toText(const RunReport& report) {
    std::string text = formatLine("scene", sceneText(report)) + requestText(report) +
                       formatLine("device", deviceText(report)) + formatLine("start-up", startUpText(report.timings)) +
                       formatLine("render", renderText(report)) + formatLine("speed", speedText(report));
    if (report.boxTests + report.primitiveTests > 0)
        text += formatLine("tests", formatTestsPerRay(report.boxTests, report.primitiveTests, report.rays) + " a ray");
    if (report.adaptive) text += adaptiveText(*report.adaptive);
    if (report.errorTarget) text += formatLine("until error", errorTargetText(report));
    text += formatLine("image", qualityText(report.quality)) +
            formatLine("diagnostics", formatDiagnostics(report.diagnostics));
    for (const std::string& explanation : report.explanations) text += formatLine("note", explanation);
    for (const std::string& message : report.validationMessages) text += formatLine("validation", message);
    return text;
}

ordered_json toJson(const RunReport& report) {
    return {{"schema", kReportSchema},
            {"report", "run"},
            {"scene", report.scene},
            {"sceneHash", report.sceneHash},
            {"device", deviceJson(report)},
            {"width", report.width},
            {"height", report.height},
            {"samplesPerPixel", report.samplesPerPixel},
            {"firstSample", report.firstSample},
            {"seed", report.seed},
            {"maxDepth", report.maxDepth ? ordered_json(*report.maxDepth) : ordered_json()},
            {"camera", report.camera.empty() ? ordered_json() : ordered_json(report.camera)},
            {"environment", report.environment ? toJson(*report.environment) : ordered_json()},
            {"methods", toJson(report.methods)},
            {"timeLimitSeconds", report.timeLimit ? ordered_json(*report.timeLimit) : ordered_json()},
            {"adaptive", adaptiveJson(report)},
            {"untilError", errorTargetJson(report)},
            {"layers", report.layers},
            {"features", toJson(report.features)},
            {"specialization", specializationJson(report)},
            {"seconds", timingsJson(report.timings)},
            {"firstPixelSeconds", report.timings.firstPixel.value_or(kUnknown)},
            {"rays", report.rays},
            {"raysPerSecond", report.raysPerSecond()},
            {"tests", testsJson(report)},
            {"samples", report.samples},
            {"samplesPerSecond", report.samplesPerSecond()},
            {"dispatches", report.dispatchCount},
            {"longestDispatchSeconds", report.longestDispatch},
            {"sceneBytes", report.sceneBytes},
            {"diagnostics", toJson(report.diagnostics)},
            {"explanations", report.explanations},
            {"validationMessages", report.validationMessages},
            {"meanLuminance", toJson(report.quality.meanLuminance)},
            {"relativeRmse", report.quality.relativeRmse}};
}

} // namespace isolux
