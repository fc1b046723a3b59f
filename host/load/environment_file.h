// Reads equirectangular images of an environment.
#pragma once

#include "load/limits.h"
#include "scene/scene.h"

#include <filesystem>

namespace isolux {

/// A Radiance .hdr or OpenEXR image, told by its first bytes, as linear Rec. 709: its first three
/// channels, or the only one repeated; alpha is ignored. Throws Error (bad input) naming the file, and the first texel
/// that is negative or not finite.
[[nodiscard]] std::shared_ptr<const EnvironmentMap> loadEnvironmentMap(const std::filesystem::path& file,
                                                                       const LoadLimits& limits = {});

} // namespace isolux
