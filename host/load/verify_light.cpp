// Lights of KHR_lights_punctual: kinds, factors and cones in range.
#include "load/verify_parts.h"

#include <fmt/format.h>

#include <numbers>

namespace isolux {
namespace {

using nlohmann::json;

constexpr std::string_view kExtension = "KHR_lights_punctual";

double numberOr(const JsonReader& object, std::string_view key, double fallback) {
    const std::optional<JsonReader> member = object.find(key);
    return member ? member->number() : fallback;
}

/// 0 <= inner < outer <= pi/2, where writers in single precision round pi/2 up.
json verifyCones(const JsonReader& spot) {
    constexpr double kQuarterTurn = std::numbers::pi_v<float> / 2.0f;
    const double inner = numberOr(spot, "innerConeAngle", 0.0);
    const double outer = numberOr(spot, "outerConeAngle", std::numbers::pi / 4.0);
    if (!(outer > 0.0 && outer <= kQuarterTurn))
        spot.at("outerConeAngle").fail(fmt::format("is {} but must lie above 0 and up to pi/2", outer));
    if (!(inner >= 0.0 && inner < outer))
        spot.at("innerConeAngle")
            .fail(fmt::format("is {} but must lie in [0, {}), below the outer angle", inner, outer));
    return {{"innerConeAngle", inner}, {"outerConeAngle", std::min(outer, std::numbers::pi / 2.0)}};
}

json verifyLight(const JsonReader& light) {
    const std::string& type = light.at("type").string();
    if (type != "point" && type != "spot" && type != "directional")
        light.at("type").fail("must be point, spot or directional");
    json result{{"type", type}};
    copyName(light, result);
    const std::optional<JsonReader> color = light.find("color");
    result["color"] = color ? color->numbersBetween(3, 0.0, 1.0) : json{1.0, 1.0, 1.0};
    const std::optional<JsonReader> intensity = light.find("intensity");
    result["intensity"] = intensity ? intensity->numberBetween(0.0, kLargestRadiance) : 1.0;
    if (const std::optional<JsonReader> range = light.find("range")) {
        if (!(range->number() > 0.0)) range->fail(fmt::format("is {} but must be positive", range->number()));
        range->warn("the range of lights, a hint to rasterisers, is ignored");
    }
    if (type == "spot") result["spot"] = verifyCones(light.at("spot"));
    return result;
}

} // namespace

json verifyLights(const JsonReader& root) {
    json result = json::array();
    const std::optional<JsonReader> extension = findExtension(root, kExtension);
    if (!extension) return result;
    const JsonReader lights = extension->at("lights");
    for (std::size_t i = 0; i < lights.size(); ++i) result.push_back(verifyLight(lights.element(i)));
    return result;
}

void verifyLightOf(const JsonReader& node, const JsonReader& root, json& result) {
    const std::optional<JsonReader> reference = findExtension(node, kExtension);
    if (!reference) return;
    const std::optional<JsonReader> lights = findExtension(root, kExtension);
    const std::size_t count = lights ? lights->sizeOf("lights") : 0;
    result["extensions"][std::string(kExtension)]["light"] =
        reference->at("light").index(count, "KHR_lights_punctual lights");
}

} // namespace isolux
