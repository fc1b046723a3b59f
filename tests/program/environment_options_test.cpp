// What shines on a scene from infinitely far away, by options, by a file, or because nothing else does.
#include "film/image.h"
#include "support/cube_scene.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <vector>

namespace isolux::test {
namespace {

using nlohmann::json;

constexpr const char* kSmall = "--backend reference --size 12x8 --spp 4 --progress none ";

class EnvironmentOptionsTest : public CubeSceneTest {
protected:
    [[nodiscard]] ProgramResult render(const std::string& options) const {
        return runProgram("render " + scene() + " " + kSmall + "-o '" + file("a.exr") + "' --json '" + file("a.json") +
                          "' " + options);
    }
    [[nodiscard]] json report() const {
        std::ifstream stream(file("a.json"));
        return json::parse(stream);
    }
    /// The image of a render that must go well.
    [[nodiscard]] Image image(const std::string& options) const {
        const ProgramResult result = render("-q " + options);
        EXPECT_EQ(result.exitCode, 0) << options << ": " << result.output;
        return readImage(file("a.exr"));
    }
    /// The red of the corner, where camera rays miss the cube.
    [[nodiscard]] float sky(const std::string& options) const {
        const Image seen = image(options);
        return seen.value(0, seen.channel("R").value());
    }
    [[nodiscard]] std::string metadata(const std::string& key) const {
        return metadataText(readImage(file("a.exr")).metadata, key).value_or("");
    }
    /// Exit code 2 and one line with all of these parts.
    void expectRefused(const std::string& options, const std::vector<std::string>& parts) const {
        const ProgramResult result = render(options + " 2>&1 >/dev/null");
        EXPECT_EQ(result.exitCode, 2) << options << ": " << result.output;
        EXPECT_EQ(occurrences(result.output, "\n"), 1u) << result.output;
        for (const std::string& part : parts) EXPECT_TRUE(contains(result.output, part)) << result.output;
    }
    /// An equirectangular image of 2 x 1 texels: both of this radiance.
    void writeMap(const std::string& name, float value) const {
        Image map;
        map.width = 2;
        map.height = 1;
        map.channels = {"R", "G", "B"};
        map.values.assign(6, value);
        writeImage(file(name), map);
    }
};

// --- The sky of scenes without a light ---

TEST_F(EnvironmentOptionsTest, ASceneWithoutALightGetsASkyAndOneWarning) {
    const ProgramResult result = render("2>&1 >/dev/null");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_EQ(occurrences(result.output, "\n"), 1u) << result.output;
    for (const char* part : {"warning", "cube.gltf", "no light", "--environment R,G,B or FILE", "--environment none"})
        EXPECT_TRUE(contains(result.output, part)) << result.output;
    EXPECT_TRUE(report().at("environment").at("default"));
    EXPECT_TRUE(metadata("isolux/options").ends_with(" --environment 1")) << "the image can be made again";
    EXPECT_EQ(sky(""), 1.0f);
    EXPECT_EQ(image("").values, image("--environment 1").values);
}

TEST_F(EnvironmentOptionsTest, NoneIsDarkAndExplained) {
    const ProgramResult result = render("--environment none");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_FALSE(contains(result.output, "warning")) << result.output;
    EXPECT_TRUE(contains(result.output, "the image is black: the scene has no light")) << result.output;
    EXPECT_TRUE(report().at("environment").is_null());
    EXPECT_EQ(sky("--environment none"), 0.0f);
    EXPECT_TRUE(contains(metadata("isolux/options"), "--environment none"));
}

TEST_F(EnvironmentOptionsTest, ABlackMapIsNoLight) {
    writeMap("black.exr", 0.0f);
    const std::string options = "--environment '" + file("black.exr") + "'";
    const ProgramResult result = render(options + " 2>&1");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "black.exr' is black")) << result.output;
    EXPECT_TRUE(contains(result.output, "the image is black: the scene has no light")) << result.output;
    EXPECT_TRUE(report().at("environment").is_null());
    EXPECT_TRUE(contains(metadata("isolux/options"), "black.exr"));
}

