#include "load/verify.h"

#include "load/context.h"
#include "load/verify_parts.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <set>

namespace isolux {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 10> kSupportedExtensions = {
    "EXT_texture_webp",     "KHR_lights_punctual",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",    "KHR_materials_specular", "KHR_materials_transmission",
    "KHR_materials_unlit",  "KHR_materials_volume",   "KHR_mesh_quantization",
    "KHR_texture_transform"};

/// The part of "2.1" before and after the dot; fails unless both are numbers.
std::pair<int, int> parseVersion(const JsonReader& version) {
    const std::string& text = version.string();
    const bool isValid = text.size() >= 3 && text.size() <= 8 && text.find('.') != std::string::npos &&
                         text.find_first_not_of("0123456789.") == std::string::npos && text.front() != '.' &&
                         text.back() != '.' && text.find('.') == text.rfind('.');
    if (!isValid) version.fail(fmt::format("'{}' is not a version such as 2.0", printable(text)));
    const std::size_t dot = text.find('.');
    return {std::stoi(text.substr(0, dot)), std::stoi(text.substr(dot + 1))};
}

/// Names of extensions that a list has twice.
void warnOfRepeats(const JsonReader& root, std::string_view list) {
    std::set<std::string> names;
    for (std::size_t i = 0; i < root.sizeOf(list); ++i) {
        const JsonReader entry = root.at(list).element(i);
        if (!names.insert(entry.string()).second)
            entry.warn(fmt::format("{} is listed twice", printable(entry.string())));
    }
}

using VerifyPart = json (*)(const JsonReader& part, const JsonReader& root);

json verifyAll(const JsonReader& root, std::string_view key, VerifyPart verify) {
    json result = json::array();
    const std::size_t count = root.sizeOf(key);
    for (std::size_t i = 0; i < count; ++i) result.push_back(verify(root.at(key).element(i), root));
    return result;
}

} // namespace

bool isSupportedExtension(std::string_view name) {
    return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), name) != kSupportedExtensions.end();
}

void verifyAsset(const JsonReader& root) {
    const JsonReader version = root.at("asset").at("version");
    if (parseVersion(version).first != 2)
        version.fail(fmt::format("glTF {} is not supported; export as glTF 2.0", printable(version.string())));
    const std::optional<JsonReader> minVersion = root.at("asset").find("minVersion");
    if (minVersion && parseVersion(*minVersion) > std::pair(2, 0))
        minVersion->fail(
            fmt::format("a reader of glTF {} is needed; this one reads 2.0", printable(minVersion->string())));
}

/// Where each extension is first used by a material, as a pointer.
std::map<std::string, std::string> firstMaterialsWith(const JsonReader& root) {
    std::map<std::string, std::string> first;
    for (std::size_t i = 0; i < root.sizeOf("materials"); ++i) {
        const std::optional<JsonReader> extensions = root.at("materials").element(i).find("extensions");
        if (!extensions) continue;
        for (const std::string& name : extensions->keys()) first.emplace(name, extensions->pointer());
    }
    return first;
}

json verifyExtensions(const JsonReader& root) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) warnOfRepeats(root, list);
    json required = json::array();
    for (std::size_t i = 0; i < root.sizeOf("extensionsRequired"); ++i) {
        const JsonReader entry = root.at("extensionsRequired").element(i);
        if (const std::string& name = entry.string(); !isSupportedExtension(name))
            entry.fail(fmt::format("the file requires {}, which is not supported; export without it", printable(name)));
        required.push_back(entry.string());
    }
    const std::map<std::string, std::string> materials = firstMaterialsWith(root);
    for (std::size_t i = 0; i < root.sizeOf("extensionsUsed"); ++i) {
        const JsonReader entry = root.at("extensionsUsed").element(i);
        const std::string& name = entry.string();
        if (isSupportedExtension(name)) continue;
        const auto used = materials.find(name);
        root.context().warn(used == materials.end() ? entry.pointer() : used->second,
                            fmt::format("{} is not supported; ignored", printable(name)));
    }
    return required;
}

void copyName(const JsonReader& from, json& to) {
    if (const std::optional<JsonReader> name = from.find("name")) to["name"] = name->string();
}

std::optional<JsonReader> findExtension(const JsonReader& object, std::string_view name) {
    const std::optional<JsonReader> extensions = object.find("extensions");
    return extensions ? extensions->find(name) : std::nullopt;
}

// Extras are the file's own: they may be of any type.
std::optional<JsonReader> findExtra(const JsonReader& object, std::string_view name) {
    const std::optional<JsonReader> extras = object.find("extras");
    return extras && extras->isObject() ? extras->find(name) : std::nullopt;
}

json verifyDocument(const JsonReader& root) {
    verifyAsset(root);
    json document;
    document["asset"] = {{"version", "2.0"}};
    document["extensionsRequired"] = verifyExtensions(root);
    document["bufferViews"] = verifyAll(root, "bufferViews", verifyBufferView);
    document["accessors"] = verifyAll(root, "accessors", verifyAccessor);
    document["meshes"] = verifyAll(root, "meshes", verifyMesh);
    document["cameras"] = verifyAll(root, "cameras", verifyCamera);
    document["extensions"]["KHR_lights_punctual"]["lights"] = verifyLights(root);
    document["nodes"] = verifyAll(root, "nodes", verifyNode);
    document["scenes"] = verifyAll(root, "scenes", verifyScene);
    if (const std::optional<JsonReader> scene = root.find("scene"))
        document["scene"] = scene->index(root.sizeOf("scenes"), "scenes");
    verifyHierarchy(root);
    verifyImages(root);
    verifyReferences(root);
    warnOfMembers(root.value(), root.context());
    return document;
}

} // namespace isolux
