// Coordinates, colours and tangents of vertices: every type, and what is put right or refused.
#include "unit/load_images.h"

#include <limits>

namespace isolux::load_test {
namespace {

class LoadAttributesTest : public LoadTest {
protected:
    LoadAttributesTest() : document_(texturedDocument(whiteImage(folder_))) {}

    json& attributes() { return primitiveOf(document_)["attributes"]; }
    void set(const std::string& name, const std::string& bytes, const json& accessor) {
        attributes()[name] = addAccessor(document_, bytes, accessor);
    }
    void useNormalMap() { document_["materials"] = {{{"normalTexture", {{"index", 0}}}}}; }
    void setNormals() { set("NORMAL", bytesOf<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}), vectors(5126, 3)); }
    Mesh loadMesh() { return load(document_).meshes.at(0); }

    json document_;
};

TEST_F(LoadAttributesTest, CoordinatesOfEveryType) {
    struct Case {
        std::string bytes;
        json accessor;
        Vec2<float> second;
    };
    const std::vector<Case> cases = {
        {bytesOf<float>({0, 0, -1.5f, 2, 0, 0}), vectors2(5126, 3), {-1.5f, 2}},
        {bytesOf<std::uint8_t>({0, 0, 255, 51, 0, 0}), normalized(vectors2(5121, 3)), {1, 0.2f}},
        {bytesOf<std::uint16_t>({0, 0, 65535, 13107, 0, 0}), normalized(vectors2(5123, 3)), {1, 0.2f}},
        {bytesOf<std::int8_t>({0, 0, -128, 127, 0, 0}), normalized(vectors2(5120, 3)), {-1, 1}},
        {bytesOf<std::int16_t>({0, 0, -32768, 32767, 0, 0}), normalized(vectors2(5122, 3)), {-1, 1}},
        {bytesOf<std::uint8_t>({0, 0, 3, 200, 0, 0}), vectors2(5121, 3), {3, 200}},
        {bytesOf<std::int16_t>({0, 0, -3, 200, 0, 0}), vectors2(5122, 3), {-3, 200}},
    };
    for (const Case& c : cases) {
        set("TEXCOORD_0", c.bytes, c.accessor);
        EXPECT_EQ(loadMesh().uvs.at(0).at(1), c.second) << c.accessor;
    }
    set("TEXCOORD_0", bytesOf<std::uint32_t>({0, 0, 1, 1, 0, 0}), vectors2(5125, 3));
    EXPECT_MENTIONS(failure(document_), "/attributes/TEXCOORD_0: refers to unsigned ints");
    set("TEXCOORD_0", bytesOf(kTriangle), vectors(5126, 3));
    EXPECT_MENTIONS(failure(document_), "/attributes/TEXCOORD_0: refers to an accessor of type VEC3, not VEC2");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    set("TEXCOORD_0", bytesOf<float>({0, 0, 0, nan, 0, 0}), vectors2(5126, 3));
    EXPECT_MENTIONS(failure(document_), "element 1 is not finite (0, nan)");
}

