// Texels as materials read them: which one a coordinate meets, its linear value, and whether a map varies at all.
#pragma once

#include "scene/scene.h"

#include <optional>

namespace isolux {

/// A texel's numbers in [0, 1], red, green and blue linear where the slot stores them by the sRGB transfer function.
[[nodiscard]] glm::dvec4 decodedTexel(const TextureImage& image, std::size_t index, MapSlot slot);

/// The index, along an axis of `size` texels, of the texel that the coordinate `s` (in texels) lies in, after wrapping.
/// A coordinate that is not finite counts as 0.
[[nodiscard]] std::uint32_t texelIndex(double s, std::uint32_t size, TextureWrap wrap);

/// The decoded value of a map that is present, at mesh coordinates (u, v), by the nearest texel whatever its filter.
[[nodiscard]] glm::dvec4 nearestValue(const Scene& scene, const TextureMap& map, MapSlot slot, const Vec2d& meshUv);

/// The decoded value of a map that is present, if all texels agree in the channels that the slot reads; the other
/// channels are the first texel's. Stops at the first difference.
[[nodiscard]] std::optional<glm::dvec4> constantValue(const Scene& scene, const TextureMap& map, MapSlot slot);

} // namespace isolux
