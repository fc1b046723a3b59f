// The glTF loader on vertices and indices: strips and fans, integers, interleaving, accessors without data.
#include "unit/load_fixture.h"

namespace isolux::load_test {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Points (i, i², 0), no three of them on a line.
std::vector<float> parabola(std::size_t count) {
    std::vector<float> positions;
    for (std::size_t i = 0; i < count; ++i)
        positions.insert(positions.end(), {static_cast<float>(i), static_cast<float>(i * i), 0.0f});
    return positions;
}

/// A primitive of this mode over points of a parabola, without indices.
json documentOfMode(int mode, std::size_t vertexCount) {
    json document = triangleDocument();
    primitiveOf(document)["attributes"]["POSITION"] =
        addAccessor(document, bytesOf(parabola(vertexCount)), vectors(5126, vertexCount));
    primitiveOf(document)["mode"] = mode;
    return document;
}

json documentOfMode(int mode, const std::vector<std::uint16_t>& indices) {
    json document = documentOfMode(mode, 8);
    primitiveOf(document)["indices"] = addAccessor(document, bytesOf(indices), scalars(5123, indices.size()));
    return document;
}

TEST_F(LoadTest, StripsAlternateTheirWinding) {
    EXPECT_EQ(load(documentOfMode(5, 5)).meshes.at(0).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
    const Mesh mesh = load(documentOfMode(5, {7, 6, 5, 4, 3, 2, 1, 0})).meshes.at(0);
    EXPECT_EQ(mesh.triangles, (Triangles{{7, 6, 5}, {6, 4, 5}, {5, 4, 3}, {4, 2, 3}, {3, 2, 1}, {2, 0, 1}}));
}

TEST_F(LoadTest, FansTurnAboutTheirFirstVertex) {
    EXPECT_EQ(load(documentOfMode(6, 5)).meshes.at(0).triangles, (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
    const Mesh mesh = load(documentOfMode(6, {3, 0, 1, 2, 4, 5, 6, 7})).meshes.at(0);
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 3}, {1, 2, 3}, {2, 4, 3}, {4, 5, 3}, {5, 6, 3}, {6, 7, 3}}));
}

TEST_F(LoadTest, AStripOnAPlaneFacesOneWay) {
    json document = triangleDocument();
    const std::vector<float> zigzag = {0, 1, 0, 0, 0, 0, 1, 1, 0, 1, 0, 0, 2, 1, 0, 2, 0, 0};
    primitiveOf(document) = {{"mode", 5}, {"attributes", {{"POSITION", 1}}}};
    addAccessor(document, bytesOf(zigzag), vectors(5126, 6));
    const Mesh mesh = load(document).meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), 4u);
    for (const auto& t : mesh.triangles) {
        const Vec3f *p = mesh.positions.data(), a = p[t[1]] - p[t[0]], b = p[t[2]] - p[t[0]];
        EXPECT_EQ(glm::cross(a, b), Vec3f(0, 0, 1));
    }
}

// What joins strips counts for the winding of what follows, though it is left out.
TEST_F(LoadTest, StripsAreJoinedByRepeatedIndices) {
    const Scene joined = load(documentOfMode(5, {0, 1, 2, 2, 4, 4, 5, 6}));
    EXPECT_EQ(joined.meshes.at(0).triangles, (Triangles{{0, 1, 2}, {4, 6, 5}}));
    EXPECT_EQ(joined.meshes.at(0).positions.at(3), Vec3f(3, 9, 0));
    EXPECT_EQ(load(documentOfMode(4, {0, 1, 2, 3, 3, 4})).meshes.at(0).triangles.size(), 2u);
}

