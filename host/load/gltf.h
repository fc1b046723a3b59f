// Loads a glTF 2.0 file (.gltf or .glb) as a Scene.
#pragma once

#include "load/bytes.h"
#include "load/limits.h"
#include "scene/scene.h"

#include <filesystem>

namespace isolux {

/// The file's default scene. Throws Error (bad input) naming the file and the JSON pointer of what is wrong; what is
/// merely not supported is left out and named in Scene::warnings.
[[nodiscard]] Scene loadScene(const std::filesystem::path& file);

/// The same of bytes that are in memory already: `file` names them in messages, and its folder is where URIs lead.
[[nodiscard]] Scene loadSceneFromBytes(ByteSpan bytes, const std::filesystem::path& file,
                                       const LoadLimits& limits = {});

} // namespace isolux
