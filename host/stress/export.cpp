#include "stress/export.h"

#include "reference/reference.h"
#include "report/format.h"
#include "stress/film_mean.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <optional>

namespace isolux {
namespace {

using nlohmann::ordered_json;

ordered_json numbers(const std::vector<Vec3f>& vectors) {
    ordered_json json = ordered_json::array();
    for (const Vec3f& vector : vectors)
        for (int i = 0; i < 3; ++i) json.push_back(vector[i]);
    return json;
}

ordered_json numbers(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    ordered_json json = ordered_json::array();
    for (const auto& triangle : triangles)
        for (const std::uint32_t index : triangle) json.push_back(index);
    return json;
}

/// Row by row.
ordered_json matrix(const Mat4d& m) {
    ordered_json json = ordered_json::array();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) json.push_back(m[column][row]);
    return json;
}

ordered_json exported(const Material& material) {
    return {{"baseColor", toJson(material.baseColor)},
            {"emission", toJson(material.emission)},
            {"doubleSided", material.doubleSided},
            {"metallic", material.metallic},
            {"roughness", material.roughness},
            {"ior", material.ior},
            {"specular", material.specular},
            {"transmission", material.transmission},
            {"thickness", material.thickness},
            {"attenuationColor", toJson(material.attenuationColor)},
            {"attenuationDistance", material.attenuationDistance},
            {"opaque", material.alphaMode == AlphaMode::opaque},
            {"unlit", material.unlit}};
}

ordered_json exported(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    return {{"material", mesh.material},
            {"worldFromObject", matrix(instance.worldFromObject)},
            {"positions", numbers(mesh.positions)},
            {"normals", numbers(mesh.normals)},
            {"triangles", numbers(mesh.triangles)}};
}

ordered_json exported(const Camera& camera) {
    Mat4d worldFromCamera(camera.worldFromCamera);
    worldFromCamera[3] = glm::dvec4(camera.position, 1.0);
    return {{"orthographic", camera.projection == Projection::orthographic},
            {"worldFromCamera", matrix(worldFromCamera)},
            {"yfov", camera.yfov},
            {"ymag", camera.ymag}};
}

ordered_json exported(const PunctualLight& light) {
    constexpr std::array kKinds{"point", "spot", "directional"};
    return {{"kind", kKinds[static_cast<std::size_t>(light.kind)]},
            {"position", toJson(light.position)},
            {"direction", toJson(light.direction)},
            {"intensity", toJson(light.intensity)},
            {"cosInner", light.cosInner},
            {"cosOuter", light.cosOuter}};
}

ordered_json exported(const Scene& scene, std::uint32_t camera) {
    ordered_json json{{"camera", exported(scene.cameras.at(camera))},
                      {"environment", toJson(scene.environment.radiance)},
                      {"materials", ordered_json::array()},
                      {"meshes", ordered_json::array()},
                      {"spheres", ordered_json::array()},
                      {"lights", ordered_json::array()}};
    for (const Material& material : scene.materials) json["materials"].push_back(exported(material));
    for (const Instance& instance : scene.instances) json["meshes"].push_back(exported(scene, instance));
    for (const Sphere& sphere : scene.spheres)
        json["spheres"].push_back(
            {{"center", toJson(sphere.center)}, {"radius", sphere.radius}, {"material", sphere.material}});
    for (const PunctualLight& light : scene.punctualLights) json["lights"].push_back(exported(light));
    return json;
}

/// Nothing if it was interrupted.
std::optional<Interval> truthOf(const RenderTrial& trial, std::uint32_t moreSamples, const ProgressCallback& progress) {
    if (trial.expected) {
        const double uncertainty = std::abs(*trial.expected) * trial.expectedUncertainty;
        return Interval{*trial.expected - uncertainty, *trial.expected, *trial.expected + uncertainty};
    }
    RenderSettings settings = trial.settings;
    settings.sampleCount *= moreSamples;
    const Film film = renderReference(trial.scene, settings, {}, progress);
    if (film.minSampleCount() < settings.sampleCount) return std::nullopt;
    return normalInterval(meanLuminance(film), standardError(film));
}

} // namespace

ordered_json exportTrial(const RenderTrial& trial, std::uint32_t moreSamples, const ProgressCallback& progress) {
    const Scene& scene = trial.scene;
    if (!scene.textures.empty() || scene.environment.map || scene.cameras.empty()) return {};
    const std::optional<Interval> truth = truthOf(trial, moreSamples, progress);
    if (!truth) return {};
    const RenderSettings& settings = trial.settings;
    ordered_json json = exported(scene, settings.camera);
    json["width"] = settings.width;
    json["height"] = settings.height;
    json["samples"] = std::uint64_t{settings.sampleCount} * moreSamples;
    json["aperture"] = settings.lens.aperture;
    json["focus"] = settings.lens.focus;
    json["maxDepth"] = settings.maxDepth == kUnlimitedDepth ? ordered_json() : ordered_json(settings.maxDepth);
    json["truth"] = toJson(*truth);
    return json;
}

} // namespace isolux
