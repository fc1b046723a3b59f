// Meshes: references of primitives, and what of them is supported.
#include "load/verify.h"
#include "load/verify_parts.h"

#include <fmt/format.h>

namespace isolux {
namespace {

using nlohmann::json;

constexpr std::uint64_t kTriangles = 4; // the modes before it are points and lines
constexpr std::uint64_t kByte = 5120;
constexpr std::uint64_t kUnsignedByte = 5121;
constexpr std::uint64_t kShort = 5122;
constexpr std::uint64_t kUnsignedShort = 5123;
constexpr std::uint64_t kUnsignedInt = 5125;
constexpr std::uint64_t kFloat = 5126;

JsonReader accessorOf(const JsonReader& reference, const JsonReader& root) {
    return reference.elementOf(root, "accessors");
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

/// The first set of colours multiplies the base colour; glTF gives no others a meaning.
void warnOfColors(const JsonReader& attributes) {
    for (const std::string& name : attributes.keys())
        if (name.starts_with("COLOR_") && name != "COLOR_0")
            attributes.at(name).warn("vertex colours beyond COLOR_0 have no meaning; ignored");
}

json verifyIndices(const JsonReader& indices, const JsonReader& root) {
    const JsonReader accessor = accessorOf(indices, root);
    if (accessor.at("type").string() != "SCALAR" || !isIndexType(accessor.at("componentType").integer()))
        indices.fail("refers to an accessor that is not SCALAR of unsigned bytes, shorts or ints");
    return indices.integer();
}

/// What an attribute may be, beside single precision: the integers of glTF 2.0, 3.7.2.1 and KHR_mesh_quantization.
enum class Integers { smallAny, normalizedSigned, normalizedUnsigned };

struct VertexType {
    std::string_view shape;
    std::string_view otherShape;
    Integers integers;
};

VertexType vertexType(std::string_view name) {
    if (name == "POSITION") return {"VEC3", "VEC3", Integers::smallAny};
    if (name == "NORMAL") return {"VEC3", "VEC3", Integers::normalizedSigned};
    if (name == "TANGENT") return {"VEC4", "VEC4", Integers::normalizedSigned};
    if (name == "COLOR_0") return {"VEC3", "VEC4", Integers::normalizedUnsigned};
    return {"VEC2", "VEC2", Integers::smallAny};
}

bool isKnown(std::string_view name) {
    return name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name == "COLOR_0" ||
           name.starts_with("TEXCOORD_");
}

bool allows(Integers integers, std::uint64_t type, bool isNormalized) {
    switch (integers) {
    case Integers::smallAny: return type != kUnsignedInt;
    case Integers::normalizedSigned: return isNormalized && (type == kByte || type == kShort);
    default: return isNormalized && (type == kUnsignedByte || type == kUnsignedShort);
    }
}

std::string_view describe(Integers integers) {
    switch (integers) {
    case Integers::smallAny: return "unsigned ints";
    case Integers::normalizedSigned: return "integers other than normalized bytes or shorts";
    default: return "integers other than normalized unsigned bytes or shorts";
    }
}

void verifyVertexType(const JsonReader& attribute, std::string_view name, const JsonReader& accessor) {
    const VertexType allowed = vertexType(name);
    const std::string& shape = accessor.at("type").string();
    if (shape != allowed.shape && shape != allowed.otherShape)
        attribute.fail(fmt::format("refers to an accessor of type {}, not {}", shape, allowed.otherShape));
    const std::uint64_t type = accessor.at("componentType").integer();
    const bool isNormalized = accessor.find("normalized") && accessor.at("normalized").boolean();
    if (type != kFloat && !allows(allowed.integers, type, isNormalized))
        attribute.fail(fmt::format("refers to {}, which it cannot be", describe(allowed.integers)));
}

/// Elements of vertices start at multiples of four bytes (glTF 2.0, 3.6.2.4); integers that do not can be read as well.
void warnIfUnaligned(const JsonReader& attribute, const JsonReader& accessor, const JsonReader& root) {
    const std::uint64_t component = accessor.at("componentType").integer();
    if (component == kFloat || !accessor.find("bufferView")) return;
    const JsonReader view = root.at("bufferViews").element(accessor.at("bufferView").integer());
    const std::uint64_t width = component == kByte || component == kUnsignedByte ? 1 : 2;
    const std::uint64_t tight = width * static_cast<std::uint64_t>(accessor.at("type").string().back() - '0');
    const std::uint64_t stride = view.find("byteStride") ? view.at("byteStride").integer() : tight;
    const std::uint64_t offset = accessor.find("byteOffset") ? accessor.at("byteOffset").integer() : 0;
    if (stride % 4 != 0 || offset % 4 != 0)
        attribute.warn("vertices do not start at multiples of four bytes, as glTF asks; read as they lie");
}

/// Whether an attribute's type is one that KHR_mesh_quantization adds; glTF itself has small coordinates and colours.
bool isQuantised(std::string_view name, const JsonReader& accessor) {
    const std::uint64_t type = accessor.at("componentType").integer();
    if (type == kFloat || name == "COLOR_0" || !isKnown(name)) return false;
    const bool isUnsigned = type == kUnsignedByte || type == kUnsignedShort;
    const bool isNormalized = accessor.find("normalized") && accessor.at("normalized").boolean();
    return !(name.starts_with("TEXCOORD_") && isUnsigned && isNormalized);
}

/// Integer vertices are an extension, and a file that has them must require it; they mean the same without.
void warnIfUndeclared(const JsonReader& primitive, const JsonReader& root) {
    for (std::size_t i = 0; i < root.sizeOf("extensionsRequired"); ++i)
        if (root.at("extensionsRequired").element(i).string() == "KHR_mesh_quantization") return;
    const JsonReader attributes = primitive.at("attributes");
    for (const std::string& name : attributes.keys()) {
        if (!isQuantised(name, accessorOf(attributes.at(name), root))) continue;
        primitive.warn("integer vertices without KHR_mesh_quantization in extensionsRequired; read as that extension "
                       "has them");
        return;
    }
}

/// What the material's maps ask for and the primitive does not have.
void warnOfMissingSets(const JsonReader& primitive, const JsonReader& material) {
    const JsonReader attributes = primitive.at("attributes");
    for (const std::uint32_t set : uvSetsOf(material))
        if (!attributes.find(fmt::format("TEXCOORD_{}", set)))
            primitive.warn(
                fmt::format("it has no TEXCOORD_{}, which maps of its material use; they are left out", set));
}

json verifyAttributes(const JsonReader& attributes, const JsonReader& root) {
    json result = json::object();
    for (const std::string& name : attributes.keys()) {
        if (!isKnown(name)) continue;
        const JsonReader attribute = attributes.at(name);
        const JsonReader accessor = accessorOf(attribute, root);
        verifyVertexType(attribute, name, accessor);
        warnIfUnaligned(attribute, accessor, root);
        result[name] = attribute.integer();
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
    warnOfColors(attributes);
    warnIfUndeclared(primitive, root);
    if (const std::optional<JsonReader> indices = primitive.find("indices"))
        result["attributes"][kIndicesAttribute] = verifyIndices(*indices, root);
    if (const std::optional<JsonReader> material = primitive.find("material")) {
        result["material"] = material->index(root.sizeOf("materials"), "materials");
        warnOfMissingSets(primitive, material->elementOf(root, "materials"));
    }
    const std::uint64_t mode = primitive.find("mode") ? primitive.at("mode").integerBetween(0, 6) : kTriangles;
    if (mode < kTriangles) primitive.warn("points and lines are not supported; left out");
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
