// How long builds take, how many rays a second are traced, and how many tests that needs.
#pragma once

#include "embree_scene.h"
#include "ray_sets.h"

#include <nlohmann/json_fwd.hpp>

namespace isolux::bench {

/// Threads for whatever runs until it is destroyed: one, or as many as there are processors.
enum class Threads { one, all };

/// What is timed is repeated for at least so long.
struct Effort {
    double seconds = 0.2;
};

/// Seconds of one build: Embree's, and Isolux' binary tree, with the boxes it starts from, and the tree that devices
/// walk.
[[nodiscard]] nlohmann::ordered_json measureBuilds(const World<float>& world, const Effort& effort);

/// Rays a second of Embree and of the CPU reference.
[[nodiscard]] nlohmann::ordered_json measureRays(const World<float>& world, const RayCaster<float>& caster,
                                                 const Rays& rays, const Effort& effort);

/// Box and primitive tests a ray on Isolux' binary tree.
[[nodiscard]] nlohmann::ordered_json countTests(const RayCaster<float>& caster, const Rays& rays);

/// Share of the rays for which Embree's nearest primitive is the reference's.
[[nodiscard]] double agreement(const World<float>& world, const RayCaster<float>& caster, const Rays& rays);

} // namespace isolux::bench
