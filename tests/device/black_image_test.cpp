// A black image is never left without a word: `isolux render` says why it is black, and still ends well.
#include "film/image.h"
#include "support/cube_scene.h"

#include <nlohmann/json.hpp>

#include <array>
#include <fstream>

namespace isolux::test {
namespace {

using nlohmann::json;

class BlackImageTest : public CubeSceneTest {
protected:
    [[nodiscard]] ProgramResult render() const {
        return runProgram("render " + scene() + " --size 12x8 --spp 4 --environment none -o '" + file("a.exr") +
                          "' --json '" + file("a.json") + "'");
    }
    [[nodiscard]] json explanations() const {
        std::ifstream stream(file("a.json"));
        return json::parse(stream).at("explanations");
    }
    /// A render that goes well and says this, and no more, of its black image.
    void expectBlack(const std::string& explanation) const {
        const ProgramResult result = render();
        EXPECT_EQ(result.exitCode, 0) << result.output;
        EXPECT_EQ(occurrences(result.output, "the image is black: "), 1u) << result.output;
        EXPECT_TRUE(contains(result.output, explanation)) << result.output;
        ASSERT_EQ(explanations().size(), 1u);
        EXPECT_TRUE(contains(explanations()[0], explanation)) << explanations();
        const Image image = readImage(file("a.exr"));
        const std::array<std::size_t, 3> rgb = image.rgbChannels().value();
        for (const std::size_t channel : rgb)
            for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel)
                ASSERT_EQ(image.value(pixel, channel), 0.0f);
    }
};

TEST_F(BlackImageTest, ALitCubeIsNotBlack) {
    json document = cubeDocument();
    addPunctualLight(document, "point");
    writeScene(document);
    const ProgramResult result = render();
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_FALSE(contains(result.output, "black")) << result.output;
    EXPECT_EQ(explanations(), json::array());
}

TEST_F(BlackImageTest, BlackWithoutALight) { expectBlack("the scene has no light"); }

TEST_F(BlackImageTest, BlackWhereTheCameraLooksAway) {
    json document = cubeDocument();
    addPunctualLight(document, "point");
    document["nodes"][1]["rotation"] = {0, 1, 0, 0}; // by half a turn about y
    writeScene(document);
    expectBlack("the camera looks away from everything");
}

TEST_F(BlackImageTest, BlackInsideASolid) {
    json document = cubeDocument();
    addPunctualLight(document, "point");
    document["nodes"][1]["translation"] = {0, 0, 0};
    writeScene(document);
    expectBlack("the camera lies inside a closed object");
}

} // namespace
} // namespace isolux::test
