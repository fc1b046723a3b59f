// `isolux stress`: what it prints and writes, what it refuses, and other renderers beside ours.
#include "support/cube_scene.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace isolux::test {
namespace {

using nlohmann::json;

class StressCommandTest : public CubeSceneTest {
protected:
    [[nodiscard]] ProgramResult stress(const std::string& options) const {
        return runProgram("stress --quick --progress none " + options);
    }
    [[nodiscard]] json report(const std::string& folder) const {
        std::ifstream stream(file(folder) + "/stress.json");
        return json::parse(stream);
    }
};

TEST_F(StressCommandTest, WritesJsonAndAPage) {
    const ProgramResult result = stress("--family scale -o '" + file("out") + "'");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "=== scale")) << result.output;
    EXPECT_TRUE(contains(result.output, "within 0.1 %")) << result.output;
    const json found = report("out");
    EXPECT_TRUE(found["quick"]);
    EXPECT_TRUE(found["broken"].empty());
    ASSERT_EQ(found["families"].size(), 1u);
    for (const json& sweep : found["families"][0]["sweeps"]) {
        EXPECT_EQ(sweep["range"]["device"]["within"], sweep["steps"].size()) << sweep["name"];
        EXPECT_FALSE(sweep["limit"].get<std::string>().empty()) << sweep["name"];
    }
    std::ifstream page(file("out") + "/stress.html");
    EXPECT_TRUE(page.good());
}

TEST_F(StressCommandTest, ShowsOthersBesideOurs) {
    ASSERT_EQ(stress("-q --family nothing -o '" + file("first") + "'").exitCode, 0);
    json other = report("first");
    for (json& sweep : other["families"][0]["sweeps"])
        for (json& step : sweep["steps"]) {
            step["figures"].erase(step["figures"].begin() + 1, step["figures"].end());
            step["figures"][0]["renderer"] = "another";
        }
    std::ofstream(file("other.json")) << other;
    const ProgramResult result =
        stress("-q --family nothing --beside '" + file("other.json") + "' -o '" + file("second") + "'");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const json step = report("second")["families"][0]["sweeps"][0]["steps"][0];
    EXPECT_EQ(step["figures"].back()["renderer"], "another");
}

TEST_F(StressCommandTest, RefusesWhatItCannotRead) {
    EXPECT_EQ(stress("--family nonsense").exitCode, 2);
    EXPECT_EQ(stress("--family nothing --beside /nowhere.json").exitCode, 2);
    std::ofstream(file("broken.json")) << "{\"families\": [";
    const ProgramResult result = stress("-q --family nothing --beside '" + file("broken.json") + "'");
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_TRUE(contains(result.output, "broken.json")) << result.output;
    EXPECT_EQ(occurrences(result.output, "\n"), 1u) << result.output;
}

} // namespace
} // namespace isolux::test
