// The rays that every intersector is timed on, the same on every run and every machine.
#pragma once

#include "reference/ray_caster.h"
#include "scene/render_settings.h"
#include "scene/scene.h"

#include <vector>

namespace isolux::bench {

using Rays = std::vector<Ray<float>>;

struct RaySets {
    Rays primary; ///< from the camera through every pixel, pixels one after the other
    Rays bounce;  ///< one from each first hit, cosine-distributed about its normal, in the order of `primary`
};

[[nodiscard]] RaySets makeRaySets(const Scene& scene, const World<float>& world, const RayCaster<float>& caster,
                                  const RenderSettings& settings);

} // namespace isolux::bench
