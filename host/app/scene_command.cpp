// `isolux scene`: what is in a file, what of it is supported, and what it costs to hold.
#include "app/commands.h"
#include "app/environment_options.h"
#include "app/feature_options.h"
#include "load/gltf.h"
#include "pack/packed_scene.h"
#include "pack/scene_features.h"
#include "report/format.h"
#include "scene/lights.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace isolux {
namespace {

using nlohmann::ordered_json;

struct LightCounts {
    std::size_t area = 0;
    std::size_t point = 0;
    std::size_t spot = 0;
    std::size_t directional = 0;
    std::size_t environment = 0;
};

struct SceneReport {
    std::string file;
    Scene scene;
    PackedScene packed;
    EnvironmentChoice environment;
    std::vector<FeatureUse> features;
    LightCounts lights;
    std::size_t triangles = 0;     ///< of all instances
    std::size_t meshTriangles = 0; ///< of all meshes once
    std::size_t singleSidedMaterials = 0;
};

LightCounts countLights(const Scene& scene) {
    LightCounts counts;
    for (const Light& light : buildLightTable(scene).lights) {
        if (light.kind == LightKind::area) ++counts.area;
        if (light.kind == LightKind::environment) ++counts.environment;
        if (light.kind != LightKind::punctual) continue;
        const PunctualKind kind = scene.punctualLights[light.index].kind;
        counts.point += kind == PunctualKind::point ? 1 : 0;
        counts.spot += kind == PunctualKind::spot ? 1 : 0;
        counts.directional += kind == PunctualKind::directional ? 1 : 0;
    }
    return counts;
}

SceneReport examine(const std::string& file, const EnvironmentOptions& environment) {
    SceneReport report;
    report.file = file;
    report.scene = loadScene(std::filesystem::path(file));
    report.environment = applyEnvironment(report.scene, environment, {});
    report.packed = packScene(report.scene);
    report.features = explainScene(report.scene, {}, findFeatures(report.scene, {}));
    report.lights = countLights(report.scene);
    report.triangles = primitiveCount(report.scene) - report.scene.spheres.size();
    for (const Mesh& mesh : report.scene.meshes) report.meshTriangles += mesh.triangles.size();
    for (const Material& material : report.scene.materials)
        if (material.isSingleSided()) ++report.singleSidedMaterials;
    return report;
}

std::size_t bytesOf(const PackedScene& packed) {
    return packed.nodes.size() * sizeof(packed.nodes[0]) + packed.primitives.size() * sizeof(packed.primitives[0]) +
           packed.attributes.size() * sizeof(packed.attributes[0]) + packed.tables.size() * sizeof(packed.tables[0]);
}

const char* projectionName(const Camera& camera) {
    return camera.projection == Projection::perspective ? "perspective" : "orthographic";
}

void append(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

// --- Text ---

std::string lightsText(const LightCounts& lights) {
    std::string text;
    const auto add = [&](std::size_t count, const char* name) {
        if (count > 0) append(text, fmt::format("{} {}", count, name));
    };
    add(lights.area, "emitting primitives");
    add(lights.point, "point");
    add(lights.spot, "spot");
    add(lights.directional, "directional");
    add(lights.environment, "environment");
    return text.empty() ? "none: images will be black; --environment 1,1,1 adds one" : text;
}

std::string cameraText(std::size_t index, const Camera& camera) {
    const std::string lens = camera.projection == Projection::perspective
                                 ? fmt::format("{:.4g} degrees high", camera.yfov * 180.0 / kPi)
                                 : fmt::format("{} high", formatNumber(2.0 * camera.ymag));
    return fmt::format("{} '{}', {}, {}, at {}", index, camera.name, projectionName(camera), lens,
                       formatColor(camera.position));
}

std::string contentText(const SceneReport& report) {
    const Scene& scene = report.scene;
    const Box3d bounds = worldBounds(scene);
    std::string text = formatLine("scene", fmt::format("{} ({})", report.file, scene.contentHash));
    text += formatLine("triangles", fmt::format("{}, in {} instances of {} meshes that hold {}", report.triangles,
                                                scene.instances.size(), scene.meshes.size(), report.meshTriangles));
    if (!scene.spheres.empty()) text += formatLine("exact spheres", fmt::format("{}", scene.spheres.size()));
    text += formatLine("materials",
                       fmt::format("{}, {} single-sided", scene.materials.size(), report.singleSidedMaterials));
    text += formatLine("lights", lightsText(report.lights));
    if (const auto environment = summariseEnvironment(scene, report.environment))
        text += formatLine("environment", toText(*environment));
    if (!bounds.empty())
        text += formatLine("bounds", fmt::format("{} to {}", formatColor(bounds.lower), formatColor(bounds.upper)));
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        text += formatLine(i == 0 ? "cameras" : "", cameraText(i, scene.cameras[i]));
    return text;
}

std::string costText(const SceneReport& report) {
    const BvhStatistics& bvh = report.packed.bvh;
    std::string text =
        formatLine("BVH", fmt::format("{} nodes, {} leaves of {:.2f}, depth {}, SAH cost {:.2f}", bvh.nodeCount,
                                      bvh.leafCount, bvh.meanLeafSize, bvh.depth, bvh.sahCost));
    text += formatLine("on devices", fmt::format("{:.1f} KiB, {} four-wide nodes, stack of {} entries",
                                                 static_cast<double>(bytesOf(report.packed)) / 1024.0,
                                                 report.packed.nodes.size(), report.packed.stackBound));
    return text + toText(report.features);
}

void printText(const SceneReport& report) {
    fmt::print("{}{}", contentText(report), costText(report));
    for (const std::string& warning : report.scene.warnings) fmt::print("{}", formatLine("unsupported", warning));
}

// --- JSON ---

ordered_json cameraJson(const Camera& camera) {
    ordered_json json{
        {"name", camera.name}, {"projection", projectionName(camera)}, {"position", toJson(camera.position)}};
    if (camera.projection == Projection::perspective)
        json["yfov"] = camera.yfov;
    else
        json["ymag"] = camera.ymag;
    if (camera.aspectRatio) json["aspectRatio"] = *camera.aspectRatio;
    return json;
}

ordered_json lightsJson(const LightCounts& lights) {
    return {{"area", lights.area},
            {"point", lights.point},
            {"spot", lights.spot},
            {"directional", lights.directional},
            {"environment", lights.environment}};
}

ordered_json bvhJson(const PackedScene& packed) {
    const BvhStatistics& bvh = packed.bvh;
    return {{"nodes", bvh.nodeCount},           {"leaves", bvh.leafCount},
            {"meanLeafSize", bvh.meanLeafSize}, {"depth", bvh.depth},
            {"sahCost", bvh.sahCost},           {"wideNodes", packed.nodes.size()},
            {"stackEntries", packed.stackBound}};
}

ordered_json reportJson(const SceneReport& report) {
    const Scene& scene = report.scene;
    const Box3d bounds = worldBounds(scene);
    ordered_json json{{"schema", kReportSchema},
                      {"report", "scene"},
                      {"file", report.file},
                      {"sceneHash", scene.contentHash},
                      {"triangles", report.triangles},
                      {"meshTriangles", report.meshTriangles},
                      {"spheres", scene.spheres.size()},
                      {"meshes", scene.meshes.size()},
                      {"instances", scene.instances.size()},
                      {"materials", scene.materials.size()},
                      {"singleSidedMaterials", report.singleSidedMaterials},
                      {"lights", lightsJson(report.lights)}};
    const std::optional<EnvironmentSummary> environment = summariseEnvironment(scene, report.environment);
    json["environment"] = environment ? toJson(*environment) : ordered_json();
    json["bounds"] = bounds.empty() ? ordered_json() : ordered_json{toJson(bounds.lower), toJson(bounds.upper)};
    json["cameras"] = ordered_json::array();
    for (const Camera& camera : scene.cameras) json["cameras"].push_back(cameraJson(camera));
    json["bvh"] = bvhJson(report.packed);
    json["deviceBytes"] = bytesOf(report.packed);
    json["features"] = toJson(report.features);
    json["unsupported"] = scene.warnings;
    return json;
}

} // namespace

void addSceneCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("scene", "Show what is in a scene, what it needs and what is not supported");
    auto file = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false);
    auto environment = std::make_shared<EnvironmentOptions>();
    sub->add_option("SCENE", *file, "A glTF 2.0 file (.gltf or .glb)")->required();
    sub->add_flag("--json", *json, "Print JSON");
    addEnvironmentOptions(*sub, *environment);
    sub->footer("\"left out\" is what the kernels are compiled without for this scene.\n"
                "Examples:\n"
                "  isolux scene scene.glb\n"
                "  isolux scene scene.gltf --json");
    sub->callback([file, json, environment, &result] {
        const SceneReport report = examine(*file, *environment);
        if (*json)
            fmt::print("{}", jsonText(reportJson(report)));
        else
            printText(report);
        result = ExitCode::success;
    });
}

} // namespace isolux
