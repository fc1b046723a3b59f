#include "pack/packed_materials.h"

#include "core/srgb.h"
#include "scene/albedo_tables.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

namespace isolux {
namespace {

static_assert(shared::kReflectionAngles == kAlbedoAngles && shared::kReflectionRoughnesses == kAlbedoRoughnesses);
static_assert(shared::kFresnelTableAngles == kFresnelAngles && shared::kGlassTableAngles == kGlassAngles);
static_assert(shared::kGlassTableRoughnesses == kGlassRoughnesses && shared::kGlassTableIndices == kGlassIndices);
static_assert(shared::kWrapMirrored == static_cast<std::uint32_t>(TextureWrap::mirroredRepeat));
static_assert(shared::kWrapClamp == static_cast<std::uint32_t>(TextureWrap::clampToEdge));

glm::vec4 word(const Vec3d& xyz, double w) { return {Vec3f(xyz), static_cast<float>(w)}; }

/// Per unit of world length; what blocks all light counts as leaving 1e-30 of it.
Vec3d absorption(const Material& material) {
    Vec3d sigma(0.0);
    for (int channel = 0; channel < 3; ++channel)
        sigma[channel] = -std::log(std::max(material.attenuationColor[channel], 1e-30)) / material.attenuationDistance;
    return sigma;
}

template <typename Code> std::vector<float> srgbTable() {
    constexpr std::size_t kLargest = std::numeric_limits<Code>::max();
    std::vector<float> table(kLargest + 1);
    for (std::size_t code = 0; code <= kLargest; ++code)
        table[code] = static_cast<float>(linearFromSrgb(static_cast<double>(code) / static_cast<double>(kLargest)));
    return table;
}

/// Every node with its neighbours, so that one word serves a bilinear lookup.
void appendAlbedo(Tables& tables, std::span<const float> values, std::size_t angles, std::size_t roughnesses) {
    const auto at = [&](std::size_t slice, std::size_t y, std::size_t x) {
        return values[(slice * roughnesses + std::min(y, roughnesses - 1)) * angles + std::min(x, angles - 1)];
    };
    for (std::size_t slice = 0; slice < values.size() / (angles * roughnesses); ++slice)
        for (std::size_t y = 0; y < roughnesses; ++y)
            for (std::size_t x = 0; x < angles; ++x)
                tables.append(
                    glm::vec4(at(slice, y, x), at(slice, y, x + 1), at(slice, y + 1, x), at(slice, y + 1, x + 1)));
}

bool needsReflectionAlbedo(const Material& material) {
    return material.metallic > 0.0 || material.specular > 0.0 || material.transmission > 0.0;
}

/// The largest table by far.
bool needsGlassAlbedo(const Material& material) {
    return material.transmission > 0.0 && material.thickness > 0.0 && material.roughness > 0.0;
}

} // namespace

std::uint32_t materialFlags(const Material& material) {
    std::uint32_t flags = 0;
    if (material.doubleSided) flags |= shared::kMaterialTwoSided;
    if (material.alphaMode == AlphaMode::mask) flags |= shared::kMaterialMask;
    if (material.alphaMode == AlphaMode::blend) flags |= shared::kMaterialBlend;
    if (material.unlit) flags |= shared::kMaterialUnlit;
    return flags;
}

MaterialPacker::MaterialPacker(const Scene& scene, const std::vector<Material>& materials, DeviceUnits units)
    : scene_(scene), materials_(materials), units_(units) {
    for (const Material& material : materials) {
        firstUse_.push_back(static_cast<std::uint32_t>(uses_.size()));
        for (std::size_t slot = 0; slot < kMapSlots; ++slot)
            if (material.maps[slot].present()) uses_.push_back({&material.maps[slot], static_cast<MapSlot>(slot)});
    }
    for (const Use& use : uses_)
        if (std::find(uvSets_.begin(), uvSets_.end(), use.map->uvSet) == uvSets_.end())
            uvSets_.push_back(use.map->uvSet);
}

const TextureImage& MaterialPacker::imageOf(const Use& use) const {
    return scene_.images[scene_.textures[use.map->texture].image];
}

std::uint32_t MaterialPacker::recordOf(std::size_t material, MapSlot slot) const {
    if (!materials_[material].map(slot).present()) return shared::kNone;
    const auto end = material + 1 < firstUse_.size() ? firstUse_[material + 1] : uses_.size();
    std::uint32_t index = firstUse_[material];
    while (index < end && uses_[index].slot != slot) ++index;
    return index;
}

shared::MaterialRecord MaterialPacker::record(std::size_t index) const {
    const Material& material = materials_[index];
    const Vec3d emission = material.emits() ? material.emission * units_.radiance : Vec3d(0.0);
    const auto map = [&](MapSlot slot) { return recordOf(index, slot); };
    return {word(material.baseColor, material.alpha),
            {Vec3f(emission), std::bit_cast<float>(materialFlags(material))},
            word({material.metallic, material.roughness, material.ior}, material.alphaCutoff),
            word(material.specularColor, material.specular),
            word({material.transmission, material.thickness > 0.0 ? 1.0 : 0.0, material.normalScale}, 0.0),
            word(absorption(material) / units_.length, 0.0),
            {map(MapSlot::baseColor), map(MapSlot::metallicRoughness), map(MapSlot::normal), map(MapSlot::emission)},
            {map(MapSlot::transmission), map(MapSlot::thickness), map(MapSlot::specular), map(MapSlot::specularColor)}};
}

void MaterialPacker::appendMaterials(Tables& tables) const {
    for (std::size_t i = 0; i < materials_.size(); ++i) tables.append(record(i));
}

shared::TextureRecord MaterialPacker::textureRecord(const Use& use, std::uint32_t firstTexel) const {
    const Texture& texture = scene_.textures[use.map->texture];
    const TextureImage& image = imageOf(use);
    const auto section = std::find(uvSets_.begin(), uvSets_.end(), use.map->uvSet) - uvSets_.begin();
    const std::uint32_t bits = static_cast<std::uint32_t>(texture.wrapU) |
                               (static_cast<std::uint32_t>(texture.wrapV) << shared::kTextureWrapVShift) |
                               (texture.filter == TextureFilter::linear ? shared::kTextureLinearBit : 0u) |
                               (image.texels16.empty() ? 0u : shared::kTexture16Bit) |
                               (static_cast<std::uint32_t>(section) << shared::kTextureUvShift);
    const glm::dmat2& m = use.map->uvFromMesh;
    return {{firstTexel, image.width, image.height, bits},
            {glm::vec2(m[0]), glm::vec2(m[1])},
            {glm::vec2(use.map->offset), 0.0f, 0.0f}};
}

bool MaterialPacker::usesSrgb(bool wide) const {
    return std::any_of(uses_.begin(), uses_.end(),
                       [&](const Use& use) { return isSrgb(use.slot) && imageOf(use).texels16.empty() != wide; });
}

TextureOffsets MaterialPacker::appendTextures(Tables& tables) const {
    TextureOffsets offsets;
    std::map<const TextureImage*, std::uint32_t> firstTexel;
    for (const Use& use : uses_) {
        const TextureImage& image = imageOf(use);
        if (!firstTexel.emplace(&image, tables.next()).second) continue;
        tables.appendAll(std::span(image.texels8));
        tables.appendAll(std::span(image.texels16));
    }
    offsets.records = tables.next();
    for (const Use& use : uses_) tables.append(textureRecord(use, firstTexel.at(&imageOf(use))));
    offsets.srgb8 = tables.next();
    if (usesSrgb(false)) tables.appendAll(std::span<const float>(srgbTable<std::uint8_t>()));
    offsets.srgb16 = tables.next();
    if (usesSrgb(true)) tables.appendAll(std::span<const float>(srgbTable<std::uint16_t>()));
    offsets.albedos = tables.next();
    const auto any = [&](bool (*needs)(const Material&)) {
        return std::any_of(materials_.begin(), materials_.end(), needs);
    };
    if (any(needsReflectionAlbedo)) {
        appendAlbedo(tables, reflectionAlbedo(), kAlbedoAngles, kAlbedoRoughnesses);
        appendAlbedo(tables, fresnelAlbedo(), kFresnelAngles, kAlbedoRoughnesses);
    }
    if (any(needsGlassAlbedo)) appendAlbedo(tables, glassAlbedo(), kGlassAngles, kGlassRoughnesses);
    return offsets;
}

} // namespace isolux
