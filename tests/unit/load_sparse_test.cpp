// The glTF loader on sparse accessors: what they replace, malformed ones, and claims that nothing stands behind.
#include "unit/load_fixture.h"

#include <limits>

namespace isolux::load_test {
namespace {

/// Makes an accessor sparse: `indices` (unsigned shorts) name the elements that `values` replace.
void makeSparse(json& document, std::size_t accessor, const std::vector<std::uint16_t>& indices,
                const std::string& values) {
    const auto view = [&](const std::string& bytes) {
        document["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", dataUri(bytes)}});
        document["bufferViews"].push_back({{"buffer", document["buffers"].size() - 1}, {"byteLength", bytes.size()}});
        return document["bufferViews"].size() - 1;
    };
    document["accessors"][accessor]["sparse"] = {{"count", indices.size()},
                                                 {"indices", {{"bufferView", view(bytesOf(indices))}}},
                                                 {"values", {{"bufferView", view(values)}}}};
    document["accessors"][accessor]["sparse"]["indices"]["componentType"] = 5123;
}

/// The triangle, whose outer two vertices are replaced: (5, 6, 7), (1, 0, 0), (8, 9, 1).
json sparseDocument() {
    json document = triangleDocument();
    makeSparse(document, 0, {0, 2}, bytesOf<float>({5, 6, 7, 8, 9, 1}));
    return document;
}

TEST_F(LoadTest, SparseVerticesReplaceTheirBase) {
    json document = sparseDocument();
    EXPECT_EQ(load(document).meshes.at(0).positions, (std::vector<Vec3f>{{5, 6, 7}, {1, 0, 0}, {8, 9, 1}}));
    EXPECT_TRUE(load(document).warnings.empty());
    document["accessors"][0].erase("bufferView");
    EXPECT_EQ(load(document).meshes.at(0).positions, (std::vector<Vec3f>{{5, 6, 7}, {0, 0, 0}, {8, 9, 1}}));
}

TEST_F(LoadTest, SparseIntegersAreDecodedAndLieCloseTogether) {
    json document = triangleDocument();
    document["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::string base = bytesOf<std::uint8_t>({1, 1, 1, 99, 2, 2, 2, 99, 3, 3, 3, 99});
    primitiveOf(document)["attributes"]["POSITION"] = addAccessor(document, base, normalized(vectors(5121, 3)));
    document["bufferViews"][1]["byteStride"] = 4;
    makeSparse(document, 1, {1, 2}, bytesOf<std::uint8_t>({51, 0, 0, 0, 255, 0}));
    constexpr float kUb = 255.0f;
    EXPECT_EQ(load(document).meshes.at(0).positions,
              (std::vector<Vec3f>{{1 / kUb, 1 / kUb, 1 / kUb}, {51 / kUb, 0, 0}, {0, 1, 0}}));
}

TEST_F(LoadTest, SparseNormalsAndIndices) {
    json document = triangleDocument();
    json& attributes = primitiveOf(document)["attributes"];
    attributes["NORMAL"] = addAccessor(document, std::string(36, '\0'), vectors(5126, 3));
    makeSparse(document, 1, {1}, bytesOf<float>({0, 0, 1}));
    primitiveOf(document)["indices"] = addAccessor(document, bytesOf<std::uint32_t>({0, 0, 0}), scalars(5125, 3));
    makeSparse(document, 2, {1, 2}, bytesOf<std::uint32_t>({2, 1}));
    for (int withBase = 1; withBase >= 0; --withBase) {
        const Mesh mesh = load(document).meshes.at(0);
        EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 0, 0}, {0, 0, 1}, {0, 0, 0}}));
        EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1}}));
        document["accessors"][2].erase("bufferView");
    }
}

TEST_F(LoadTest, MalformedSparseAccessorsAreRefusedByPointer) {
    const std::vector<std::tuple<const char*, const char*, json>> cases = {
        {"/accessors/0/sparse/count: is 4 but must lie in [1, 3]", "count", 4},
        {"/accessors/0/sparse/count: is 0 but", "count", 0},
        {"/accessors/0/sparse/count: must be a non-negative integer", "count", -1},
        {"/accessors/0/sparse/count: is 4611686018427387904", "count", std::uint64_t{1} << 62},
        {"/accessors/0/sparse/indices: its 3 elements of 2 bytes", "count", 3},
        {"/accessors/0/sparse/indices/componentType: must be 5121, 5123 or 5125", "indices/componentType", 5126},
        {"/accessors/0/sparse/indices/componentType: 1 is no", "indices/componentType", 1},
        {"/accessors/0/sparse/indices: its 2 elements of 4 bytes", "indices/componentType", 5125},
        {"/accessors/0/sparse/indices/bufferView: refers to bufferViews 9", "indices/bufferView", 9},
        {"/accessors/0/sparse/indices: its 2 elements of 2 bytes from byte 2 on", "indices/byteOffset", 2},
        {"/accessors/0/sparse/indices: its 2 elements", "indices/byteOffset", ~std::uint64_t{1}},
        {"/accessors/0/sparse/indices: its data is not aligned",
         "",
         {{"count", 1},
          {"indices", {{"bufferView", 1}, {"componentType", 5123}, {"byteOffset", 1}}},
          {"values", {{"bufferView", 2}}}}},
        {"/accessors/0/sparse/values: its 2 elements of 12 bytes", "values/byteOffset", 4},
        {"/accessors/0/sparse/values/bufferView: is missing", "values", json::object()},
        {"/accessors/0/sparse: must be an object", "", 1},
    };
    for (const auto& [expected, member, value] : cases) {
        json document = sparseDocument();
        const std::string pointer = std::string("/accessors/0/sparse") + (*member != '\0' ? "/" : "") + member;
        document[json::json_pointer(pointer)] = value;
        EXPECT_MENTIONS(failure(document), expected);
    }
}

