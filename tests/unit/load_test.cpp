// The glTF loader: what it understands, and what it warns of.
#include "unit/load_fixture.h"

namespace isolux::load_test {
namespace {

constexpr double kTolerance = 1e-12;

TEST_F(LoadTest, TriangleWithoutIndicesGetsDefaultMaterialAndCamera) {
    const Scene scene = load(triangleDocument());
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions[1], Vec3f(1, 0, 0));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
    EXPECT_TRUE(scene.meshes[0].normals.empty());
    EXPECT_EQ(scene.materials.at(0).baseColor, Vec3d(1.0));
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].position, frameScene(scene).position);
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.name, "scene");
}

TEST_F(LoadTest, IndicesOfEveryWidth) {
    const std::vector<std::string> data = {bytesOf<std::uint8_t>({2, 1, 0}), bytesOf<std::uint16_t>({2, 1, 0}),
                                           bytesOf<std::uint32_t>({2, 1, 0})};
    const std::vector<int> types = {5121, 5123, 5125};
    for (std::size_t i = 0; i < types.size(); ++i) {
        json document = triangleDocument();
        primitiveOf(document)["indices"] = addAccessor(document, data[i], scalars(types[i], 3));
        EXPECT_EQ(load(document).meshes.at(0).triangles.at(0), (std::array<std::uint32_t, 3>{2, 1, 0}));
    }
}

TEST_F(LoadTest, InterleavedNormalsAndByteStride) {
    json document = triangleDocument();
    std::vector<float> interleaved;
    for (std::size_t v = 0; v < 3; ++v) {
        interleaved.insert(interleaved.end(), kTriangle.begin() + 3 * v, kTriangle.begin() + 3 * v + 3);
        interleaved.insert(interleaved.end(), {0, 0, 1});
    }
    document["buffers"] = {{{"byteLength", 72}, {"uri", dataUri(bytesOf(interleaved))}}};
    document["bufferViews"] = {{{"buffer", 0}, {"byteLength", 72}, {"byteStride", 24}}};
    document["accessors"].push_back(document["accessors"][0]);
    document["accessors"][1]["byteOffset"] = 12;
    primitiveOf(document)["attributes"]["NORMAL"] = 1;
    const Scene scene = load(document);
    EXPECT_EQ(scene.meshes.at(0).positions.at(2), Vec3f(0, 1, 0));
    EXPECT_EQ(scene.meshes[0].normals, std::vector<Vec3f>(3, Vec3f(0, 0, 1)));
}

TEST_F(LoadTest, ZeroNormalsAreKept) {
    json document = triangleDocument();
    primitiveOf(document)["attributes"]["NORMAL"] =
        addAccessor(document, std::string(36, '\0'), document["accessors"][0]);
    EXPECT_EQ(load(document).meshes.at(0).normals, std::vector<Vec3f>(3, Vec3f(0)));
}

TEST_F(LoadTest, PrimitivesCopyOnlyTheVerticesTheyUse) {
    json document = triangleDocument();
    std::vector<float> positions(3000);
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = static_cast<float>(i);
    const json accessor = {{"componentType", 5126}, {"count", 1000}, {"type", "VEC3"}};
    primitiveOf(document)["attributes"]["POSITION"] = addAccessor(document, bytesOf(positions), accessor);
    primitiveOf(document)["indices"] = addAccessor(document, bytesOf<std::uint16_t>({900, 7, 500}), scalars(5123, 3));
    const Mesh mesh = load(document).meshes.at(0);
    EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{21, 22, 23}, {1500, 1501, 1502}, {2700, 2701, 2702}}));
    EXPECT_EQ(mesh.triangles.at(0), (std::array<std::uint32_t, 3>{2, 0, 1}));
}

TEST_F(LoadTest, MeshesAreSharedBetweenNodes) {
    json document = triangleDocument();
    document["meshes"][0]["primitives"].push_back(primitiveOf(document));
    document["nodes"] = {{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"translation", {0, 0, 5}}}};
    document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load(document);
    EXPECT_EQ(scene.meshes.size(), 2u);
    ASSERT_EQ(scene.instances.size(), 4u);
    EXPECT_EQ(scene.instances[2].mesh, scene.instances[0].mesh);
    EXPECT_EQ(scene.instances[0].name, "a");
    EXPECT_EQ(scene.instances[2].worldFromObject[3].z, 5.0);
    EXPECT_EQ(primitiveCount(scene), 4u);
}

