// The parts of verify.h, one function per kind of object, private to the verify_*.cpp files.
#pragma once

#include "load/json_reader.h"

namespace isolux {

/// asset.version, and extensions that are required or used.
void verifyAsset(const JsonReader& root);
void verifyExtensions(const JsonReader& root);

[[nodiscard]] nlohmann::json verifyBufferView(const JsonReader& view, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyAccessor(const JsonReader& accessor, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyMaterial(const JsonReader& material, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyMesh(const JsonReader& mesh, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyCamera(const JsonReader& camera, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyNode(const JsonReader& node, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyScene(const JsonReader& scene, const JsonReader& root);

/// That nodes form trees (no node has two parents, none is its own ancestor) and that scenes list roots.
void verifyHierarchy(const JsonReader& root);

/// References among what is not supported yet (textures, images, samplers, skins, animations, lights).
void verifyReferences(const JsonReader& root);

/// Copies a name, if there is one.
void copyName(const JsonReader& from, nlohmann::json& to);

} // namespace isolux
