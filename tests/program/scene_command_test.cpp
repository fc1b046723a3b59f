// `isolux scene` as users run it: what it says of a file, as text and as JSON.
#include "support/cube_scene.h"

#include <nlohmann/json.hpp>

namespace isolux::test {
namespace {

using nlohmann::json;

class SceneCommand : public CubeSceneTest {
protected:
    [[nodiscard]] json report(const std::string& options = "") const {
        const ProgramResult result = runProgram("scene " + scene() + " --json " + options);
        EXPECT_EQ(result.exitCode, 0) << result.output;
        return json::parse(result.output);
    }
    /// Whether kernels have a feature for the scene.
    [[nodiscard]] static bool has(const json& report, const std::string& feature) {
        return report.at("features").at(feature).at("used").get<bool>();
    }
    /// Exit code 2 and one line that names the file and the JSON pointer.
    void expectBadInput(const std::string& pointer) const {
        const ProgramResult result = runProgram("scene " + scene());
        EXPECT_EQ(result.exitCode, 2) << result.output;
        EXPECT_EQ(occurrences(result.output, "\n"), 1u) << result.output;
        EXPECT_TRUE(contains(result.output, "isolux: error: " + file("cube.gltf") + ": " + pointer)) << result.output;
    }
};

std::vector<std::string> keysOf(const json& object) {
    std::vector<std::string> keys;
    for (const auto& item : object.items()) keys.push_back(item.key());
    return keys;
}

TEST_F(SceneCommand, JsonHasEveryKey) {
    const json all = report();
    EXPECT_EQ(keysOf(all), (std::vector<std::string>{"bounds", "bvh", "cameras", "deviceBytes", "environment",
                                                     "features", "file", "instances", "lights", "materials",
                                                     "meshTriangles", "meshes", "report", "sceneHash", "schema",
                                                     "singleSidedMaterials", "spheres", "triangles", "unsupported"}));
    EXPECT_EQ(keysOf(all.at("bvh")), (std::vector<std::string>{"depth", "leaves", "meanLeafSize", "nodes", "sahCost",
                                                               "stackEntries", "wideNodes"}));
    EXPECT_EQ(all.at("schema"), 1);
    EXPECT_EQ(all.at("report"), "scene");
    EXPECT_EQ(all.at("file"), file("cube.gltf"));
    EXPECT_EQ(all.at("bounds"), json::parse("[[-1, -1, -1], [1, 1, 1]]"));
    EXPECT_EQ(all.at("unsupported"), json::array());
}

TEST_F(SceneCommand, CountsWhatIsThere) {
    json document = cubeDocument();
    document["nodes"].push_back({{"name", "second"}, {"mesh", 0}, {"translation", {4, 0, 0}}});
    document["nodes"].push_back({{"extras", {{"sphere", {{"radius", 0.5}}}, {"material", 0}}}});
    document["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    writeScene(document);
    const json counts = report();
    EXPECT_EQ(counts.at("triangles"), 24);
    EXPECT_EQ(counts.at("meshTriangles"), 12);
    EXPECT_EQ(counts.at("meshes"), 1);
    EXPECT_EQ(counts.at("instances"), 2);
    EXPECT_EQ(counts.at("spheres"), 1);
    EXPECT_TRUE(has(counts, "spheres"));
    EXPECT_EQ(counts.at("bounds").at(1), json::parse("[5, 1, 1]"));
}

TEST_F(SceneCommand, DescribesTheBvh) {
    const json bvh = report().at("bvh");
    const std::size_t leaves = bvh.at("leaves");
    EXPECT_EQ(bvh.at("nodes"), 2 * leaves - 1) << "a binary tree";
    EXPECT_DOUBLE_EQ(bvh.at("meanLeafSize").get<double>() * static_cast<double>(leaves), 12.0);
    EXPECT_LE(leaves, std::size_t{1} << bvh.at("depth").get<std::size_t>());
    EXPECT_GT(bvh.at("sahCost"), 0.0);
    EXPECT_GE(bvh.at("stackEntries"), 1);
    EXPECT_GE(bvh.at("wideNodes"), 1);
    EXPECT_GE(report().at("deviceBytes"), sizeof(float) * 9 * 12) << "the corners of twelve triangles";
}

TEST_F(SceneCommand, DescribesTheCameras) {
    const json cameras = report().at("cameras");
    ASSERT_EQ(cameras.size(), 2u);
    EXPECT_EQ(cameras[0].at("name"), "front view");
    EXPECT_EQ(cameras[0].at("projection"), "perspective");
    EXPECT_EQ(cameras[0].at("yfov"), 0.8);
    EXPECT_EQ(cameras[0].at("aspectRatio"), 1.5);
    EXPECT_EQ(cameras[1].at("name"), "front plan");
    EXPECT_EQ(cameras[1].at("projection"), "orthographic");
    EXPECT_EQ(cameras[1].at("ymag"), 2.0);
    EXPECT_EQ(cameras[1].at("position"), json::parse("[0, 0, 6]"));
}

TEST_F(SceneCommand, CountsLightsByKind) {
    EXPECT_EQ(report("--environment none").at("lights"),
              json::parse(R"({"area": 0, "point": 0, "spot": 0, "directional": 0, "environment": 0})"));
    json document = cubeDocument();
    document["materials"][0]["emissiveFactor"] = {1, 1, 1};
    for (const char* type : {"point", "point", "spot", "directional"}) addPunctualLight(document, type);
    document["scenes"][0]["extras"]["cgl_hemisphere_light"]["radiance"] = {1, 1, 1};
    writeScene(document);
    const json lit = report();
    EXPECT_EQ(lit.at("lights"),
              json::parse(R"({"area": 12, "point": 2, "spot": 1, "directional": 1, "environment": 1})"));
}

TEST_F(SceneCommand, FeaturesAreWhatTheSceneNeeds) {
    const json dark = report("--environment none");
    for (const char* feature : {"spheres", "smooth-normals", "area-lights", "punctual-lights", "environment"}) {
        EXPECT_FALSE(has(dark, feature)) << feature;
        EXPECT_NE(dark.at("features").at(feature).at("reason"), "") << feature;
    }
    json document = cubeDocument();
    addPunctualLight(document, "point");
    document["materials"][0]["emissiveFactor"] = {1, 1, 1};
    document["scenes"][0]["extras"]["cgl_hemisphere_light"]["radiance"] = {1, 1, 1};
    document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 0;
    writeScene(document);
    const json lit = report();
    EXPECT_FALSE(has(lit, "spheres"));
    for (const char* feature : {"smooth-normals", "area-lights", "punctual-lights", "environment"})
        EXPECT_TRUE(has(lit, feature)) << feature;
}

TEST_F(SceneCommand, NamesTheEnvironment) {
    const json sky = report();
    EXPECT_EQ(sky.at("environment"), json::parse(R"({"radiance": [1, 1, 1], "extent": "sphere", "map": null,
                                                     "rotationDegrees": null, "default": true})"));
    EXPECT_EQ(sky.at("lights").at("environment"), 1);
    EXPECT_TRUE(report("--environment none").at("environment").is_null());
    EXPECT_EQ(report("--environment 2 --environment-strength 0.25").at("environment").at("radiance"),
              json::parse("[0.5, 0.5, 0.5]"));
    EXPECT_FALSE(report("--environment 2").at("environment").at("default"));
    EXPECT_EQ(report("--environment 2").at("sceneHash"), sky.at("sceneHash")) << "only files enter the hash";
    json document = cubeDocument();
    document["scenes"][0]["extras"]["cgl_hemisphere_light"]["radiance"] = {1, 2, 3};
    writeScene(document);
    const json own = report().at("environment");
    EXPECT_EQ(own.at("radiance"), json::parse("[1, 2, 3]"));
    EXPECT_EQ(own.at("extent"), "upper half");
    EXPECT_FALSE(own.at("default"));
}

TEST_F(SceneCommand, TextSaysTheSame) {
    json document = cubeDocument();
    document["extensionsUsed"].push_back("KHR_materials_sheen");
    document["materials"][0]["extensions"]["KHR_materials_sheen"] = {{"sheenRoughnessFactor", 0.5}};
    writeScene(document);
    const ProgramResult text = runProgram("scene " + scene());
    EXPECT_EQ(text.exitCode, 0) << text.output;
    const json same = report();
    for (const std::string& part :
         {same.at("sceneHash").get<std::string>(), std::string("12, in 1 instances of 1 meshes"),
          std::string("environment       (1, 1, 1), sphere, the sky of scenes without a light"),
          std::string("0 'front view', perspective"), std::string("1 'front plan', orthographic, 4 high"),
          std::string("kernels           spheres                  left out  ")})
        EXPECT_TRUE(contains(text.output, part)) << part << " in\n" << text.output;
    const ProgramResult dark = runProgram("scene " + scene() + " --environment none");
    EXPECT_TRUE(contains(dark.output, "none: images will be black; --environment 1,1,1 adds one")) << dark.output;
    ASSERT_EQ(same.at("unsupported").size(), 1u);
    EXPECT_TRUE(contains(text.output, "unsupported       " + same.at("unsupported")[0].get<std::string>()));
}

TEST_F(SceneCommand, ErrorsNameFileAndJsonPointer) {
    json document = cubeDocument();
    document["nodes"][0]["mesh"] = 7;
    writeScene(document);
    expectBadInput("/nodes/0/mesh");
    document = cubeDocument();
    document["accessors"][1]["count"] = 37;
    writeScene(document);
    expectBadInput("/accessors/1");
    document = cubeDocument();
    document["buffers"][0]["uri"] = "missing.bin";
    writeScene(document);
    expectBadInput("/buffers/0/uri");
}

TEST_F(SceneCommand, BadUsageExitsWithTwo) {
    EXPECT_EQ(runProgram("scene").exitCode, 2);
    EXPECT_EQ(runProgram("scene --json").exitCode, 2);
    EXPECT_EQ(runProgram("scene " + scene() + " --yaml").exitCode, 2);
    EXPECT_EQ(runProgram("scene '" + file("missing.glb") + "'").exitCode, 2);
}

} // namespace
} // namespace isolux::test
