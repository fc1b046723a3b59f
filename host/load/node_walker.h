// Walks the node trees of a scene: instances, exact spheres, cameras and lights in the world.
#pragma once

#include "load/mesh_builder.h"

namespace isolux {

/// Fills the scene from the given root nodes, in depth-first order; all but its materials, which stay with `materials`.
void walkNodes(const Asset& asset, const std::vector<int>& roots, MaterialBuilder& materials, LoadContext& context,
               Scene& scene);

} // namespace isolux
