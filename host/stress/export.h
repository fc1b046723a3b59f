// A step's scene as JSON, for renderers that are held against ours.
#pragma once

#include "core/progress.h"
#include "stress/trial.h"

#include <nlohmann/json_fwd.hpp>

namespace isolux {

/// Everything that the scene holds but textures, in full precision, with the settings that decide the image's mean, and
/// under "truth" that mean: [low, estimate, high] of the luminance, in closed form or by the double reference with
/// `moreSamples` times the step's samples. Null for scenes with textures, which are not exported, and if `progress`
/// (may be empty) asks to stop before the truth is whole.
[[nodiscard]] nlohmann::ordered_json exportTrial(const RenderTrial& trial, std::uint32_t moreSamples,
                                                 const ProgressCallback& progress);

} // namespace isolux
