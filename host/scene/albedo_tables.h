// Directional albedos of the microfacet lobes: what compensates for light that single scattering loses. Written by
// tools/make_albedo_tables.py; both renderers interpolate in them (README.md, "Albedo tables").
#pragma once

#include <cstdint>
#include <span>

namespace isolux {

inline constexpr std::uint32_t kAlbedoAngles = 32;      ///< nodes in x of the reflection table
inline constexpr std::uint32_t kAlbedoRoughnesses = 32; ///< nodes in y, of reflection and Fresnel
inline constexpr std::uint32_t kFresnelAngles = 32;     ///< nodes in sqrt(cosine) of the Fresnel table
inline constexpr std::uint32_t kGlassAngles = 40;
inline constexpr std::uint32_t kGlassRoughnesses = 24;
inline constexpr std::uint32_t kGlassIndices = 48;

/// Albedo of GGX that reflects everything: [roughness][angle], angle first.
[[nodiscard]] std::span<const float> reflectionAlbedo();
/// The average of (1 - cosine at the microfacet)^5 under it: [roughness][angle].
[[nodiscard]] std::span<const float> fresnelAlbedo();
/// Albedo of rough glass, reflection and transmission together: [side][index][roughness][angle]; side 0: the light
/// comes back from the denser medium, i.e. wo lies outside. For ior = 1, index 0, light goes straight on, with the
/// weight G2/G1 of that direction, not 1: the limit of a weak interface.
[[nodiscard]] std::span<const float> glassAlbedo();

} // namespace isolux