TEST_F(LoadTest, SparseIndicesMustIncreaseAndStayInRange) {
    const std::vector<std::pair<std::vector<std::uint16_t>, const char*>> cases = {
        {{2, 0}, "/accessors/0/sparse/indices: element 1 is 0 and follows 2, but they must increase strictly"},
        {{1, 1}, "/accessors/0/sparse/indices: element 1 is 1 and follows 1"},
        {{0, 3}, "/accessors/0/sparse/indices: element 1 is 3, but the accessor has only 3 elements"},
        {{0, 0xFFFF}, "/accessors/0/sparse/indices: element 1 is 65535"},
    };
    for (const auto& [indices, expected] : cases) {
        json document = triangleDocument();
        makeSparse(document, 0, indices, std::string(24, '\0'));
        EXPECT_MENTIONS(failure(document), expected);
    }
}

TEST_F(LoadTest, DataOfSparseAccessorsHasNoStride) {
    json document = sparseDocument();
    document["bufferViews"][2]["byteStride"] = 12; // as close together as without
    EXPECT_EQ(load(document).meshes.at(0).positions.at(2), Vec3f(8, 9, 1));
    document["bufferViews"][2]["byteStride"] = 4;
    EXPECT_MENTIONS(failure(document), "/accessors/0/sparse/values: /bufferViews/2 has a byteStride");
}

TEST_F(LoadTest, ReplacedVerticesMustBeFinite) {
    json document = triangleDocument();
    makeSparse(document, 0, {2}, bytesOf<float>({0, 0, std::numeric_limits<float>::infinity()}));
    EXPECT_MENTIONS(failure(document), "/accessors/0: element 2 is not finite (0, 0, inf)");
}

TEST_F(LoadTest, NothingIsAllocatedByANumberThatIsOnlyClaimed) {
    json document = sparseDocument();
    document["accessors"][0].erase("bufferView");
    for (const std::uint64_t count : {std::uint64_t{100000}, std::uint64_t{0xFFFFFFFFu}}) {
        document["accessors"][0]["count"] = count;
        EXPECT_MENTIONS(failure(document), "/meshes/0/primitives/0: its " + std::to_string(count) +
                                               " elements without a bufferView come to over 64 times");
    }
    // Stored indices into many vertices that are only claimed take no more than the indices do.
    primitiveOf(document)["indices"] = addAccessor(document, bytesOf<std::uint32_t>({0, 2, 3000000}), scalars(5125, 3));
    EXPECT_EQ(load(document).meshes.at(0).positions, (std::vector<Vec3f>{{5, 6, 7}, {8, 9, 1}, {0, 0, 0}}));
    // Indices that are only claimed.
    document["accessors"][1].erase("bufferView");
    makeSparse(document, 1, {1}, bytesOf<std::uint32_t>({2}));
    document["accessors"][1]["count"] = std::uint64_t{1} << 53;
    EXPECT_MENTIONS(failure(document), "elements without a bufferView come to over 64 times");
    document["accessors"][1]["count"] = 300;
    EXPECT_EQ(load(document).meshes.at(0).triangles.size(), 100u);
}

TEST_F(LoadTest, ManyPrimitivesCannotRepeatTheWorkOfASparseAccessor) {
    json document = triangleDocument();
    const std::size_t count = 400000;
    std::vector<std::uint32_t> indices(count);
    for (std::size_t i = 0; i < count; ++i) indices[i] = static_cast<std::uint32_t>(i);
    const json accessor = {{"componentType", 5121}, {"normalized", true}, {"count", count}, {"type", "VEC3"}};
    const std::size_t position = addAccessor(document, std::string(3 * count, '\1'), accessor);
    const std::size_t data = addAccessor(document, bytesOf(indices), scalars(5125, count));
    document["accessors"][position]["sparse"] = {
        {"count", count},
        {"indices", {{"bufferView", document["accessors"][data]["bufferView"]}, {"componentType", 5125}}},
        {"values", {{"bufferView", document["accessors"][position]["bufferView"]}}}};
    primitiveOf(document)["attributes"]["POSITION"] = position;
    primitiveOf(document)["indices"] = addAccessor(document, bytesOf<std::uint8_t>({0, 1, 2}), scalars(5121, 3));
    EXPECT_EQ(load(document).meshes.size(), 1u);
    json& primitives = document["meshes"][0]["primitives"];
    for (int i = 0; i < 800; ++i) primitives.push_back(json(primitives[0]));
    EXPECT_MENTIONS(failure(document), "/meshes: the meshes expand to over 64 times the size of the buffers");
}

} // namespace
} // namespace isolux::load_test
