// Scenes in which surfaces coincide: a piece that lies askew in the world, as often as wanted at the same spot.
#pragma once

#include "scene/scene.h"

#include <cstdint>

namespace isolux::test {

/// How often a piece lies at its spot.
enum class Copies : std::uint32_t { one = 1, two = 2, three = 3 };

/// What lights the scene, besides nothing: a white environment of radiance 1, or a lamp above the floor.
enum class LitBy { environment, lamp };

/// How a floor lies: in a plane of the axes, where rounding moves nothing, or so that no coordinate is a round number.
enum class Lie { level, askew };

/// The albedo of floors: powers of two, which no product rounds.
inline const Vec3d kFloorAlbedo(0.5, 0.25, 0.125);

/// A floor, all that its camera sees.
[[nodiscard]] Scene floorScene(Copies copies, LitBy light, Lie lie);

/// The same with a smaller tile of the same material in the floor's plane, cut otherwise. The floor is level.
[[nodiscard]] Scene tiledFloorScene(LitBy light);

/// A slab of glass over a floor, so often at its spot; a solid that absorbs, or two thin walls if `thickness` is 0.
[[nodiscard]] Scene slabScene(Copies copies, LitBy light, double thickness);

} // namespace isolux::test
