#include "load/file_material.h"

#include <algorithm>

namespace isolux {

FileMaterial numberUvSets(Material material) {
    FileMaterial result{std::move(material)};
    std::vector<std::uint32_t>& sets = result.uvSets;
    for (const TextureMap& map : result.material.maps)
        if (map.present()) sets.push_back(map.uvSet);
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    for (TextureMap& map : result.material.maps)
        if (map.present())
            map.uvSet =
                static_cast<std::uint32_t>(std::lower_bound(sets.begin(), sets.end(), map.uvSet) - sets.begin());
    return result;
}

FileMaterial withoutUvSets(const FileMaterial& source, const std::vector<std::uint32_t>& missing) {
    Material material = source.material;
    for (TextureMap& map : material.maps) {
        if (!map.present()) continue;
        map.uvSet = source.uvSets[map.uvSet];
        if (std::find(missing.begin(), missing.end(), map.uvSet) != missing.end()) map = {};
    }
    return numberUvSets(std::move(material));
}

Material defaultMaterial() {
    Material material;
    material.name = "default";
    material.metallic = 1.0;
    material.roughness = 1.0;
    material.specular = 1.0;
    return material;
}

} // namespace isolux
