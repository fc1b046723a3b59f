// Materials: factors in range; what is not Lambertian or not constant over the surface is named in a warning.
#include "load/verify_parts.h"

#include <fmt/format.h>

namespace isolux {
namespace {

using nlohmann::json;

double factorOr(const JsonReader& object, std::string_view key, double fallback) {
    const std::optional<JsonReader> member = object.find(key);
    return member ? member->numberBetween(0.0, 1.0) : fallback;
}

void verifyTexture(const JsonReader& owner, std::string_view key, const JsonReader& root) {
    const std::optional<JsonReader> texture = owner.find(key);
    if (!texture) return;
    (void)texture->at("index").index(root.sizeOf("textures"), "textures");
    texture->warn("textures are not supported; ignored");
}

double verifyEmissiveStrength(const JsonReader& material) {
    const std::optional<JsonReader> extension = findExtension(material, "KHR_materials_emissive_strength");
    if (!extension || !extension->find("emissiveStrength")) return 1.0;
    return extension->at("emissiveStrength").numberBetween(0.0, kLargestRadiance);
}

json verifyBaseColor(const JsonReader& material) {
    const std::optional<JsonReader> pbr = material.find("pbrMetallicRoughness");
    if (!pbr || !pbr->find("baseColorFactor")) return {1.0, 1.0, 1.0, 1.0};
    return pbr->at("baseColorFactor").numbersBetween(4, 0.0, 1.0);
}

/// Lambertian is: no metal, and the dielectric's specular reflection switched off.
void warnUnlessLambertian(const JsonReader& material) {
    const std::optional<JsonReader> pbr = material.find("pbrMetallicRoughness");
    const std::optional<JsonReader> specular = findExtension(material, "KHR_materials_specular");
    const double metallic = pbr ? factorOr(*pbr, "metallicFactor", 1.0) : 1.0;
    const double specularFactor = specular ? factorOr(*specular, "specularFactor", 1.0) : 1.0;
    if (pbr) (void)factorOr(*pbr, "roughnessFactor", 1.0);
    if (metallic != 0.0 || specularFactor != 0.0)
        material.warn("metallic and specular reflection is not supported; the surface is rendered as Lambertian");
}

void verifyTextures(const JsonReader& material, const JsonReader& root) {
    if (const std::optional<JsonReader> pbr = material.find("pbrMetallicRoughness")) {
        verifyTexture(*pbr, "baseColorTexture", root);
        verifyTexture(*pbr, "metallicRoughnessTexture", root);
    }
    for (const std::string_view key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
        verifyTexture(material, key, root);
}

void verifyAlphaMode(const JsonReader& material) {
    const std::optional<JsonReader> mode = material.find("alphaMode");
    if (!mode) return;
    const std::string& name = mode->string();
    if (name != "OPAQUE" && name != "MASK" && name != "BLEND") mode->fail("must be OPAQUE, MASK or BLEND");
    if (name != "OPAQUE") mode->warn(fmt::format("alpha mode {} is not supported; rendered opaque", name));
}

} // namespace

json verifyMaterial(const JsonReader& material, const JsonReader& root) {
    json result;
    copyName(material, result);
    result["pbrMetallicRoughness"] = {{"baseColorFactor", verifyBaseColor(material)}};
    result["emissiveFactor"] = material.find("emissiveFactor")
                                   ? material.at("emissiveFactor").numbersBetween(3, 0.0, 1.0)
                                   : json{0.0, 0.0, 0.0};
    result["extensions"] = {
        {"KHR_materials_emissive_strength", {{"emissiveStrength", verifyEmissiveStrength(material)}}}};
    result["doubleSided"] = material.find("doubleSided") && material.at("doubleSided").boolean();
    warnUnlessLambertian(material);
    verifyTextures(material, root);
    verifyAlphaMode(material);
    return result;
}

} // namespace isolux
