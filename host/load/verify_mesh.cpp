// Meshes: references of primitives, and what of them is supported.
#include "load/verify_parts.h"

#include <fmt/format.h>

#include <array>

namespace isolux {
namespace {

using nlohmann::json;

constexpr std::uint64_t kTriangles = 4;
constexpr std::array<std::string_view, 7> kModes = {"POINTS",    "LINES",          "LINE_LOOP",   "LINE_STRIP",
                                                    "TRIANGLES", "TRIANGLE_STRIP", "TRIANGLE_FAN"};

JsonReader accessorOf(const JsonReader& reference, const JsonReader& root) {
    return root.at("accessors").element(reference.index(root.sizeOf("accessors"), "accessors"));
}

/// All attributes of a primitive (or of a morph target of it) have as many elements as its vertices.
void verifyCounts(const JsonReader& attributes, const JsonReader& root, std::uint64_t vertexCount) {
    for (const std::string& name : attributes.keys()) {
        const std::uint64_t count = accessorOf(attributes.at(name), root).at("count").integer();
        if (count != vertexCount)
            attributes.at(name).fail(fmt::format("has {} elements but POSITION has {}", count, vertexCount));
    }
}

void verifyTargets(const JsonReader& primitive, const JsonReader& root, std::uint64_t vertexCount) {
    const std::size_t count = primitive.sizeOf("targets");
    for (std::size_t i = 0; i < count; ++i) verifyCounts(primitive.at("targets").element(i), root, vertexCount);
    if (count > 0) primitive.at("targets").warn("morph targets are not supported; the base shape is rendered");
}

void warnOfAttributes(const JsonReader& attributes) {
    for (const std::string& name : attributes.keys())
        if (name.starts_with("COLOR_")) attributes.at(name).warn("vertex colours are not supported; ignored");
}

json verifyIndices(const JsonReader& indices, const JsonReader& root) {
    const JsonReader accessor = accessorOf(indices, root);
    const std::uint64_t type = accessor.at("componentType").integer();
    if (accessor.at("type").string() != "SCALAR" || (type != 5121 && type != 5123 && type != 5125))
        indices.fail("refers to an accessor that is not SCALAR of unsigned bytes, shorts or ints");
    if (!accessor.find("bufferView"))
        indices.fail("refers to an accessor without a bufferView, which is not supported; store the indices");
    return indices.integer();
}

/// POSITION and NORMAL in single precision; other component types need KHR_mesh_quantization.
json verifyAttributes(const JsonReader& attributes, const JsonReader& root) {
    json result = json::object();
    for (const std::string_view name : {"POSITION", "NORMAL"}) {
        const std::optional<JsonReader> attribute = attributes.find(name);
        if (!attribute) continue;
        if (accessorOf(*attribute, root).at("type").string() != "VEC3")
            attribute->fail("refers to an accessor that is not VEC3");
        result[std::string(name)] = attribute->integer();
    }
    return result;
}

json verifyPrimitive(const JsonReader& primitive, const JsonReader& root) {
    const JsonReader attributes = primitive.at("attributes");
    json result{{"attributes", verifyAttributes(attributes, root)}};
    if (const std::optional<JsonReader> position = attributes.find("POSITION")) {
        const std::uint64_t vertexCount = accessorOf(*position, root).at("count").integer();
        verifyCounts(attributes, root, vertexCount);
        verifyTargets(primitive, root, vertexCount);
    }
    warnOfAttributes(attributes);
    if (const std::optional<JsonReader> indices = primitive.find("indices"))
        result["indices"] = verifyIndices(*indices, root);
    if (const std::optional<JsonReader> material = primitive.find("material"))
        result["material"] = material->index(root.sizeOf("materials"), "materials");
    const std::uint64_t mode = primitive.find("mode") ? primitive.at("mode").integerBetween(0, 6) : kTriangles;
    if (mode != kTriangles) primitive.warn(fmt::format("mode {} is not supported; left out", kModes[mode]));
    result["mode"] = mode;
    return result;
}

} // namespace

json verifyMesh(const JsonReader& mesh, const JsonReader& root) {
    json result;
    copyName(mesh, result);
    result["primitives"] = json::array();
    const JsonReader primitives = mesh.at("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i)
        result["primitives"].push_back(verifyPrimitive(primitives.element(i), root));
    return result;
}

} // namespace isolux
