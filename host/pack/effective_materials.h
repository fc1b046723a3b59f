// What a scene's materials come to once maps that say nothing are taken out of them.
#pragma once

#include "scene/scene.h"

#include <vector>

namespace isolux {

/// The scene's materials, with constant maps multiplied into the factors, flat normal maps removed, and those whose
/// alpha can never hide anything made opaque. They describe the same surfaces.
[[nodiscard]] std::vector<Material> effectiveMaterials(const Scene& scene);

/// Whether a placed mesh has colours other than white, which its material multiplies by.
[[nodiscard]] bool hasVertexColors(const Scene& scene);

} // namespace isolux
