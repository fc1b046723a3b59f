// What a black or faulty image is a symptom of: gathered from the film, the scene and a few probing rays.
#pragma once

#include "app/backends.h"
#include "report/explain.h"

namespace isolux {

/// The symptoms of a film of the run's scene. Casts rays only if the image is black.
[[nodiscard]] ImageSymptoms gatherSymptoms(const Film& film, const SceneRun& run);

} // namespace isolux
