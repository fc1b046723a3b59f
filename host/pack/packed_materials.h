// Materials and textures as kernels read them.
#pragma once

#include "pack/tables.h"
#include "scene/scene.h"

#include "shared/scene_records.h"

#include <cstdint>
#include <vector>

namespace isolux {

/// How lengths and radiance of the world come to the device.
struct DeviceUnits {
    double length = 1.0;   ///< device length = this * world length
    double radiance = 1.0; ///< device radiance = this * world radiance
};

/// Where the parts lie in the tables; see RenderParameters.
struct TextureOffsets {
    std::uint32_t records = 0;
    std::uint32_t srgb8 = 0;
    std::uint32_t srgb16 = 0;
    std::uint32_t albedos = 0;
};

class MaterialPacker {
public:
    /// `materials` are the scene's, simplified or not. Keeps the references.
    MaterialPacker(const Scene& scene, const std::vector<Material>& materials, DeviceUnits units);

    /// A record for each material, in order.
    void appendMaterials(Tables& tables) const;
    /// The textures that they use, what decodes them, and the albedos of microfacet lobes if any material has some.
    [[nodiscard]] TextureOffsets appendTextures(Tables& tables) const;

    /// The sets of texture coordinates that maps read, in the order of the sections that hold them.
    [[nodiscard]] const std::vector<std::uint32_t>& uvSets() const { return uvSets_; }

private:
    /// A texture as a material uses it: one record.
    struct Use {
        const TextureMap* map;
        MapSlot slot;
    };

    [[nodiscard]] shared::MaterialRecord record(std::size_t index) const;
    [[nodiscard]] std::uint32_t recordOf(std::size_t material, MapSlot slot) const;
    [[nodiscard]] shared::TextureRecord textureRecord(const Use& use, std::uint32_t firstTexel) const;
    [[nodiscard]] bool usesSrgb(bool wide) const;
    [[nodiscard]] const TextureImage& imageOf(const Use& use) const;

    const Scene& scene_;
    const std::vector<Material>& materials_;
    DeviceUnits units_;
    std::vector<Use> uses_;
    std::vector<std::uint32_t> firstUse_; ///< of each material
    std::vector<std::uint32_t> uvSets_;
};

/// The bits of a material's flags, kMaterial....
[[nodiscard]] std::uint32_t materialFlags(const Material& material);

} // namespace isolux
