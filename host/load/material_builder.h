// The scene's materials: the file's in their order, then those that a primitive asks for in another form.
#pragma once

#include "load/file_material.h"

#include <map>

namespace isolux {

class MaterialBuilder {
public:
    explicit MaterialBuilder(std::vector<FileMaterial> materials) : materials_(std::move(materials)) {}

    /// The scene's material for an index of the file; the default material for -1.
    [[nodiscard]] std::uint32_t indexOf(int fileMaterial);
    /// That material for a mesh which lacks some of the sets of coordinates that its maps use: without these maps.
    [[nodiscard]] std::uint32_t indexWithout(std::uint32_t material, const std::vector<std::uint32_t>& missing);

    [[nodiscard]] const FileMaterial& at(std::uint32_t material) const { return materials_[material]; }
    /// Every material; its maps' textures are still the file's.
    [[nodiscard]] std::vector<Material> materials() const;

private:
    std::vector<FileMaterial> materials_;
    std::optional<std::uint32_t> default_;
    std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, std::uint32_t> reduced_;
};

} // namespace isolux
