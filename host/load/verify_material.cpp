// Materials: factors in range, maps that refer to what exists, and the core's defaults.
#include "load/verify.h"
#include "load/verify_parts.h"

#include <fmt/format.h>

namespace isolux {
namespace {

/// The members that hold what a material is made of.
struct Parts {
    JsonReader material;
    std::optional<JsonReader> pbr = material.find("pbrMetallicRoughness");
    std::optional<JsonReader> ior = findExtension(material, "KHR_materials_ior");
    std::optional<JsonReader> specular = findExtension(material, "KHR_materials_specular");
    std::optional<JsonReader> transmission = findExtension(material, "KHR_materials_transmission");
    std::optional<JsonReader> volume = findExtension(material, "KHR_materials_volume");
    std::optional<JsonReader> emissiveStrength = findExtension(material, "KHR_materials_emissive_strength");
};

using Owner = std::optional<JsonReader>;

std::optional<JsonReader> findIn(const Owner& owner, std::string_view key) {
    return owner ? owner->find(key) : std::nullopt;
}

double factorOr(const Owner& owner, std::string_view key, double fallback) {
    const std::optional<JsonReader> member = findIn(owner, key);
    return member ? member->numberBetween(0.0, 1.0) : fallback;
}

/// A number from zero on, as far as devices can hold it.
double amountOr(const Owner& owner, std::string_view key, double fallback) {
    const std::optional<JsonReader> member = findIn(owner, key);
    return member ? member->numberBetween(0.0, kLargestRadiance) : fallback;
}

Vec3d colorOr(const Owner& owner, std::string_view key, const Vec3d& fallback, double largest) {
    const std::optional<JsonReader> member = findIn(owner, key);
    if (!member) return fallback;
    const nlohmann::json values = member->numbersBetween(3, 0.0, largest);
    return {values[0].get<double>(), values[1].get<double>(), values[2].get<double>()};
}

void readMetallicRoughness(const Parts& parts, Material& material) {
    material.metallic = factorOr(parts.pbr, "metallicFactor", 1.0);
    material.roughness = factorOr(parts.pbr, "roughnessFactor", 1.0);
    const std::optional<JsonReader> color = findIn(parts.pbr, "baseColorFactor");
    if (!color) return;
    const nlohmann::json values = color->numbersBetween(4, 0.0, 1.0);
    material.baseColor = {values[0].get<double>(), values[1].get<double>(), values[2].get<double>()};
    material.alpha = values[3].get<double>();
}

/// KHR_materials_ior: at least 1, or 0 for full reflection at every angle. An index of 1e8 has that to single
/// precision:
/// ((ior - 1)/(ior + 1))^2 = 1 - 4e-8, which rounds to 1 there.
double readIor(const Parts& parts) {
    constexpr double kFullReflection = 1e8;
    const std::optional<JsonReader> ior = findIn(parts.ior, "ior");
    if (!ior) return 1.5;
    if (ior->number() == 0.0) return kFullReflection;
    if (!(ior->number() >= 1.0)) ior->fail(fmt::format("is {} but must be 0 or at least 1", ior->number()));
    return std::min(ior->number(), kFullReflection);
}

void readDielectric(const Parts& parts, Material& material) {
    material.ior = readIor(parts);
    material.specular = factorOr(parts.specular, "specularFactor", 1.0);
    material.specularColor = colorOr(parts.specular, "specularColorFactor", Vec3d(1.0), kLargestRadiance);
    material.transmission = factorOr(parts.transmission, "transmissionFactor", 0.0);
    material.thickness = amountOr(parts.volume, "thicknessFactor", 0.0);
    material.attenuationColor = colorOr(parts.volume, "attenuationColor", Vec3d(1.0), 1.0);
    const std::optional<JsonReader> distance = findIn(parts.volume, "attenuationDistance");
    if (!distance) return;
    material.attenuationDistance = distance->number();
    if (!(material.attenuationDistance > 0.0)) distance->fail("must be positive");
}

void readAlpha(const Parts& parts, Material& material) {
    material.alphaCutoff = amountOr(parts.material, "alphaCutoff", 0.5);
    const std::optional<JsonReader> mode = parts.material.find("alphaMode");
    if (!mode || mode->string() == "OPAQUE") return;
    if (mode->string() == "MASK")
        material.alphaMode = AlphaMode::mask;
    else if (mode->string() == "BLEND")
        material.alphaMode = AlphaMode::blend;
    else
        mode->fail("must be OPAQUE, MASK or BLEND");
}

void readFactors(const Parts& parts, Material& material) {
    readMetallicRoughness(parts, material);
    readDielectric(parts, material);
    readAlpha(parts, material);
    material.emission = amountOr(parts.emissiveStrength, "emissiveStrength", 1.0) *
                        colorOr(parts.material, "emissiveFactor", Vec3d(0.0), 1.0);
    const std::optional<JsonReader> doubleSided = parts.material.find("doubleSided");
    material.doubleSided = doubleSided && doubleSided->boolean();
    material.unlit = findExtension(parts.material, "KHR_materials_unlit").has_value();
}

void readMaps(const Parts& parts, const JsonReader& root, Material& material) {
    const auto read = [&](MapSlot slot, const Owner& owner, std::string_view key) {
        if (const std::optional<JsonReader> info = findIn(owner, key))
            material.maps[static_cast<std::size_t>(slot)] = verifyTextureMap(*info, root);
    };
    read(MapSlot::baseColor, parts.pbr, "baseColorTexture");
    read(MapSlot::metallicRoughness, parts.pbr, "metallicRoughnessTexture");
    read(MapSlot::normal, parts.material, "normalTexture");
    read(MapSlot::emission, parts.material, "emissiveTexture");
    read(MapSlot::transmission, parts.transmission, "transmissionTexture");
    read(MapSlot::thickness, parts.volume, "thicknessTexture");
    read(MapSlot::specular, parts.specular, "specularTexture");
    read(MapSlot::specularColor, parts.specular, "specularColorTexture");
    const std::optional<JsonReader> normal = parts.material.find("normalTexture");
    if (normal && normal->find("scale"))
        material.normalScale = normal->at("scale").numberBetween(-kLargestNormalScale, kLargestNormalScale);
    // Ambient occlusion is what a path tracer computes.
    if (const std::optional<JsonReader> occlusion = parts.material.find("occlusionTexture"))
        (void)occlusion->at("index").index(root.sizeOf("textures"), "textures");
}

/// Maps that multiply zero need no image.
void dropMapsWithoutEffect(Material& material) {
    const auto drop = [&](MapSlot slot) { material.maps[static_cast<std::size_t>(slot)] = {}; };
    if (material.metallic == 0.0 && material.roughness == 0.0) drop(MapSlot::metallicRoughness);
    if (material.normalScale == 0.0) drop(MapSlot::normal);
    if (maxComponent(material.emission) == 0.0) drop(MapSlot::emission);
    if (material.transmission == 0.0) drop(MapSlot::transmission);
    if (material.transmission == 0.0 || material.thickness == 0.0) drop(MapSlot::thickness);
    if (material.specular == 0.0) drop(MapSlot::specular);
    if (material.specular == 0.0 || maxComponent(material.specularColor) == 0.0) drop(MapSlot::specularColor);
}

/// What KHR_materials_unlit leaves of a material.
Material unlitPart(const Material& source) {
    Material material;
    material.name = source.name;
    material.baseColor = source.baseColor;
    material.doubleSided = source.doubleSided;
    material.alphaMode = source.alphaMode;
    material.alpha = source.alpha;
    material.alphaCutoff = source.alphaCutoff;
    material.unlit = true;
    material.maps[static_cast<std::size_t>(MapSlot::baseColor)] = source.map(MapSlot::baseColor);
    return material;
}

void warnOfGlass(const JsonReader& source, const Material& material) {
    const bool isPlain = material.specular == 1.0 && material.specularColor == Vec3d(1.0) &&
                         !material.map(MapSlot::specular).present() && !material.map(MapSlot::specularColor).present();
    if (material.transmission > 0.0 && !isPlain)
        source.warn("KHR_materials_specular plays no part in what transmits; it changes the opaque share alone");
}

} // namespace

FileMaterial verifyMaterial(const JsonReader& source, const JsonReader& root) {
    const Parts parts{source};
    Material material;
    if (const std::optional<JsonReader> name = source.find("name")) material.name = name->string();
    readFactors(parts, material);
    readMaps(parts, root, material);
    if (material.unlit) return numberUvSets(unlitPart(material));
    dropMapsWithoutEffect(material);
    warnOfGlass(source, material);
    return numberUvSets(std::move(material));
}

std::set<std::uint32_t> uvSetsOf(const JsonReader& material) {
    const Parts parts{material};
    std::set<std::uint32_t> sets;
    const auto add = [&](const Owner& owner, std::initializer_list<std::string_view> keys) {
        for (const std::string_view key : keys)
            if (const std::optional<JsonReader> info = findIn(owner, key)) sets.insert(uvSetOf(*info));
    };
    add(material, {"normalTexture", "occlusionTexture", "emissiveTexture"});
    add(parts.pbr, {"baseColorTexture", "metallicRoughnessTexture"});
    add(parts.specular, {"specularTexture", "specularColorTexture"});
    add(parts.transmission, {"transmissionTexture"});
    add(parts.volume, {"thicknessTexture"});
    return sets;
}

std::vector<FileMaterial> verifyMaterials(const JsonReader& root) {
    std::vector<FileMaterial> materials;
    for (std::size_t i = 0; i < root.sizeOf("materials"); ++i) {
        materials.push_back(verifyMaterial(root.at("materials").element(i), root));
        std::string& name = materials.back().material.name;
        if (name.empty()) name = fmt::format("material {}", i);
    }
    return materials;
}

} // namespace isolux
