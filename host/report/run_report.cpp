#include "report/run_report.h"

#include "report/format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace isolux {
namespace {

using nlohmann::ordered_json;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double perSecond(std::uint64_t count, double seconds) {
    return seconds > 0.0 ? static_cast<double>(count) / seconds : kUnknown;
}

/// The variance of a pixel's mean luminance.
double luminanceError(const PixelStatistics& pixel) {
    return pixel.sampleCount < 2 ? kUnknown : pixel.luminanceVariance() / static_cast<double>(pixel.sampleCount);
}

std::string sceneText(const RunReport& report) {
    const std::string depth =
        report.maxDepth ? fmt::format("{} bounces at most", *report.maxDepth) : "no limit of bounces";
    return fmt::format("{} ({}), {} x {}, {} samples from {}, seed {}, {}", report.scene, report.sceneHash,
                       report.width, report.height, report.samplesPerPixel, report.firstSample, report.seed, depth);
}

std::string deviceText(const RunReport& report) {
    const std::string driver =
        report.driverName.empty() ? "" : fmt::format(", {} {}", report.driverName, report.driverVersion);
    return fmt::format("{}, {}{}", report.deviceName, report.backend, driver);
}

std::string startUpText(const RunTimings& timings) {
    return fmt::format("{:.3f} s: load {:.3f}, build {:.3f}, upload {:.3f}, compile {:.3f}", timings.startUp(),
                       timings.load, timings.build, timings.upload, timings.compile);
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
    if (report.environment) {
        text += formatLine("environment", fmt::format("{}, {}", formatColor(report.environment->radiance),
                                                      report.environment->extent));
    }
    if (report.timeLimit) text += formatLine("time limit", fmt::format("{} s", formatNumber(*report.timeLimit)));
    if (!report.layers.empty()) text += formatLine("layers", fmt::format("{}", fmt::join(report.layers, ", ")));
    return text;
}

ordered_json environmentJson(const RunReport& report) {
    if (!report.environment) return {};
    return {{"radiance", toJson(report.environment->radiance)}, {"extent", report.environment->extent}};
}

ordered_json timingsJson(const RunTimings& timings) {
    return {{"load", timings.load},       {"build", timings.build},   {"upload", timings.upload},
            {"compile", timings.compile}, {"render", timings.render}, {"device", timings.device.value_or(kUnknown)}};
}

ordered_json deviceJson(const RunReport& report) {
    return {{"backend", report.backend},
            {"name", report.deviceName},
            {"driver", report.driverName},
            {"driverVersion", report.driverVersion}};
}

} // namespace

ImageQuality imageQuality(const Film& film) {
    double luminanceSum = 0.0;
    double varianceSum = 0.0;
    for (const PixelStatistics& pixel : film.pixels) {
        luminanceSum += luminance(pixel.mean);
        varianceSum += luminanceError(pixel);
    }
    const double count = static_cast<double>(film.pixels.size());
    const double meanLuminance = luminanceSum / count;
    return {normalInterval(meanLuminance, std::sqrt(varianceSum) / count),
            std::sqrt(varianceSum / count) / meanLuminance};
}

void describeFilm(RunReport& report, const Film& film) {
    report.width = film.width;
    report.height = film.height;
    report.samplesPerPixel = film.maxSampleCount();
    report.samples = 0;
    for (const PixelStatistics& pixel : film.pixels) report.samples += pixel.sampleCount;
    report.rays = film.rays;
    report.diagnostics = film.diagnostics;
    report.quality = imageQuality(film);
}

double RunReport::raysPerSecond() const { return perSecond(rays, timings.render); }

double RunReport::samplesPerSecond() const { return perSecond(samples, timings.render); }

std::string toText(const RunReport& report) {
    std::string text = formatLine("scene", sceneText(report)) + requestText(report) +
                       formatLine("device", deviceText(report)) + formatLine("start-up", startUpText(report.timings)) +
                       formatLine("render", renderText(report)) + formatLine("speed", speedText(report)) +
                       formatLine("image", qualityText(report.quality)) +
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
            {"environment", environmentJson(report)},
            {"timeLimitSeconds", report.timeLimit ? ordered_json(*report.timeLimit) : ordered_json()},
            {"layers", report.layers},
            {"seconds", timingsJson(report.timings)},
            {"rays", report.rays},
            {"raysPerSecond", report.raysPerSecond()},
            {"samples", report.samples},
            {"samplesPerSecond", report.samplesPerSecond()},
            {"dispatches", report.dispatchCount},
            {"longestDispatchSeconds", report.longestDispatch},
            {"diagnostics", toJson(report.diagnostics)},
            {"explanations", report.explanations},
            {"validationMessages", report.validationMessages},
            {"meanLuminance", toJson(report.quality.meanLuminance)},
            {"relativeRmse", report.quality.relativeRmse}};
}

} // namespace isolux