TEST_F(LoadAttributesTest, TypesOfQuantizationAreToldWhereItIsNotRequired) {
    set("TEXCOORD_0", bytesOf<std::uint16_t>({0, 0, 9, 0, 0, 0}), normalized(vectors2(5123, 3)));
    EXPECT_TRUE(load(document_).warnings.empty()); // part of glTF itself
    set("TEXCOORD_0", bytesOf<std::uint16_t>({0, 0, 9, 0, 0, 0}), vectors2(5123, 3));
    EXPECT_TRUE(mentions(load(document_).warnings, "integer vertices without KHR_mesh_quantization"));
    document_["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_TRUE(load(document_).warnings.empty());
}

TEST_F(LoadAttributesTest, ColoursOfEveryType) {
    struct Case {
        std::string bytes;
        json accessor;
        glm::vec4 first;
    };
    const std::vector<Case> cases = {
        {bytesOf<float>({0.25f, 0.5f, 1, 0, 0, 0, 0, 0, 0}), vectors(5126, 3), {0.25f, 0.5f, 1, 1}},
        {bytesOf<float>({0.25f, 0.5f, 1, 0.75f, 0, 0, 0, 0, 0, 0, 0, 0}), vectors4(5126, 3), {0.25f, 0.5f, 1, 0.75f}},
        {bytesOf<std::uint8_t>({51, 255, 0, 102, 0, 0, 0, 0, 0, 0, 0, 0}),
         normalized(vectors4(5121, 3)),
         {0.2f, 1, 0, 0.4f}},
        {bytesOf<std::uint8_t>({51, 255, 0, 0, 0, 0, 0, 0, 0}), normalized(vectors(5121, 3)), {0.2f, 1, 0, 1}},
        {bytesOf<std::uint16_t>({13107, 65535, 0, 26214, 0, 0, 0, 0, 0, 0, 0, 0}),
         normalized(vectors4(5123, 3)),
         {0.2f, 1, 0, 0.4f}},
        {bytesOf<std::uint16_t>({13107, 65535, 0, 0, 0, 0, 0, 0, 0}), normalized(vectors(5123, 3)), {0.2f, 1, 0, 1}},
    };
    for (const Case& c : cases) {
        set("COLOR_0", c.bytes, c.accessor);
        EXPECT_EQ(loadMesh().colors.at(0), c.first) << c.accessor;
    }
    set("COLOR_0", std::string(12, '\0'), vectors4(5121, 3));
    EXPECT_MENTIONS(failure(document_), "/COLOR_0: refers to integers other than normalized unsigned bytes or shorts");
    set("COLOR_0", std::string(12, '\0'), normalized(vectors4(5120, 3)));
    EXPECT_MENTIONS(failure(document_), "/COLOR_0: refers to integers other than normalized unsigned bytes or shorts");
}

TEST_F(LoadAttributesTest, ColoursBeyondTheirRangeAreClamped) {
    set("COLOR_0", bytesOf<float>({1, 1, 1, 2, -1, 0.5f, 0, 0, 0}), vectors(5126, 3));
    const Scene scene = load(document_);
    EXPECT_EQ(scene.meshes.at(0).colors.at(1), glm::vec4(1, 0, 0.5f, 1));
    EXPECT_TRUE(mentions(scene.warnings, "/meshes/0/primitives/0: vertex colours beyond [0, 1] are clamped"));
    set("COLOR_0", bytesOf(std::vector<float>(9, std::numeric_limits<float>::infinity())), vectors(5126, 3));
    EXPECT_MENTIONS(failure(document_), "element 0 is not finite (inf, inf, inf)");
}

TEST_F(LoadAttributesTest, TangentsAreReadForNormalMapsAlone) {
    setNormals();
    set("TANGENT", bytesOf<float>({1, 0, 0, 1, 0, 1, 0, -1, 0.6f, 0.8f, 0, 1}), vectors4(5126, 3));
    EXPECT_TRUE(loadMesh().tangents.empty());
    useNormalMap();
    const Scene scene = load(document_);
    const std::vector<glm::vec4>& tangents = scene.meshes.at(0).tangents;
    ASSERT_EQ(tangents.size(), 3u);
    EXPECT_EQ(tangents[0], glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(tangents[1], glm::vec4(0, 1, 0, -1));
    EXPECT_NEAR(glm::length(Vec3d(tangents[2])), 1.0, 1e-7);
    EXPECT_TRUE(scene.warnings.empty());
    set("TANGENT", bytesOf<std::int8_t>({127, 0, 0, 127, 0, 127, 0, -127, 0, 90, 90, 127}),
        normalized(vectors4(5120, 3)));
    document_["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_EQ(loadMesh().tangents.at(1), glm::vec4(0, 1, 0, -1));
    EXPECT_TRUE(load(document_).warnings.empty()); // as far from unit as rounding brings them
}

TEST_F(LoadAttributesTest, NormalsThatAreNotUnitArePutRight) {
    set("NORMAL", bytesOf<float>({0, 1.001f, 0, 3, 0, 4, 0, 0, 0}), vectors(5126, 3));
    const Scene scene = load(document_);
    EXPECT_EQ(scene.meshes.at(0).normals, (std::vector<Vec3f>{{0, 1.001f, 0}, {0.6f, 0, 0.8f}, {0, 0, 0}}));
    EXPECT_TRUE(mentions(scene.warnings, "/meshes/0/primitives/0: normals that are not of length 1 are put right"));
}

TEST_F(LoadAttributesTest, TangentsThatAreNotUnitArePutRight) {
    setNormals();
    useNormalMap();
    set("TANGENT", bytesOf<float>({0, 2, 0, 1, 3, 0, 4, -0.5f, 0, 0, 0, 0}), vectors4(5126, 3));
    const Scene scene = load(document_);
    const std::vector<glm::vec4>& tangents = scene.meshes.at(0).tangents;
    EXPECT_EQ(tangents.at(0), glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(tangents.at(1), glm::vec4(0.6f, 0, 0.8f, -1));
    EXPECT_EQ(tangents.at(2), glm::vec4(0, 0, 0, 1)); // the normal map has no effect there
    EXPECT_TRUE(mentions(scene.warnings, "/meshes/0/primitives/0: tangents that are not of length 1"));
    set("TANGENT", bytesOf(std::vector<float>(9, 0)), vectors(5126, 3));
    EXPECT_MENTIONS(failure(document_), "/attributes/TANGENT: refers to an accessor of type VEC3, not VEC4");
    set("TANGENT", std::string(12, '\0'), vectors4(5121, 3));
    EXPECT_MENTIONS(failure(document_), "/attributes/TANGENT: refers to integers other than normalized bytes");
}

TEST_F(LoadAttributesTest, TangentsAreMadeWhereThereAreNone) {
    setNormals();
    useNormalMap();
    const Mesh mesh = loadMesh();
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (const glm::vec4& tangent : mesh.tangents)
        EXPECT_EQ(tangent, glm::vec4(1, 0, 0, -1)); // v grows along y, and up in the image is -y
}

TEST_F(LoadAttributesTest, FlatMeshesWithNormalMapsGetNormalsOfTheirTriangles) {
    useNormalMap();
    // Two triangles at a right angle that share an edge; tangents without normals are ignored.
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    set("POSITION", bytesOf(positions), vectors(5126, 4));
    set("TEXCOORD_0", bytesOf<float>({0, 0, 1, 0, 0, 1, 1, 1}), vectors2(5126, 4));
    set("TANGENT", std::string(64, '\0'), vectors4(5126, 4));
    set("COLOR_0", bytesOf<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}), vectors(5126, 4));
    primitiveOf(document_)["indices"] =
        addAccessor(document_, bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 3}), scalars(5123, 6));
    const Mesh mesh = loadMesh();
    ASSERT_EQ(mesh.triangles.size(), 2u);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    ASSERT_EQ(mesh.uvs.at(0).size(), mesh.positions.size());
    const std::array<Vec3f, 2> normals = {Vec3f(0, 0, 1), Vec3f(1, 0, 0)};
    for (std::size_t t = 0; t < 2; ++t)
        for (const std::uint32_t vertex : mesh.triangles[t]) EXPECT_EQ(mesh.normals.at(vertex), normals[t]);
    EXPECT_EQ(mesh.positions.at(mesh.triangles[1][2]), Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.colors.at(mesh.triangles[1][2]), glm::vec4(1));
    EXPECT_EQ(mesh.uvs[0].at(mesh.triangles[1][2]), Vec2<float>(1, 1));
}

