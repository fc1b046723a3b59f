#include "app/converge_output.h"

#include "app/output.h"
#include "report/flip.h"
#include "report/format.h"
#include "report/run_report.h"

#include <nlohmann/json.hpp>

#include <set>
#include <utility>

namespace isolux {
namespace {

using nlohmann::ordered_json;

ordered_json seedsOf(const std::vector<ErrorSample>& samples) {
    std::set<std::uint64_t> seeds;
    for (const ErrorSample& sample : samples) seeds.insert(sample.seed);
    return seeds;
}

ordered_json depthOf(const RenderSettings& settings) {
    return settings.maxDepth == kUnlimitedDepth ? ordered_json() : ordered_json(settings.maxDepth);
}

ordered_json toJson(const References& references, const ConvergenceReport& report) {
    const ReferenceQuality& quality = references.meter->quality();
    ordered_json json{{"files", references.files}};
    json.update(isolux::toJson(quality));
    json["tooNoisy"] = tooNoisyFor(report, quality);
    json["method"] = references.method;
    return json;
}

ordered_json toJson(const EqualTimeImages& images) {
    ordered_json variants = ordered_json::array();
    for (const EqualTimeImage& image : images.variants)
        variants.push_back({{"name", image.name},
                            {"image", image.image},
                            {"flip", image.flip},
                            {"samplesPerPixel", image.samplesPerPixel},
                            {"seconds", image.seconds},
                            {"relativeRmse", image.relativeRmse},
                            {"flipMean", image.flipMean}});
    return {{"reference", images.reference}, {"equalTimeSeconds", images.seconds}, {"variants", std::move(variants)}};
}

ordered_json heading() { return {{"schema", kReportSchema}, {"kind", "convergence"}}; }

void addDevice(ordered_json& json, const Device* device) {
    const bool known = device != nullptr;
    json["device"] = known ? device->description().name : "CPU, double precision";
    json["driver"] = known ? ordered_json(device->description().driverName) : ordered_json();
    json["driverVersion"] = known ? ordered_json(device->description().driverVersion) : ordered_json();
}

} // namespace

ordered_json describeScene(const ConvergeScene& scene, const Diagnostics& diagnostics,
                           const std::vector<ErrorSample>& samples, const ConvergenceReport& report) {
    const RenderSettings& settings = scene.run.settings;
    ordered_json json = heading();
    json["scene"] = scene.options.scene.file;
    json["sceneHash"] = scene.run.scene.contentHash;
    json["width"] = settings.width;
    json["height"] = settings.height;
    json["camera"] = scene.run.scene.cameras[settings.camera].name;
    json["maxDepth"] = depthOf(settings);
    json["version"] = ISOLUX_VERSION;
    json["revision"] = nullptr;
    addDevice(json, scene.device);
    json["seeds"] = seedsOf(samples);
    json["flip"] = scene.options.flipSeeds > 0 ? ordered_json{{"pixelsPerDegree", kPixelsPerDegree}} : ordered_json();
    json["reference"] = toJson(scene.references, report);
    json["diagnostics"] = toJson(diagnostics);
    json["truncated"] = {{"maxDepth", depthOf(settings)}, {"clampedSamples", 0}};
    json["command"] = scene.options.commandLine;
    return json;
}

ordered_json describeFit(const ConvergeOptions& options, const std::vector<ErrorSample>& samples) {
    ordered_json json = heading();
    for (const char* unknown : {"scene", "sceneHash", "width", "height", "camera", "maxDepth"}) json[unknown] = nullptr;
    json["version"] = ISOLUX_VERSION;
    json["revision"] = nullptr;
    json["device"] = "";
    for (const char* unknown : {"driver", "driverVersion"}) json[unknown] = nullptr;
    json["seeds"] = seedsOf(samples);
    for (const char* unknown : {"flip", "reference", "diagnostics", "truncated"}) json[unknown] = nullptr;
    json["command"] = options.commandLine;
    return json;
}

void writeReport(const std::filesystem::path& folder, ordered_json description, const ConvergenceReport& report,
                 const std::optional<EqualTimeImages>& images) {
    description.update(toJson(report));
    description["images"] = images ? toJson(*images) : ordered_json();
    writeText((folder / "convergence.json").string(), jsonText(description));
}

} // namespace isolux
