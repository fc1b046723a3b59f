// The CPU path tracer that every other renderer is checked against: reads a Scene, returns a Film.
#pragma once

#include "core/progress.h"
#include "film/film.h"
#include "reference/options.h"
#include "scene/render_settings.h"
#include "scene/scene.h"

#include <cstdint>

namespace isolux {

/// A rectangle of pixels of the whole image, y from the top.
struct PixelRegion {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

/// Renders samples firstSample ... firstSample + sampleCount - 1 of every pixel on all processors; the result does not
/// depend on how many there are. The samples are taken in the passes of a `SamplePlan` over the image, of 1, 1, 2, 4, 8
/// and then 16 samples, until the options' stopping rule ends them. `progress` (may be empty) is called after each
/// pass, and if it answers `Continue::no` the film holds the passes done so far. Throws Error (bad input) if the scene
/// has no camera of the index asked for, or if neither roulette nor a number of bounces ends paths.
[[nodiscard]] Film renderReference(const Scene& scene, const RenderSettings& settings, const ReferenceOptions& options,
                                   const ProgressCallback& progress);

/// The same for some pixels of the image, to look into them: the film is as large as `region`, and its pixel (i, j) is
/// bit for bit what `renderReference` puts at (region.x + i, region.y + j) from the same samples; a stopping rule sees
/// the region alone. Throws Error (bad input) if the region leaves the image.
[[nodiscard]] Film renderReferenceRegion(const Scene& scene, const RenderSettings& settings,
                                         const ReferenceOptions& options, const PixelRegion& region,
                                         const ProgressCallback& progress);

} // namespace isolux
