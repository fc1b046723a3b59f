// The parts of verify.h, one function per kind of object, private to the verify_*.cpp files.
#pragma once

#include "load/json_reader.h"
#include "scene/scene.h"

#include <limits>
#include <set>

namespace isolux {

/// Radiance and intensity become single precision on devices.
constexpr double kLargestRadiance = std::numeric_limits<float>::max();

/// asset.version, and extensions that are required or used.
void verifyAsset(const JsonReader& root);
[[nodiscard]] nlohmann::json verifyExtensions(const JsonReader& root); ///< those required

[[nodiscard]] nlohmann::json verifyBufferView(const JsonReader& view, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyAccessor(const JsonReader& accessor, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyMesh(const JsonReader& mesh, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyCamera(const JsonReader& camera, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyNode(const JsonReader& node, const JsonReader& root);
[[nodiscard]] nlohmann::json verifyScene(const JsonReader& scene, const JsonReader& root);

[[nodiscard]] bool isSupportedExtension(std::string_view name);

/// Whether a component type of an accessor may be that of indices: unsigned integers.
[[nodiscard]] bool isIndexType(std::uint64_t componentType);

/// That nodes form trees (no node has two parents, none is its own ancestor) and that scenes list roots.
void verifyHierarchy(const JsonReader& root);

/// A material's use of a texture (textureInfo); its texture and set are the file's numbers. No texture, with a warning,
/// where there is no image to use.
[[nodiscard]] TextureMap verifyTextureMap(const JsonReader& info, const JsonReader& root);
/// The set of coordinates that a textureInfo asks for, and those of all the textureInfos of a material.
[[nodiscard]] std::uint32_t uvSetOf(const JsonReader& info);
[[nodiscard]] std::set<std::uint32_t> uvSetsOf(const JsonReader& material);
void verifyImages(const JsonReader& root);

/// References among what is not supported yet (skins, animations).
void verifyReferences(const JsonReader& root);

/// Warns of what nothing reads and is wrong all the same: extensions undeclared or out of place, empty arrays.
void warnOfMembers(const nlohmann::json& root, LoadContext& context);

/// The lights of KHR_lights_punctual, and the one that a node refers to.
[[nodiscard]] nlohmann::json verifyLights(const JsonReader& root);
void verifyLightOf(const JsonReader& node, const JsonReader& root, nlohmann::json& result);

/// An object's extension of this name, and its "extras" member of this name, if it is there.
[[nodiscard]] std::optional<JsonReader> findExtension(const JsonReader& object, std::string_view name);
[[nodiscard]] std::optional<JsonReader> findExtra(const JsonReader& object, std::string_view name);

/// Copies a name, if there is one.
void copyName(const JsonReader& from, nlohmann::json& to);

} // namespace isolux
