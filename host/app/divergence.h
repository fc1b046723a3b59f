// Where two paths of the same random numbers part: the sample and the bounce.
#pragma once

#include "reference/options.h"
#include "render/path_renderer.h"
#include "report/paired.h"

#include <optional>

namespace isolux {

struct Divergence {
    std::uint32_t sample = 0; ///< absolute index of the first sample that differs
    std::uint32_t bounce = 0; ///< first bounce by whose hit the two paths have met different primitives or decisions
};

/// Looks into one pixel: renders its samples one by one, then with ever fewer bounces, on both sides. `renderer` is the
/// one that made the film; it is left with other samples and another depth. Nothing if the signatures agree.
[[nodiscard]] std::optional<Divergence> findDivergence(PathRenderer& renderer, const Scene& scene,
                                                       const RenderSettings& settings, const PairedPixel& pixel);

} // namespace isolux
