// Materials of glTF files: every factor, its default, and what is out of range.
#include "unit/load_images.h"

namespace isolux::load_test {
namespace {

/// Loads one material, which the triangle has.
class LoadMaterialTest : public LoadTest {
protected:
    static json documentOf(const json& material) {
        json document = triangleDocument();
        document["materials"] = json::array({material});
        if (const auto extensions = material.find("extensions"); extensions != material.end())
            for (const auto& item : extensions->items()) document["extensionsUsed"].push_back(item.key());
        primitiveOf(document)["material"] = 0;
        return document;
    }
    Material loadMaterial(const json& material) {
        const Scene scene = load(documentOf(material));
        EXPECT_TRUE(scene.warnings.empty());
        return scene.materials.at(0);
    }
};

json extension(const std::string& name, const json& members) { return {{"extensions", {{name, members}}}}; }

TEST_F(LoadMaterialTest, DefaultsAreThoseOfGltf) {
    for (const Material& material : {load(triangleDocument()).materials.at(0), loadMaterial(json::object())}) {
        EXPECT_EQ(material.baseColor, Vec3d(1.0));
        EXPECT_EQ(material.emission, Vec3d(0.0));
        EXPECT_FALSE(material.doubleSided);
        EXPECT_EQ(material.metallic, 1.0);
        EXPECT_EQ(material.roughness, 1.0);
        EXPECT_EQ(material.ior, 1.5);
        EXPECT_EQ(material.specular, 1.0);
        EXPECT_EQ(material.specularColor, Vec3d(1.0));
        EXPECT_EQ(material.transmission, 0.0);
        EXPECT_EQ(material.thickness, 0.0);
        EXPECT_EQ(material.attenuationColor, Vec3d(1.0));
        EXPECT_EQ(material.attenuationDistance, std::numeric_limits<double>::infinity());
        EXPECT_EQ(material.alphaMode, AlphaMode::opaque);
        EXPECT_EQ(material.alpha, 1.0);
        EXPECT_EQ(material.alphaCutoff, 0.5);
        EXPECT_FALSE(material.unlit);
        for (const TextureMap& map : material.maps) EXPECT_FALSE(map.present());
    }
    // An extension without members changes nothing but what its presence says.
    json material;
    for (const char* name : {"KHR_materials_ior", "KHR_materials_specular", "KHR_materials_transmission",
                             "KHR_materials_volume", "KHR_materials_emissive_strength"})
        material["extensions"][name] = json::object();
    EXPECT_EQ(loadMaterial(material).ior, 1.5);
    EXPECT_EQ(loadMaterial(material).specular, 1.0);
    EXPECT_EQ(loadMaterial(material).transmission, 0.0);
}

TEST_F(LoadMaterialTest, FactorsOfTheCore) {
    const Material material =
        loadMaterial({{"name", "paint"},
                      {"pbrMetallicRoughness",
                       {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0}}},
                      {"emissiveFactor", {0.5, 0.25, 1}},
                      {"doubleSided", true}});
    EXPECT_EQ(material.name, "paint");
    EXPECT_EQ(material.baseColor, Vec3d(0.1, 0.2, 0.3));
    EXPECT_EQ(material.alpha, 0.4);
    EXPECT_EQ(material.metallic, 0.25);
    EXPECT_EQ(material.roughness, 0.0); // a mirror
    EXPECT_EQ(material.emission, Vec3d(0.5, 0.25, 1));
    EXPECT_TRUE(material.doubleSided);
}

TEST_F(LoadMaterialTest, FactorsOfExtensions) {
    const Material glass = loadMaterial(
        {{"extensions",
          {{"KHR_materials_ior", {{"ior", 1.33}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.75}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 0.5}, {"attenuationDistance", 2}, {"attenuationColor", {0.9, 0.5, 0}}}}}}});
    EXPECT_EQ(glass.ior, 1.33);
    EXPECT_EQ(glass.transmission, 0.75);
    EXPECT_EQ(glass.thickness, 0.5);
    EXPECT_EQ(glass.attenuationDistance, 2.0);
    EXPECT_EQ(glass.attenuationColor, Vec3d(0.9, 0.5, 0));
    const Material velvet = loadMaterial(
        extension("KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {2, 0.5, 0}}}));
    EXPECT_EQ(velvet.specular, 0.5);
    EXPECT_EQ(velvet.specularColor, Vec3d(2, 0.5, 0));
}

TEST_F(LoadMaterialTest, IndexZeroReflectsInFullAtEveryAngle) {
    const double ior = loadMaterial(extension("KHR_materials_ior", {{"ior", 0}})).ior;
    const auto root = static_cast<float>((ior - 1.0) / (ior + 1.0));
    EXPECT_EQ(root * root, 1.0f);
    EXPECT_EQ(loadMaterial(extension("KHR_materials_ior", {{"ior", 1}})).ior, 1.0);
}

TEST_F(LoadMaterialTest, AlphaModes) {
    EXPECT_EQ(loadMaterial({{"alphaMode", "OPAQUE"}}).alphaMode, AlphaMode::opaque);
    EXPECT_EQ(loadMaterial({{"alphaMode", "BLEND"}}).alphaMode, AlphaMode::blend);
    const Material mask = loadMaterial({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}});
    EXPECT_EQ(mask.alphaMode, AlphaMode::mask);
    EXPECT_EQ(mask.alphaCutoff, 0.25);
    EXPECT_EQ(loadMaterial({{"alphaMode", "MASK"}, {"alphaCutoff", 1.5}}).alphaCutoff, 1.5); // nothing is there
}

