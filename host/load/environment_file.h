// Reads equirectangular images of an environment.
#pragma once

#include "scene/scene.h"

#include <filesystem>

namespace isolux {

/// A floating-point image that OpenImageIO reads (Radiance .hdr, OpenEXR), as linear Rec. 709: its first three
/// channels, or the only one repeated; alpha is ignored. Throws Error (bad input) naming the file, and the first texel
/// that is negative or not finite.
[[nodiscard]] std::shared_ptr<const EnvironmentMap> loadEnvironmentMap(const std::filesystem::path& file);

} // namespace isolux
