// Vertex attributes of triangles as kernels read them: a section for each kind that is needed, one record a primitive.
#pragma once

#include "scene/scene.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// What surfaces are asked for.
struct AttributeNeeds {
    bool normals = false;
    bool tangents = false;
    bool colors = false;
    std::vector<std::uint32_t> uvSets; ///< in the order of their sections
};

struct PackedAttributes {
    std::vector<glm::vec4> words;
    glm::uvec4 offsets{0u}; ///< RenderParameters::attributeOffsets
};

/// `order`: primitive ids in the order of the records.
[[nodiscard]] PackedAttributes packAttributes(const Scene& scene, const AttributeNeeds& needs,
                                              std::span<const std::uint32_t> order);

} // namespace isolux