TEST_F(LoadTest, MatrixEqualsTranslationRotationScale) {
    json document = triangleDocument();
    const double h = std::sqrt(0.5); // a quarter turn about z, after a scale that mirrors x
    document["nodes"] = {{{"mesh", 0}, {"translation", {1, 2, 3}}, {"rotation", {0, 0, h, h}}, {"scale", {-2, 3, 4}}},
                         {{"mesh", 0}, {"matrix", {0, -2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1}}}};
    document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load(document);
    const Mat4d &a = scene.instances.at(0).worldFromObject, &b = scene.instances.at(1).worldFromObject;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) EXPECT_NEAR(a[column][row], b[column][row], kTolerance);
    EXPECT_NEAR(glm::determinant(a), -24.0, 1e-10);
}

TEST_F(LoadTest, TransformsComposeDownTheHierarchy) {
    json document = triangleDocument();
    document["nodes"] = {{{"children", {1}}, {"scale", {2, 2, 2}}},
                         {{"children", {2}}, {"translation", {1, 0, 0}}},
                         {{"mesh", 0}, {"translation", {0, 1, 0}}}};
    const Scene scene = load(document);
    EXPECT_EQ(Vec3d(scene.instances.at(0).worldFromObject[3]), Vec3d(2, 2, 0));
}

TEST_F(LoadTest, SceneChoice) {
    json document = triangleDocument();
    document["nodes"] = {{{"mesh", 0}, {"name", "first"}}, {{"mesh", 0}, {"name", "second"}}};
    document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}, {"name", "other"}}};
    document["scene"] = 1;
    EXPECT_EQ(load(document).instances.at(0).name, "second");
    EXPECT_EQ(load(document).name, "other");
    document.erase("scene");
    EXPECT_EQ(load(document).instances.at(0).name, "first");
    document.erase("scenes");
    EXPECT_EQ(load(document).instances.size(), 2u);
}

TEST_F(LoadTest, MaterialsWithEmissiveStrength) {
    json document = triangleDocument();
    document["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_materials_specular"};
    document["extensionsRequired"] = document["extensionsUsed"];
    document["materials"] = {
        {{"name", "lamp"},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}, {"metallicFactor", 0}}},
         {"emissiveFactor", {1, 0.5, 0}},
         {"doubleSided", true},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 20}}},
           {"KHR_materials_specular", {{"specularFactor", 0}}}}}}};
    primitiveOf(document)["material"] = 0;
    const Scene scene = load(document);
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].name, "lamp");
    EXPECT_EQ(scene.materials[0].baseColor, Vec3d(0.1, 0.2, 0.3));
    EXPECT_EQ(scene.materials[0].emission, Vec3d(20, 10, 0));
    EXPECT_TRUE(scene.materials[0].doubleSided);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoadTest, CameraScaleIsIgnoredAndOrderIsTraversal) {
    json document = triangleDocument();
    document["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}, {"aspectRatio", 1.5}}}},
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", -1}}}}};
    document["nodes"] = {{{"children", {2}}, {"scale", {3, 1e-200, 2}}, {"translation", {1, 2, 3}}},
                         {{"camera", 0}},
                         {{"camera", 1}, {"rotation", {0, 1, 0, 0}}}};
    document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load(document);
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].yfov, 0.9);
    EXPECT_EQ(scene.cameras[0].position, Vec3d(1, 2, 3));
    const Mat3d halfTurn(-1, 0, 0, 0, 1, 0, 0, 0, -1);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(glm::distance(scene.cameras[0].worldFromCamera[axis], halfTurn[axis]), 0.0, kTolerance);
    EXPECT_EQ(scene.cameras[1].worldFromCamera, Mat3d(1.0));
    EXPECT_EQ(scene.cameras[1].aspectRatio, 1.5);
    EXPECT_TRUE(mentions(scene.warnings, "/cameras/1/perspective: znear"));
}

