// Tangents for normal maps of meshes that bring none.
#pragma once

#include "scene/scene.h"

#include <cstdint>

namespace isolux {

/// Gives every vertex the tangent that normal maps on this set of texture coordinates, which must exist, are made for:
/// MikkTSpace's (Mikkelsen 2008), the standard that glTF names (2.0, 3.7.2.1). Vertices whose triangles need different
/// tangents are split, all attributes copied. The bitangent cross(normal, tangent) * w points to smaller v, up in the
/// image. Flat meshes use the normals of their triangles. Where no triangle has a tangent it is (1, 0, 0).
void generateTangents(Mesh& mesh, std::uint32_t uvSet);

} // namespace isolux
