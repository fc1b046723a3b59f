// Checks an untrusted glTF document and rewrites what is supported as a clean one: known members, known types, indices
// and ranges that hold. tinygltf and everything after it sees the clean document only.
#pragma once

#include "load/file_material.h"
#include "load/file_texture.h"
#include "load/json_reader.h"

namespace isolux {

/// Where the clean document names a primitive's indices, among its attributes: tinygltf refuses indices that have no
/// bufferView, which sparse ones need not have.
constexpr const char* kIndicesAttribute = "_INDICES";

/// The clean document: asset, scenes, nodes, meshes, cameras, accessors and bufferViews. Warns of what it leaves out;
/// throws Error at the pointer of what is wrong.
[[nodiscard]] nlohmann::json verifyDocument(const JsonReader& root);

/// What never passes through tinygltf, in the file's order: no type of its holds more than these.
[[nodiscard]] std::vector<FileMaterial> verifyMaterials(const JsonReader& root);
[[nodiscard]] std::vector<FileTexture> verifyTextures(const JsonReader& root);

} // namespace isolux