TEST_F(LoadTest, SpheresAreExact) {
    json document = triangleDocument();
    document["materials"] = {json::object(), json::object()};
    primitiveOf(document)["material"] = 1;
    document["nodes"] = {{{"mesh", 0},
                          {"scale", {-2, 2, 2}},
                          {"translation", {1, 2, 3}},
                          {"extras", {{"sphere", {{"radius", 0.25}, {"material", 0}}}}}},
                         {{"extras", {{"sphere", {{"radius", 3}, {"material", 0}}}}}},
                         {{"extras", {{"sphere", {{"radius", 3000000000}}}}}}};
    document["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene scene = load(document);
    ASSERT_EQ(scene.spheres.size(), 3u);
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_NEAR(scene.spheres[0].radius, 0.5, kTolerance);
    EXPECT_EQ(scene.spheres[0].center, Vec3d(1, 2, 3));
    EXPECT_EQ(scene.spheres[0].material, 1u);
    EXPECT_EQ(scene.spheres[1].material, 0u);
    EXPECT_EQ(scene.spheres[2].radius, 3e9);
    EXPECT_EQ(scene.materials.at(scene.spheres[2].material).name, "default");
}

TEST_F(LoadTest, BinaryFilesAreToldByTheirContent) {
    json document = triangleDocument();
    document["buffers"][0].erase("uri");
    const std::string bin = chunk(bytesOf(kTriangle), std::string("BIN\0", 4), '\0');
    EXPECT_EQ(load(glb(chunk(document.dump(), "JSON", ' ') + bin)).meshes.at(0).positions.at(1), Vec3f(1, 0, 0));
    EXPECT_EQ(load(glb(chunk(document.dump(), "JSON", ' ') + bin + chunk("?", "XTRA", ' '))).meshes.size(), 1u);
}

TEST_F(LoadTest, ExternalBuffersByPercentEncodedUtf8Names) {
    write("ein Würfel.bin", bytesOf(kTriangle));
    fs::create_directory(folder_ / "scene" / "sub");
    json document = triangleDocument();
    for (const char* uri : {"ein%20W%C3%BCrfel.bin", "ein Würfel.bin", "./sub/../ein%20Würfel.bin"}) {
        document["buffers"][0]["uri"] = uri;
        EXPECT_EQ(load(document).meshes.size(), 1u) << uri;
    }
}

TEST_F(LoadTest, ContentHashCoversBuffers) {
    json document = triangleDocument();
    document["buffers"][0]["uri"] = "a.bin";
    write("a.bin", bytesOf(kTriangle));
    const std::string hash = load(document).contentHash;
    EXPECT_EQ(hash.size(), 16u);
    EXPECT_EQ(load(document).contentHash, hash);
    write("a.bin", bytesOf<float>({0, 0, 0, 2, 0, 0, 0, 1, 0}));
    EXPECT_NE(load(document).contentHash, hash);
}

TEST_F(LoadTest, WhatNothingReadsIsWarnedOfWhereItStands) {
    json document = triangleDocument();
    document["extensionsUsed"] = {"KHR_materials_ior", "EXT_made_up", "KHR_materials_ior"};
    document["nodes"][0]["extensions"] = {{"KHR_materials_ior", json::object()}, {"EXT_other", json::object()}};
    document["materials"] = {{{"extensions", {{"KHR_materials_volume", json::object()}}}}};
    document["extensions"]["EXT_made_up"] = {{"rules of its own", json::array()}};
    document["extras"] = {{"also", json::array()}};
    document["samplers"] = json::array();
    EXPECT_EQ(load(document).warnings,
              (std::vector<std::string>{
                  "/extensionsUsed/2: KHR_materials_ior is listed twice",
                  "/extensionsUsed/1: EXT_made_up is not supported; ignored",
                  "/materials/0/extensions: KHR_materials_volume is not among extensionsUsed; read all the same",
                  "/nodes/0/extensions: EXT_other is not among extensionsUsed; ignored",
                  "/nodes/0/extensions: KHR_materials_ior has no meaning here; ignored",
                  "/samplers: is an empty array, which glTF forbids; ignored"}));
}

TEST_F(LoadTest, WhatIsNotSupportedIsNamedOnce) {
    json document = triangleDocument();
    json& primitives = document["meshes"][0]["primitives"];
    for (int i = 0; i < 3; ++i) primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", i}});
    primitives[0]["attributes"]["COLOR_1"] = 0;
    primitives[0]["targets"] = {{{"POSITION", 0}}};
    document["extensionsUsed"] = {"EXT_made_up"};
    document["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
    document["nodes"][0]["skin"] = 0;
    document["skins"] = {{{"joints", {0}}}};
    const Scene scene = load(document);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.warnings.size(), 7u);
    for (const char* text : {"/extensionsUsed/0: EXT_made_up is not supported",
                             "/meshes/0/primitives/1: points and lines are not supported; left out (and 2 more)",
                             "vertex colours beyond COLOR_0", "morph targets", "/animations: animations",
                             "/nodes/0/skin: skins", "/animations/0/channels: is an empty array"})
        EXPECT_TRUE(mentions(scene.warnings, text)) << text;
}

} // namespace
} // namespace isolux::load_test