TEST_F(LoadMaterialTest, UnlitIgnoresEveryLobe) {
    json document = texturedDocument(whiteImage(folder_));
    json& material = document["materials"][0];
    material["pbrMetallicRoughness"].update({{"baseColorFactor", {0.5, 0.5, 0.5, 0.25}}, {"metallicFactor", 0.5}});
    material["emissiveFactor"] = {1, 1, 1};
    material["emissiveTexture"] = {{"index", 0}};
    material["alphaMode"] = "BLEND";
    material["extensions"] = {{"KHR_materials_unlit", json::object()},
                              {"KHR_materials_transmission", {{"transmissionFactor", 1}}}};
    document["extensionsRequired"] = {"KHR_materials_unlit"};
    const Material unlit = load(document).materials.at(0);
    EXPECT_TRUE(unlit.unlit);
    EXPECT_EQ(unlit.baseColor, Vec3d(0.5));
    EXPECT_EQ(unlit.alpha, 0.25);
    EXPECT_EQ(unlit.alphaMode, AlphaMode::blend);
    EXPECT_TRUE(unlit.map(MapSlot::baseColor).present());
    EXPECT_FALSE(unlit.map(MapSlot::emission).present());
    EXPECT_EQ(unlit.emission, Vec3d(0.0));
    EXPECT_EQ(unlit.metallic, 0.0);
    EXPECT_EQ(unlit.transmission, 0.0);
}

TEST_F(LoadMaterialTest, EveryMapHasItsSlot) {
    json document = texturedDocument(whiteImage(folder_));
    document["textures"] = json::array();
    for (int i = 0; i < 9; ++i) // told apart by how they are wrapped and filtered
        document["textures"].push_back({{"source", 0}, {"sampler", i}});
    for (const int filter : {9728, 9729, 9728})
        for (const int wrap : {10497, 33648, 33071})
            document["samplers"].push_back({{"magFilter", filter}, {"wrapS", wrap}});
    const auto map = [](int texture) { return json{{"index", texture}}; };
    document["materials"][0] = {
        {"pbrMetallicRoughness", {{"baseColorTexture", map(0)}, {"metallicRoughnessTexture", map(1)}}},
        {"normalTexture", {{"index", 2}, {"scale", -2.5}}},
        {"emissiveTexture", map(3)},
        {"emissiveFactor", {1, 1, 1}},
        {"occlusionTexture", map(8)},
        {"extensions",
         {{"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", map(4)}}},
          {"KHR_materials_volume", {{"thicknessFactor", 1}, {"thicknessTexture", map(5)}}},
          {"KHR_materials_specular", {{"specularTexture", map(0)}, {"specularColorTexture", map(1)}}}}}};
    const Scene scene = load(document);
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.normalScale, -2.5);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.textures.size(), 6u);
    const std::vector<std::pair<TextureFilter, TextureWrap>> expected = {
        {TextureFilter::nearest, TextureWrap::repeat},        {TextureFilter::nearest, TextureWrap::mirroredRepeat},
        {TextureFilter::nearest, TextureWrap::clampToEdge},   {TextureFilter::linear, TextureWrap::repeat},
        {TextureFilter::linear, TextureWrap::mirroredRepeat}, {TextureFilter::linear, TextureWrap::clampToEdge},
        {TextureFilter::nearest, TextureWrap::repeat},        {TextureFilter::nearest, TextureWrap::mirroredRepeat}};
    for (std::size_t slot = 0; slot < kMapSlots; ++slot) {
        ASSERT_TRUE(material.maps[slot].present()) << slot;
        const Texture& texture = scene.textures.at(material.maps[slot].texture);
        EXPECT_EQ(std::pair(texture.filter, texture.wrapU), expected[slot]) << slot;
        EXPECT_EQ(texture.wrapV, TextureWrap::repeat);
    }
    EXPECT_TRUE(mentions(scene.warnings, "/materials/0: KHR_materials_specular plays no part in what transmits"));
}

TEST_F(LoadMaterialTest, MapsThatMultiplyZeroAreLeftOut) {
    json document = texturedDocument(whiteImage(folder_));
    const json map = {{"index", 0}};
    document["materials"][0] = {
        {"pbrMetallicRoughness", {{"metallicRoughnessTexture", map}, {"metallicFactor", 0}, {"roughnessFactor", 0}}},
        {"normalTexture", {{"index", 0}, {"scale", 0}}},
        {"emissiveTexture", map},
        {"extensions",
         {{"KHR_materials_transmission", {{"transmissionTexture", map}}},
          {"KHR_materials_volume", {{"thicknessFactor", 1}, {"thicknessTexture", map}}},
          {"KHR_materials_specular",
           {{"specularFactor", 0}, {"specularTexture", map}, {"specularColorTexture", map}}}}}};
    const Scene scene = load(document);
    for (const TextureMap& left : scene.materials.at(0).maps) EXPECT_FALSE(left.present());
    EXPECT_TRUE(scene.images.empty());
    EXPECT_TRUE(scene.meshes.at(0).uvs.empty());
}