TEST_F(EnvironmentOptionsTest, OnlySurfacesThatWaitForLightGetASky) {
    json document = cubeDocument();
    addPunctualLight(document, "point");
    writeScene(document);
    EXPECT_FALSE(contains(render("").output, "warning")) << "a lamp";
    document = cubeDocument();
    document["materials"][0]["emissiveFactor"] = {1, 1, 1};
    writeScene(document);
    EXPECT_FALSE(contains(render("").output, "warning")) << "an emitter";
    writeScene(cubeDocument());
    for (const char* integrator : {"normals", "albedo", "depth", "ao"}) {
        EXPECT_FALSE(contains(render(std::string("--integrator ") + integrator).output, "warning")) << integrator;
        EXPECT_TRUE(report().at("environment").is_null()) << integrator;
    }
    EXPECT_TRUE(contains(render("--integrator direct").output, "no light"));
}

/// One that nothing refers to lights nothing.
TEST_F(EnvironmentOptionsTest, AnEmitterThatIsNotInTheSceneIsNoLight) {
    json document = cubeDocument();
    document["materials"].push_back({{"emissiveFactor", {1, 1, 1}}});
    writeScene(document);
    EXPECT_TRUE(contains(render("").output, "no light"));
}

// --- Strength and rotation ---

TEST_F(EnvironmentOptionsTest, StrengthMultipliesWhatIsThere) {
    EXPECT_EQ(sky("--environment-strength 0.25"), 0.25f) << "of the default sky";
    EXPECT_EQ(sky("--environment 2 --environment-strength 0.25"), 0.5f);
    EXPECT_TRUE(contains(metadata("isolux/options"), "--environment 2 --environment-strength 0.25"));
    EXPECT_EQ(sky("--environment 2 --environment-strength 0"), 0.0f);
    for (const char* value : {"-1", "nan", "inf", "much"})
        expectRefused("--environment-strength=" + std::string(value), {"--environment-strength", value});
    expectRefused("--environment 3e38 --environment-strength 10", {"--environment-strength", "single precision"});
}

TEST_F(EnvironmentOptionsTest, WhatIsNotThereCannotBeChanged) {
    json document = cubeDocument();
    addPunctualLight(document, "point");
    writeScene(document);
    expectRefused("--environment-strength 2", {"--environment-strength", "--environment"});
    expectRefused("--environment none --environment-rotation 2", {"--environment-rotation", "--environment"});
    expectRefused("--environment 1 --environment-rotation nan", {"--environment-rotation", "nan"});
    const ProgramResult idle = render("--environment 1 --environment-rotation 90");
    EXPECT_EQ(idle.exitCode, 0);
    EXPECT_TRUE(contains(idle.output, "--environment-rotation: without effect")) << idle.output;
}

// --- Maps ---

TEST_F(EnvironmentOptionsTest, AFileIsAMap) {
    writeMap("sky.exr", 0.5f);
    const ProgramResult dark = render("--environment none -q");
    const std::string plain = report().at("sceneHash");
    const ProgramResult result =
        render("--environment '" + file("sky.exr") + "' --environment-rotation 450 --environment-strength 3");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const json environment = report().at("environment");
    EXPECT_EQ(environment.at("map"), file("sky.exr"));
    EXPECT_EQ(environment.at("rotationDegrees"), 90.0);
    EXPECT_EQ(environment.at("radiance"), json::parse("[3, 3, 3]"));
    EXPECT_FALSE(environment.at("default"));
    const std::string options = metadata("isolux/options");
    for (const std::string& part : {"--environment " + file("sky.exr"), std::string("--environment-rotation 450")})
        EXPECT_TRUE(contains(options, part)) << options;
    const std::string mapped = report().at("sceneHash");
    EXPECT_NE(mapped, plain);
    EXPECT_EQ(metadata("isolux/sceneHash"), mapped);
    writeMap("sky.exr", 0.25f);
    EXPECT_EQ(render("-q --environment '" + file("sky.exr") + "'").exitCode, 0);
    EXPECT_NE(report().at("sceneHash"), mapped) << "another file of the same name";
}

TEST_F(EnvironmentOptionsTest, FilesThatAreNoMapsAreNamed) {
    std::ofstream(file("noise.hdr")) << "nothing of the kind";
    expectRefused("--environment '" + file("noise.hdr") + "'", {"noise.hdr"});
    expectRefused("--environment '" + file("absent.hdr") + "'", {"--environment", "absent.hdr"});
}

TEST_F(EnvironmentOptionsTest, HelpNamesThem) {
    for (const char* command : {"render", "verify", "scene"}) {
        const std::string help = runProgram(std::string(command) + " --help").output;
        for (const char* option : {"--environment ", "--environment-rotation DEGREES", "--environment-strength"})
            EXPECT_TRUE(contains(help, option)) << command << ": " << option;
    }
}

} // namespace
} // namespace isolux::test
