// Buffer views and accessors: every element of every accessor lies in its buffer. Ranges are checked by subtracting
// from what is known to be valid, so that no sum can overflow.
#include "load/verify_parts.h"

#include <fmt/format.h>

#include <limits>

namespace isolux {
namespace {

using nlohmann::json;

constexpr std::uint64_t kLargest = std::uint64_t{1} << 53; // integers beyond are not portable JSON
constexpr std::uint64_t kLargestInt = std::numeric_limits<int>::max();

std::uint64_t integerOr(const JsonReader& object, std::string_view key, std::uint64_t fallback) {
    const std::optional<JsonReader> member = object.find(key);
    return member ? member->integer() : fallback;
}

std::uint64_t componentBytes(const JsonReader& componentType) {
    switch (componentType.integer()) {
    case 5120:
    case 5121: return 1;
    case 5122:
    case 5123: return 2;
    case 5125:
    case 5126: return 4;
    default: componentType.fail(fmt::format("{} is no component type of glTF 2.0", componentType.integer()));
    }
}

/// Bytes of one element; columns of matrices start at multiples of four bytes (glTF 2.0, 3.6.2.4).
std::uint64_t elementBytes(const JsonReader& type, std::uint64_t component) {
    const std::string& name = type.string();
    const auto matrix = [component](std::uint64_t n) { return n * ((n * component + 3) / 4 * 4); };
    if (name == "SCALAR") return component;
    if (name == "VEC2") return 2 * component;
    if (name == "VEC3") return 3 * component;
    if (name == "VEC4") return 4 * component;
    if (name == "MAT2") return matrix(2);
    if (name == "MAT3") return matrix(3);
    if (name == "MAT4") return matrix(4);
    type.fail("is no accessor type of glTF 2.0");
}

struct Layout {
    std::uint64_t count = 0;
    std::uint64_t elementBytes = 0;
    std::uint64_t componentBytes = 0;
};

/// That `layout` fits into `view` from where's byteOffset on, aligned.
void verifyRange(const JsonReader& where, const JsonReader& view, const Layout& layout) {
    const std::uint64_t length = view.at("byteLength").integer();
    const std::uint64_t offset = integerOr(where, "byteOffset", 0);
    const std::uint64_t stride = integerOr(view, "byteStride", layout.elementBytes);
    if (offset > length || layout.elementBytes > length - offset ||
        layout.count - 1 > (length - offset - layout.elementBytes) / stride)
        where.fail(fmt::format("its {} elements of {} bytes from byte {} on do not fit into the {} bytes of {}",
                               layout.count, layout.elementBytes, offset, length, view.pointer()));
    if (stride < layout.elementBytes)
        where.fail(fmt::format("its elements of {} bytes overlap at the byteStride {} of {}", layout.elementBytes,
                               stride, view.pointer()));
    const bool isAligned = offset % layout.componentBytes == 0 && stride % layout.componentBytes == 0 &&
                           integerOr(view, "byteOffset", 0) % layout.componentBytes == 0;
    if (!isAligned)
        where.fail(fmt::format("its data is not aligned to its component size, {} bytes", layout.componentBytes));
}

JsonReader viewOf(const JsonReader& where, const JsonReader& root) {
    return where.at("bufferView").elementOf(root, "bufferViews");
}

/// One half of a sparse accessor: its `indices` or `values`, which lie close together (glTF 2.0, 5.3 and 5.4).
json verifySparsePart(const JsonReader& part, const JsonReader& root, const Layout& layout) {
    const JsonReader view = viewOf(part, root);
    if (integerOr(view, "byteStride", layout.elementBytes) != layout.elementBytes)
        part.fail(fmt::format("{} has a byteStride, which data of a sparse accessor must not have", view.pointer()));
    verifyRange(part, view, layout);
    return {{"bufferView", part.at("bufferView").integer()},
            {"byteOffset", part.find("byteOffset") ? part.at("byteOffset").integerBetween(0, kLargestInt) : 0}};
}

json verifySparse(const JsonReader& sparse, const JsonReader& root, const Layout& base) {
    const std::uint64_t count = sparse.at("count").integerBetween(1, std::min(base.count, kLargestInt));
    const JsonReader indexType = sparse.at("indices").at("componentType");
    const std::uint64_t indexBytes = componentBytes(indexType);
    if (!isIndexType(indexType.integer())) indexType.fail("must be 5121, 5123 or 5125, unsigned integers");
    json result{{"count", count}};
    result["indices"] = verifySparsePart(sparse.at("indices"), root, {count, indexBytes, indexBytes});
    result["indices"]["componentType"] = indexType.integer();
    result["values"] = verifySparsePart(sparse.at("values"), root, {count, base.elementBytes, base.componentBytes});
    return result;
}

} // namespace

bool isIndexType(std::uint64_t componentType) {
    return componentType == 5121 || componentType == 5123 || componentType == 5125;
}

json verifyBufferView(const JsonReader& view, const JsonReader& root) {
    const std::size_t buffer = view.at("buffer").index(root.sizeOf("buffers"), "buffers");
    const std::uint64_t available = root.at("buffers").element(buffer).at("byteLength").integerBetween(1, kLargest);
    const std::uint64_t length = view.at("byteLength").integerBetween(1, kLargest);
    const std::uint64_t offset = integerOr(view, "byteOffset", 0);
    if (offset > available || length > available - offset)
        view.fail(fmt::format("its {} bytes from byte {} on do not fit into the {} bytes of /buffers/{}", length,
                              offset, available, buffer));
    json result{{"buffer", buffer}, {"byteLength", length}, {"byteOffset", offset}};
    if (const std::optional<JsonReader> stride = view.find("byteStride")) {
        if (stride->integerBetween(4, 252) % 4 != 0) stride->fail("must be a multiple of 4");
        result["byteStride"] = stride->integer();
    }
    return result;
}

json verifyAccessor(const JsonReader& accessor, const JsonReader& root) {
    const std::uint64_t count = accessor.at("count").integerBetween(1, kLargest);
    const std::uint64_t component = componentBytes(accessor.at("componentType"));
    const Layout layout{count, elementBytes(accessor.at("type"), component), component};
    json result{{"count", count},
                {"componentType", accessor.at("componentType").integer()},
                {"type", accessor.at("type").string()},
                {"normalized", accessor.find("normalized") && accessor.at("normalized").boolean()},
                {"byteOffset", integerOr(accessor, "byteOffset", 0)}};
    if (accessor.find("bufferView")) {
        verifyRange(accessor, viewOf(accessor, root), layout);
        result["bufferView"] = accessor.at("bufferView").integer();
    }
    if (const std::optional<JsonReader> sparse = accessor.find("sparse"))
        result["sparse"] = verifySparse(*sparse, root, layout);
    return result;
}

} // namespace isolux