TEST_F(LoadMaterialTest, WhatIsOutOfRangeIsRefusedByPointer) {
    const auto pbr = [](const json& members) { return json{{"pbrMetallicRoughness", members}}; };
    const std::vector<std::pair<std::string, json>> cases = {
        {"/pbrMetallicRoughness/metallicFactor: is 1.5", pbr({{"metallicFactor", 1.5}})},
        {"/pbrMetallicRoughness/roughnessFactor: is -1", pbr({{"roughnessFactor", -1}})},
        {"/pbrMetallicRoughness/baseColorFactor/3: is 2", pbr({{"baseColorFactor", {1, 1, 1, 2}}})},
        {"/pbrMetallicRoughness: must be an object", {{"pbrMetallicRoughness", 1}}},
        {"/emissiveFactor/0: is -1", {{"emissiveFactor", {-1, 0, 0}}}},
        {"/alphaMode: must be OPAQUE, MASK or BLEND", {{"alphaMode", "mask"}}},
        {"/alphaCutoff: is -0.5", {{"alphaCutoff", -0.5}}},
        {"/extensions/KHR_materials_ior/ior: is 0.5 but must be 0 or at least 1",
         extension("KHR_materials_ior", {{"ior", 0.5}})},
        {"/ior: is -0.5", extension("KHR_materials_ior", {{"ior", -0.5}})},
        {"/extensions/KHR_materials_specular/specularFactor: is 1.1",
         extension("KHR_materials_specular", {{"specularFactor", 1.1}})},
        {"/specularColorFactor/2: is -1", extension("KHR_materials_specular", {{"specularColorFactor", {1, 1, -1}}})},
        {"/transmissionFactor: is 2", extension("KHR_materials_transmission", {{"transmissionFactor", 2}})},
        {"/thicknessFactor: is -1", extension("KHR_materials_volume", {{"thicknessFactor", -1}})},
        {"/attenuationDistance: must be positive", extension("KHR_materials_volume", {{"attenuationDistance", 0}})},
        {"/attenuationColor/1: is 1.5", extension("KHR_materials_volume", {{"attenuationColor", {0, 1.5, 0}}})},
        {"/normalTexture/index: is missing", {{"normalTexture", json::object()}}},
        {"/occlusionTexture/index: refers to textures 7", {{"occlusionTexture", {{"index", 7}}}}},
    };
    for (const auto& [expected, material] : cases) {
        const std::string message = failure(documentOf(material));
        EXPECT_MENTIONS(message, "/materials/0/");
        EXPECT_MENTIONS(message, expected);
    }
}

/// Its square would leave single precision.
TEST_F(LoadMaterialTest, NormalMapsAreScaledWithinReason) {
    json document = texturedDocument(whiteImage(folder_));
    json& normal = document["materials"][0]["normalTexture"];
    normal = {{"index", 0}, {"scale", 1e30}};
    EXPECT_MENTIONS(failure(document), "/materials/0/normalTexture/scale: is 1e+30");
    normal["scale"] = -1e6;
    EXPECT_EQ(load(document).materials.at(0).normalScale, -1e6);
}

TEST_F(LoadMaterialTest, WhatIsNotSupportedYetIsNamed) {
    json document = documentOf(json::object());
    const std::vector<std::string> names = {"KHR_materials_clearcoat",   "KHR_materials_sheen",
                                            "KHR_materials_iridescence", "KHR_materials_anisotropy",
                                            "KHR_materials_dispersion",  "KHR_materials_variants"};
    document["extensionsUsed"] = names;
    const Scene scene = load(document);
    EXPECT_EQ(scene.warnings.size(), names.size());
    for (const std::string& name : names) EXPECT_TRUE(mentions(scene.warnings, name + " is not supported; ignored"));
}

TEST_F(LoadMaterialTest, WhatIsNotSupportedIsNamedAtTheFirstMaterialThatHasIt) {
    json document = documentOf(json::object());
    const json material = {{"extensions", {{"KHR_materials_clearcoat", json::object()}}}};
    for (int i = 0; i < 2; ++i) document["materials"].push_back(material);
    document["extensionsUsed"] = {"KHR_materials_clearcoat", "KHR_materials_sheen"};
    EXPECT_EQ(load(document).warnings,
              (std::vector<std::string>{"/materials/1/extensions: KHR_materials_clearcoat is not supported; ignored",
                                        "/extensionsUsed/1: KHR_materials_sheen is not supported; ignored"}));
}

} // namespace
} // namespace isolux::load_test