TEST_F(LoadAttributesTest, AttributesCopyOnlyTheVerticesTheyUse) {
    set("POSITION", bytesOf(std::vector<float>(3000)), vectors(5126, 1000));
    std::vector<float> uvs(2000);
    for (std::size_t i = 0; i < uvs.size(); ++i) uvs[i] = static_cast<float>(i);
    set("TEXCOORD_0", bytesOf(uvs), vectors2(5126, 1000));
    primitiveOf(document_)["indices"] = addAccessor(document_, bytesOf<std::uint16_t>({900, 7, 500}), scalars(5123, 3));
    EXPECT_EQ(loadMesh().uvs.at(0), (std::vector<Vec2<float>>{{14, 15}, {1000, 1001}, {1800, 1801}}));
}

TEST_F(LoadAttributesTest, AttributesCountTowardsTheBoundOnMemory) {
    // A primitive takes 4 + 12 bytes an index and 12 a triangle, 6e6 in all; with coordinates 8 an index more, 8.4e6.
    // Of 150 the former come to less than 1 GiB, which is always allowed, the latter to more.
    constexpr std::size_t kCount = 300000;
    primitiveOf(document_)["indices"] = addAccessor(document_, std::string(kCount, '\0'), scalars(5121, kCount));
    json& primitives = document_["meshes"][0]["primitives"];
    const json primitive = primitives[0];
    for (int i = 1; i < 150; ++i) primitives.push_back(primitive);
    EXPECT_MENTIONS(failure(document_), "/meshes: the meshes expand to over 64 times");
    document_["materials"][0] = json::object();
    EXPECT_TRUE(failure(document_).empty());
}

} // namespace
} // namespace isolux::load_test
