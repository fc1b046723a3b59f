#include "pack/effective_materials.h"

#include "scene/textures.h"

#include <algorithm>

namespace isolux {
namespace {

Vec3d rgb(const glm::dvec4& value) { return {value.r, value.g, value.b}; }

/// Multiplies what a constant map says into the factors of its slot.
void fold(Material& material, MapSlot slot, const glm::dvec4& value) {
    switch (slot) {
    case MapSlot::baseColor:
        material.baseColor *= rgb(value);
        material.alpha *= value.a;
        break;
    case MapSlot::metallicRoughness:
        material.roughness *= value.g;
        material.metallic *= value.b;
        break;
    case MapSlot::normal: break;
    case MapSlot::emission: material.emission *= rgb(value); break;
    case MapSlot::transmission: material.transmission *= value.r; break;
    case MapSlot::thickness: material.thickness *= value.g; break;
    case MapSlot::specular: material.specular *= value.a; break;
    case MapSlot::specularColor: material.specularColor *= rgb(value); break;
    }
}

/// Whether the factors leave a map nothing to say.
bool isIdle(const Material& material, MapSlot slot) {
    switch (slot) {
    case MapSlot::baseColor: return material.baseColor == Vec3d(0.0) && material.alphaMode == AlphaMode::opaque;
    case MapSlot::metallicRoughness:
        return material.unlit || (material.metallic == 0.0 && material.specular == 0.0 && material.transmission == 0.0);
    case MapSlot::normal: return material.unlit || material.normalScale == 0.0;
    case MapSlot::emission: return !material.emits();
    case MapSlot::transmission: return material.unlit || material.transmission == 0.0;
    case MapSlot::thickness: return material.unlit || material.transmission == 0.0 || material.thickness == 0.0;
    case MapSlot::specular: return material.unlit || material.specular == 0.0;
    case MapSlot::specularColor:
        return material.unlit || material.specular == 0.0 || material.specularColor == Vec3d(0.0);
    }
    return false;
}

void simplifyMap(const Scene& scene, Material& material, MapSlot slot) {
    TextureMap& map = material.maps[static_cast<std::size_t>(slot)];
    if (!map.present()) return;
    if (isIdle(material, slot)) {
        map.texture = kNoTexture;
        return;
    }
    // No texel stores a normal that is exactly that of the surface: loaders leave flat maps out by their own tolerance.
    if (slot == MapSlot::normal) return;
    const std::optional<glm::dvec4> constant = constantValue(scene, map, slot);
    if (!constant) return;
    fold(material, slot, *constant);
    map.texture = kNoTexture;
}

/// The least alpha that is stored; no filter makes less of it.
double leastAlpha(const TextureImage& image) {
    double least = 1.0;
    for (const Texel8& texel : image.texels8) least = std::min(least, texel.a / 255.0);
    for (const Texel16& texel : image.texels16) least = std::min(least, texel.a / 65535.0);
    return least;
}

/// The least alpha that vertices of a material's meshes have.
std::vector<double> leastVertexAlpha(const Scene& scene) {
    std::vector<double> least(scene.materials.size(), 1.0);
    for (const Mesh& mesh : scene.meshes)
        for (const glm::vec4& color : mesh.colors)
            least[mesh.material] = std::min(least[mesh.material], static_cast<double>(color.a));
    return least;
}

bool neverHides(const Scene& scene, const Material& material, double vertexAlpha) {
    const TextureMap& map = material.map(MapSlot::baseColor);
    const double ofMap = map.present() ? leastAlpha(scene.images[scene.textures[map.texture].image]) : 1.0;
    const double least = material.alpha * ofMap * vertexAlpha;
    return material.alphaMode == AlphaMode::mask ? least >= material.alphaCutoff : least >= 1.0;
}

} // namespace

std::vector<Material> effectiveMaterials(const Scene& scene) {
    const std::vector<double> vertexAlpha = leastVertexAlpha(scene);
    std::vector<Material> materials = scene.materials;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        Material& material = materials[i];
        if (material.alphaMode != AlphaMode::opaque && neverHides(scene, material, vertexAlpha[i]))
            material.alphaMode = AlphaMode::opaque;
        // Twice: what one map says may leave another nothing to say.
        for (int pass = 0; pass < 2; ++pass)
            for (std::size_t slot = 0; slot < kMapSlots; ++slot)
                simplifyMap(scene, material, static_cast<MapSlot>(slot));
    }
    return materials;
}

bool hasVertexColors(const Scene& scene) {
    return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
        const std::vector<glm::vec4>& colors = scene.meshes[instance.mesh].colors;
        return std::any_of(colors.begin(), colors.end(),
                           [](const glm::vec4& color) { return color != glm::vec4(1.0f); });
    });
}

} // namespace isolux
