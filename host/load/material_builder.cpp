#include "load/material_builder.h"

namespace isolux {

std::uint32_t MaterialBuilder::indexOf(int fileMaterial) {
    if (fileMaterial >= 0) return static_cast<std::uint32_t>(fileMaterial);
    if (!default_) {
        default_ = static_cast<std::uint32_t>(materials_.size());
        materials_.push_back({defaultMaterial()});
    }
    return *default_;
}

std::uint32_t MaterialBuilder::indexWithout(std::uint32_t material, const std::vector<std::uint32_t>& missing) {
    if (missing.empty()) return material;
    const auto next = static_cast<std::uint32_t>(materials_.size());
    const auto [entry, isNew] = reduced_.emplace(std::pair(material, missing), next);
    if (isNew) materials_.push_back(withoutUvSets(materials_[material], missing));
    return entry->second;
}

std::vector<Material> MaterialBuilder::materials() const {
    std::vector<Material> result;
    for (const FileMaterial& material : materials_) result.push_back(material.material);
    return result;
}

} // namespace isolux
