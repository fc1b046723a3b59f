// `isolux stress`: what it prints and writes, what it refuses, what an interrupted run leaves, and other renderers
// beside ours.
#include "support/cube_scene.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace isolux::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class StressCommandTest : public CubeSceneTest {
protected:
    [[nodiscard]] ProgramResult stress(const std::string& options) const {
        return runProgram("stress --quick --progress none " + options);
    }
    [[nodiscard]] json report(const std::string& folder) const {
        std::ifstream stream(file(folder) + "/stress.json");
        return json::parse(stream);
    }
    /// Stopped by Ctrl-C a moment after a file is there that this pattern of the shell's names.
    [[nodiscard]] ProgramResult interrupted(const std::string& options, const std::string& pattern) const {
        return stress(options + " & for i in $(seq 2000); do ls " + pattern + " >/dev/null 2>&1 && break; sleep 0.1; " +
                      "done; sleep 0.3; kill -INT $!; wait $!");
    }
    /// Exit code 2 and one line with all of these parts, before a device is looked for, which there is not.
    void expectRefused(const std::string& options, const std::vector<std::string>& parts) const {
        const ProgramResult result = stress("-q --family nothing --device nowhere " + options);
        EXPECT_EQ(result.exitCode, 2) << options << ": " << result.output;
        EXPECT_EQ(occurrences(result.output, "\n"), 1u) << result.output;
        for (const std::string& part : parts) EXPECT_TRUE(contains(result.output, part)) << result.output;
    }
};

/// That every renderer has taken all samples of a step.
void expectWhole(const json& step) {
    ASSERT_FALSE(step["figures"].empty()) << step;
    for (const json& figures : step["figures"]) {
        EXPECT_FALSE(figures.contains("failure")) << figures;
        EXPECT_GT(figures["tried"], 0) << figures;
        EXPECT_EQ(figures["tried"], step["figures"][0]["tried"]) << figures;
    }
}

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
    expectRefused("--beside /nowhere.json", {"/nowhere.json"});
    std::ofstream(file("broken.json")) << "{\"families\": [";
    expectRefused("--beside '" + file("broken.json") + "'", {"broken.json", "JSON"});
    std::ofstream(file("other.json")) << R"({"families": [{"name": "nothing"}]})";
    expectRefused("--beside '" + file("other.json") + "' -o '" + file("out") + "'",
                  {"other.json", "no report of stress tests"});
    EXPECT_FALSE(fs::exists(file("out")));
}

TEST_F(StressCommandTest, RefusesFoldersThatItCannotWriteTo) {
    const std::string folder = file("cube.gltf") + "/out"; // below a file
    expectRefused("-o '" + folder + "'", {folder});
    expectRefused("--export '" + folder + "'", {folder});
}

TEST_F(StressCommandTest, ExportsAlone) {
    const std::string exporting = "--export '" + file("scenes") + "' ";
    std::ofstream(file("other.json")) << "{}";
    expectRefused(exporting + "--json", {"--export", "--json"});
    expectRefused(exporting + "-o '" + file("out") + "'", {"--export", "--output"});
    expectRefused(exporting + "--beside '" + file("other.json") + "'", {"--export", "--beside"});
    for (const char* folder : {"scenes", "out"}) EXPECT_FALSE(fs::exists(file(folder))) << folder;
}

TEST_F(StressCommandTest, AnInterruptedRunKeepsWholeSteps) {
    const std::string folder = "'" + file("out") + "'";
    const ProgramResult result = interrupted("-o " + folder, folder + "/stress.json");
    EXPECT_EQ(result.exitCode, 130) << result.output;
    EXPECT_TRUE(contains(result.output, "interrupted")) << result.output;
    const json found = report("out");
    EXPECT_TRUE(found["broken"].empty()) << found["broken"];
    ASSERT_FALSE(found["families"].empty());
    EXPECT_LT(found["families"].size(), 13u) << "there are no more";
    EXPECT_EQ(found["families"][0]["sweeps"].size(), 3u) << "the first was whole";
    for (const json& family : found["families"])
        for (const json& sweep : family["sweeps"]) {
            EXPECT_FALSE(sweep["steps"].empty()) << sweep["name"];
            for (const json& step : sweep["steps"]) expectWhole(step);
        }
    EXPECT_TRUE(fs::exists(file("out") + "/stress.html"));
    EXPECT_EQ(std::distance(fs::directory_iterator(file("out")), fs::directory_iterator()), 2);
}

TEST_F(StressCommandTest, AnInterruptedExportLeavesWholeScenes) {
    const std::string folder = "'" + file("scenes") + "'";
    const ProgramResult result = interrupted("--export " + folder, folder + "/*.json");
    EXPECT_EQ(result.exitCode, 130) << result.output;
    EXPECT_TRUE(contains(result.output, "has the scenes that were whole")) << result.output;
    std::size_t count = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(file("scenes"))) {
        const fs::path& path = entry.path();
        ++count;
        EXPECT_EQ(path.extension(), ".json") << path;
        std::ifstream stream(path);
        const json scene = json::parse(stream);
        EXPECT_TRUE(std::isfinite(scene["truth"][1].get<double>())) << path;
        EXPECT_EQ(scene["family"], path.filename().string().substr(0, scene["family"].get<std::string>().size()));
    }
    EXPECT_GT(count, 0u);
}

} // namespace
} // namespace isolux::test
