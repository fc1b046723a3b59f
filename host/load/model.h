// The clean document as tinygltf's typed model. tinygltf gets no buffers, no images and no way to open a file.
#pragma once

#include "load/json_reader.h"

#include <tiny_gltf.h>

namespace isolux {

/// Parses a document made by verifyDocument; bytes of buffers stay outside the model.
[[nodiscard]] tinygltf::Model parseModel(const nlohmann::json& verified, const LoadContext& context);

} // namespace isolux
