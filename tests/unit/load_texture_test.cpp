// Textures of glTF files: samplers, sources, transforms of coordinates, and the sets that meshes keep.
#include "unit/load_images.h"

namespace isolux::load_test {
namespace {

class LoadTextureTest : public LoadTest {
protected:
    LoadTextureTest() : document_(texturedDocument(whiteImage(folder_))) {}

    json& map() { return document_["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]; }
    json& transform() { return map()["extensions"]["KHR_texture_transform"]; }
    TextureMap loadMap() { return load(document_).materials.at(0).map(MapSlot::baseColor); }
    Texture loadSampler(const json& sampler) {
        document_["samplers"] = json::array({sampler});
        document_["textures"][0]["sampler"] = 0;
        return load(document_).textures.at(0);
    }
    std::size_t addUvs(const std::vector<float>& uvs) {
        return addAccessor(document_, bytesOf(uvs), vectors2(5126, uvs.size() / 2));
    }

    json document_;
};

TEST_F(LoadTextureTest, SamplersHaveDefaults) {
    const Texture texture = load(document_).textures.at(0);
    EXPECT_EQ(texture.image, 0u);
    EXPECT_EQ(texture.wrapU, TextureWrap::repeat);
    EXPECT_EQ(texture.wrapV, TextureWrap::repeat);
    EXPECT_EQ(texture.filter, TextureFilter::linear);
    EXPECT_EQ(loadSampler(json::object()).filter, TextureFilter::linear);
}

TEST_F(LoadTextureTest, SamplersWrapAndFilter) {
    const Texture texture = loadSampler({{"wrapS", 33648}, {"wrapT", 33071}, {"magFilter", 9728}, {"minFilter", 9987}});
    EXPECT_EQ(texture.wrapU, TextureWrap::mirroredRepeat);
    EXPECT_EQ(texture.wrapV, TextureWrap::clampToEdge);
    EXPECT_EQ(texture.filter, TextureFilter::nearest);
    // There are no smaller levels: the filter for magnification is the filter.
    EXPECT_EQ(loadSampler({{"minFilter", 9728}}).filter, TextureFilter::linear);
    EXPECT_EQ(loadSampler({{"magFilter", 9729}}).filter, TextureFilter::linear);
}

TEST_F(LoadTextureTest, EnumerationsAndReferencesAreChecked) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"/samplers/0/wrapS", "/samplers/0/wrapS: is 5 but must be 10497, 33648 or 33071"},
        {"/samplers/0/wrapT", "/samplers/0/wrapT: is 5"},
        {"/samplers/0/magFilter", "/samplers/0/magFilter: is 5"},
        {"/samplers/0/minFilter", "/samplers/0/minFilter: is 5"},
        {"/textures/0/source", "/textures/0/source: refers to images 5"},
        {"/textures/0/sampler", "/textures/0/sampler: refers to samplers 5"},
        {"/textures/0/extensions/EXT_texture_webp/source", "/EXT_texture_webp/source: refers to images 5"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "/baseColorTexture/index: refers to textures 5"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale",
         "/KHR_texture_transform/scale: must be an array"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset",
         "/KHR_texture_transform/offset: must be an array"},
    };
    document_["samplers"] = json::array({json::object()});
    for (const auto& [pointer, expected] : cases) {
        json document = document_;
        document[json::json_pointer(pointer)] = 5;
        EXPECT_MENTIONS(failure(document), expected);
    }
    map()["texCoord"] = -1;
    EXPECT_MENTIONS(failure(document_), "/baseColorTexture/texCoord: must be a non-negative integer");
    map()["texCoord"] = std::uint64_t{1} << 40;
    EXPECT_MENTIONS(failure(document_), "/baseColorTexture/texCoord: is 1099511627776");
}

TEST_F(LoadTextureTest, WebPTakesThePlaceOfTheSourceForOtherReaders) {
    document_["images"].push_back({{"uri", dataUri(encoded<std::uint8_t>(folder_ / "b.png", {2, 1, 1}, {0, 0}))}});
    document_["textures"][0]["extensions"]["EXT_texture_webp"] = {{"source", 1}};
    document_["extensionsRequired"] = {"EXT_texture_webp"};
    EXPECT_EQ(load(document_).images.at(0).width, 2u);
    document_["textures"][0].erase("source");
    EXPECT_EQ(load(document_).images.at(0).width, 2u);
    document_["textures"][0] = {{"source", 0}, {"extensions", {{"EXT_texture_webp", json::object()}}}};
    EXPECT_EQ(load(document_).images.at(0).width, 1u);
}

TEST_F(LoadTextureTest, TexturesWithoutImageAreLeftOut) {
    document_["textures"][0] = json::object();
    const Scene scene = load(document_);
    EXPECT_FALSE(scene.materials.at(0).map(MapSlot::baseColor).present());
    EXPECT_TRUE(scene.meshes.at(0).uvs.empty());
    EXPECT_TRUE(mentions(scene.warnings, "/textures/0: has no image of a format that is supported"));
}

Vec2d apply(const TextureMap& map, const Vec2d& uv) { return map.uvFromMesh * uv + map.offset; }

TEST_F(LoadTextureTest, TransformsScaleThenRotateThenMove) {
    EXPECT_EQ(apply(loadMap(), {0.25, 0.75}), Vec2d(0.25, 0.75));
    transform() = {{"offset", {0.5, -0.25}}};
    EXPECT_EQ(apply(loadMap(), {0.25, 0.75}), Vec2d(0.75, 0.5));
    transform() = {{"scale", {2, -3}}};
    EXPECT_EQ(apply(loadMap(), {0.25, 0.5}), Vec2d(0.5, -1.5));
    // A quarter turn counter-clockwise, with v downwards: +u becomes -v, and +v becomes +u.
    transform() = {{"rotation", kPi / 2}};
    EXPECT_NEAR(glm::distance(apply(loadMap(), {1, 0}), Vec2d(0, -1)), 0.0, 1e-15);
    EXPECT_NEAR(glm::distance(apply(loadMap(), {0, 1}), Vec2d(1, 0)), 0.0, 1e-15);
    // The extension's example: the lower left quadrant, turned.
    transform() = {{"offset", {0, 1}}, {"rotation", kPi / 2}, {"scale", {0.5, 0.5}}};
    EXPECT_NEAR(glm::distance(apply(loadMap(), {0, 0}), Vec2d(0, 1)), 0.0, 1e-15);
    EXPECT_NEAR(glm::distance(apply(loadMap(), {1, 0}), Vec2d(0, 0.5)), 0.0, 1e-15);
    EXPECT_NEAR(glm::distance(apply(loadMap(), {0, 1}), Vec2d(0.5, 1)), 0.0, 1e-15);
    // Unequal scales come first: (1, 1) -> (2, 3) -> turned by 30 degrees, as cos = 0.866, sin = 0.5 -> moved.
    transform() = {{"offset", {10, 20}}, {"rotation", kPi / 6}, {"scale", {2, 3}}};
    const double h = std::sqrt(0.75);
    EXPECT_NEAR(glm::distance(apply(loadMap(), {1, 1}), Vec2d(10 + 2 * h + 1.5, 20 - 1 + 3 * h)), 0.0, 1e-14);
}

TEST_F(LoadTextureTest, TransformsChooseTheirSet) {
    primitiveOf(document_)["attributes"]["TEXCOORD_3"] = addUvs({5, 6, 7, 8, 9, 10});
    map()["texCoord"] = 0;
    transform() = {{"texCoord", 3}};
    const Scene scene = load(document_);
    ASSERT_EQ(scene.meshes.at(0).uvs.size(), 1u); // no other set is kept
    EXPECT_EQ(scene.meshes[0].uvs[0], (std::vector<Vec2<float>>{{5, 6}, {7, 8}, {9, 10}}));
    EXPECT_EQ(scene.materials.at(0).map(MapSlot::baseColor).uvSet, 0u);
}

TEST_F(LoadTextureTest, SetsThatMapsUseAreKeptInOrder) {
    primitiveOf(document_)["attributes"]["TEXCOORD_1"] = addUvs(std::vector<float>(6, 1.0f));
    primitiveOf(document_)["attributes"]["TEXCOORD_2"] = addUvs(std::vector<float>(6, 2.0f));
    map()["texCoord"] = 2;
    json& material = document_["materials"][0];
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
    material["emissiveTexture"] = {{"index", 0}, {"texCoord", 2}};
    material["emissiveFactor"] = {1, 1, 1};
    const Scene scene = load(document_);
    ASSERT_EQ(scene.meshes.at(0).uvs.size(), 2u);
    EXPECT_EQ(scene.meshes[0].uvs[0].at(1), Vec2<float>(1, 0));
    EXPECT_EQ(scene.meshes[0].uvs[1].at(1), Vec2<float>(2, 2));
    EXPECT_EQ(scene.materials.at(0).map(MapSlot::metallicRoughness).uvSet, 0u);
    EXPECT_EQ(scene.materials[0].map(MapSlot::baseColor).uvSet, 1u);
    EXPECT_EQ(scene.materials[0].map(MapSlot::emission).uvSet, 1u);
}

TEST_F(LoadTextureTest, MapsWithoutCoordinatesAreLeftOutForThatMesh) {
    document_["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0},
                                                                                     {"texCoord", 4000000000u}};
    json& primitives = document_["meshes"][0]["primitives"];
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"material", 0}});
    primitives.push_back(primitives[1]);
    const Scene scene = load(document_);
    ASSERT_EQ(scene.meshes.size(), 3u);
    const Material& first = scene.materials.at(scene.meshes[0].material);
    EXPECT_TRUE(first.map(MapSlot::baseColor).present());
    EXPECT_FALSE(first.map(MapSlot::metallicRoughness).present());
    EXPECT_EQ(scene.meshes[0].uvs.size(), 1u);
    const Material& second = scene.materials.at(scene.meshes[1].material);
    EXPECT_FALSE(second.map(MapSlot::baseColor).present());
    EXPECT_EQ(second.name, first.name);
    EXPECT_TRUE(scene.meshes[1].uvs.empty());
    EXPECT_EQ(scene.meshes[1].material, scene.meshes[2].material); // one material for all that lack the same
    EXPECT_TRUE(
        mentions(scene.warnings, "it has no TEXCOORD_4000000000, which maps of its material use; they are left"));
    EXPECT_TRUE(mentions(scene.warnings, "it has no TEXCOORD_0, which"));
}

} // namespace
} // namespace isolux::load_test
