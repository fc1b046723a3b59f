// A material as the file has it, before its textures are read: what meshes need to know of it.
#pragma once

#include "scene/scene.h"

namespace isolux {

struct FileMaterial {
    Material material;                   ///< its maps name the file's textures, and their sets by position in `uvSets`
    std::vector<std::uint32_t> uvSets{}; ///< the sets that its maps use: n of the file's TEXCOORD_n, in ascending order
};

/// Takes a material whose maps name sets as the file does. Sets are numbered anew, since the file's numbers may be of
/// any size, and meshes keep no other sets.
[[nodiscard]] FileMaterial numberUvSets(Material material);

/// The same without the maps that use one of the file's sets `missing`.
[[nodiscard]] FileMaterial withoutUvSets(const FileMaterial& source, const std::vector<std::uint32_t>& missing);

/// What a primitive without a material has (glTF 2.0, 3.9.6 and 5.19): a white metal of roughness 1.
[[nodiscard]] Material defaultMaterial();

} // namespace isolux
