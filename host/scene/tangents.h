// Tangents where a mesh brings none.
#pragma once

#include "scene/scene.h"

namespace isolux {

/// Fills the tangents of a mesh that has normals and the given set of texture coordinates, by the definition of
/// MikkTSpace (Mikkelsen 2008). May split vertices whose triangles disagree.
void generateTangents(Mesh& mesh, std::uint32_t uvSet);

} // namespace isolux