TEST_F(LoadTest, TrianglesWithoutAreaAreKept) {
    json flat = documentOfMode(5, 4);
    flat["buffers"][1]["uri"] = dataUri(std::string(48, '\0'));
    EXPECT_EQ(load(flat).meshes.at(0).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
}

TEST_F(LoadTest, TooFewIndicesMakeNoTriangle) {
    for (const int mode : {4, 5, 6}) {
        const Scene scene = load(documentOfMode(mode, 2));
        EXPECT_EQ(primitiveCount(scene), 0u);
        EXPECT_TRUE(mentions(scene.warnings, "/meshes/0/primitives/0: fewer than three indices"));
    }
    const Scene scene = load(documentOfMode(4, 5));
    EXPECT_EQ(primitiveCount(scene), 1u);
    EXPECT_TRUE(mentions(scene.warnings, "no multiple of three"));
}

TEST_F(LoadTest, RestartIndicesAreRefusedInEveryWidth) {
    const std::vector<std::string> data = {bytesOf<std::uint8_t>({0, 1, 0xFF}), bytesOf<std::uint16_t>({0, 1, 0xFFFF}),
                                           bytesOf<std::uint32_t>({0, 1, 0xFFFFFFFFu})};
    const std::vector<std::pair<int, const char*>> types = {{5121, "255"}, {5123, "65535"}, {5125, "4294967295"}};
    for (std::size_t i = 0; i < types.size(); ++i) {
        json document = documentOfMode(5, i == 0 ? 300 : 70000); // so that the index would be in range
        primitiveOf(document)["indices"] = addAccessor(document, data[i], scalars(types[i].first, 3));
        const std::string message = failure(document);
        EXPECT_MENTIONS(message, std::string("/accessors/2: element 2 is ") + types[i].second + ", which restarts");
    }
}

/// Three vectors, each padded to a multiple of four bytes.
template <typename T> std::string padded(std::vector<std::array<T, 3>> rows) {
    std::string bytes;
    for (const auto& row : rows) bytes += bytesOf(std::vector<T>{row[0], row[1], row[2], T{99}});
    return bytes;
}

/// A triangle with integer positions of this type.
json quantisedDocument(int componentType, const std::string& bytes) {
    json document = triangleDocument();
    document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_mesh_quantization"};
    primitiveOf(document)["attributes"]["POSITION"] = addAccessor(document, bytes, vectors(componentType, 3));
    document["bufferViews"][1]["byteStride"] = bytes.size() / 3;
    return document;
}

TEST_F(LoadTest, QuantisedPositionsOfEveryType) {
    struct Case {
        int type;
        std::string bytes;
        std::vector<Vec3f> plain;
        std::vector<Vec3f> normalized;
    };
    constexpr float kB = 127.0f, kUb = 255.0f, kS = 32767.0f, kUs = 65535.0f;
    const std::vector<Case> cases = {
        {5120,
         padded<std::int8_t>({{-128, -127, -1}, {0, 1, 64}, {127, 0, 0}}),
         {{-128, -127, -1}, {0, 1, 64}, {127, 0, 0}},
         {{-1, -1, -1 / kB}, {0, 1 / kB, 64 / kB}, {1, 0, 0}}},
        {5121,
         padded<std::uint8_t>({{0, 1, 128}, {255, 254, 3}, {7, 0, 0}}),
         {{0, 1, 128}, {255, 254, 3}, {7, 0, 0}},
         {{0, 1 / kUb, 128 / kUb}, {1, 254 / kUb, 3 / kUb}, {7 / kUb, 0, 0}}},
        {5122,
         padded<std::int16_t>({{-32768, -32767, -1}, {1, 32767, 300}, {0, 0, 9}}),
         {{-32768, -32767, -1}, {1, 32767, 300}, {0, 0, 9}},
         {{-1, -1, -1 / kS}, {1 / kS, 1, 300 / kS}, {0, 0, 9 / kS}}},
        {5123,
         padded<std::uint16_t>({{0, 1, 65535}, {40000, 2, 3}, {0, 0, 9}}),
         {{0, 1, 65535}, {40000, 2, 3}, {0, 0, 9}},
         {{0, 1 / kUs, 1}, {40000 / kUs, 2 / kUs, 3 / kUs}, {0, 0, 9 / kUs}}},
    };
    for (const Case& c : cases) {
        json document = quantisedDocument(c.type, c.bytes);
        const Scene plain = load(document);
        EXPECT_EQ(plain.meshes.at(0).positions, c.plain) << c.type;
        EXPECT_TRUE(plain.warnings.empty()) << plain.warnings.front();
        document["accessors"][1]["normalized"] = true;
        EXPECT_EQ(load(document).meshes.at(0).positions, c.normalized) << c.type;
    }
}

TEST_F(LoadTest, QuantisedNormalsAreNormalizedSignedIntegers) {
    json document = quantisedDocument(5122, padded<std::int16_t>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    const std::string normals = padded<std::int8_t>({{-128, 0, 1}, {0, 0, -127}, {73, 74, 73}});
    primitiveOf(document)["attributes"]["NORMAL"] = addAccessor(document, normals, normalized(vectors(5120, 3)));
    document["bufferViews"][2]["byteStride"] = 4;
    constexpr float kB = 127.0f;
    EXPECT_EQ(load(document).meshes.at(0).normals,
              (std::vector<Vec3f>{{-1, 0, 1 / kB}, {0, 0, -1}, {73 / kB, 74 / kB, 73 / kB}}));
    document["accessors"][2]["normalized"] = false;
    EXPECT_MENTIONS(failure(document), "attributes/NORMAL: refers to integers other than normalized bytes");
    document["accessors"][2] = normalized(vectors(5121, 3));
    document["accessors"][2]["bufferView"] = 2;
    EXPECT_MENTIONS(failure(document), "attributes/NORMAL: refers to integers other than normalized bytes");
}

TEST_F(LoadTest, UnsignedIntsAreNoPositions) {
    json document = triangleDocument();
    document["accessors"][0]["componentType"] = 5125;
    EXPECT_MENTIONS(failure(document), "attributes/POSITION: refers to unsigned ints");
}

TEST_F(LoadTest, QuantisedVerticesAreReadWithoutTheirExtensionAndAlignmentButNotInSilence) {
    json document = quantisedDocument(5120, bytesOf<std::int8_t>({0, 0, 0, 1, 0, 0, 0, 1, 0}));
    document["bufferViews"][1].erase("byteStride");
    document.erase("extensionsRequired");
    const std::string normals = bytesOf<std::int8_t>({127, 0, 0, 127, 0, 0, 127, 0, 0});
    primitiveOf(document)["attributes"]["NORMAL"] = addAccessor(document, normals, normalized(vectors(5120, 3)));
    document["meshes"][0]["primitives"].push_back(primitiveOf(document));
    const Scene scene = load(document);
    EXPECT_EQ(scene.meshes.at(1).positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.warnings.size(), 2u);
    EXPECT_TRUE(mentions(scene.warnings, "attributes/NORMAL: vertices do not start at multiples of four bytes, as "
                                         "glTF asks; read as they lie (and 3 more)"));
    EXPECT_TRUE(mentions(scene.warnings, "/meshes/0/primitives/0: integer vertices without KHR_mesh_quantization"));
}

TEST_F(LoadTest, InterleavedIntegersWithOffsets) {
    json document = triangleDocument();
    std::string bytes(8, '\x7E'); // before the bufferView and before the accessors
    for (std::int16_t v = 0; v < 3; ++v) {
        bytes += bytesOf<std::int16_t>({v, static_cast<std::int16_t>(v * v), -7, 0x7E7E});
        bytes += bytesOf<std::int8_t>({0, 0, 127, 0x7E});
    }
    document["extensionsRequired"] = {"KHR_mesh_quantization"};
    document["buffers"] = {{{"byteLength", bytes.size()}, {"uri", dataUri(bytes)}}};
    document["bufferViews"] = {
        {{"buffer", 0}, {"byteOffset", 4}, {"byteLength", bytes.size() - 4}, {"byteStride", 12}}};
    document["accessors"] = {vectors(5122, 3), normalized(vectors(5120, 3))};
    document["accessors"][0].update({{"bufferView", 0}, {"byteOffset", 4}});
    document["accessors"][1].update({{"bufferView", 0}, {"byteOffset", 12}});
    primitiveOf(document)["attributes"]["NORMAL"] = 1;
    const Mesh mesh = load(document).meshes.at(0);
    EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, -7}, {1, 1, -7}, {2, 4, -7}}));
    EXPECT_EQ(mesh.normals, std::vector<Vec3f>(3, Vec3f(0, 0, 1)));
    document["accessors"][0]["byteOffset"] = 5;
    EXPECT_MENTIONS(failure(document), "/accessors/0: its data is not aligned");
    document["accessors"][0]["byteOffset"] = 12;
    EXPECT_MENTIONS(failure(document), "/accessors/0: its 3 elements of 6 bytes from byte 12 on do not fit");
}

TEST_F(LoadTest, AccessorsWithoutDataAreLeftOut) {
    json document = triangleDocument();
    document["accessors"] = {vectors(5126, 3), scalars(5125, 3)};
    document["accessors"][0]["bufferView"] = 0;
    primitiveOf(document)["indices"] = 1;
    EXPECT_TRUE(mentions(load(document).warnings, "an accessor without data, all zeros; left out"));
    primitiveOf(document).erase("indices");
    document["accessors"].push_back(vectors(5126, 3));
    primitiveOf(document)["attributes"]["NORMAL"] = 2;
    const Scene flat = load(document);
    EXPECT_TRUE(flat.meshes.at(0).normals.empty());
    EXPECT_TRUE(mentions(flat.warnings, "an accessor without data, all zeros; shaded flat"));
    primitiveOf(document)["attributes"] = {{"POSITION", 2}};
    document["accessors"][2]["count"] = 4000000000u;
    EXPECT_TRUE(load(document).meshes.empty());
}

} // namespace
} // namespace isolux::load_test
