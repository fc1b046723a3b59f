// What the kernels are compiled with: the table of reasons, and options that compile in more.
#include "film/image.h"
#include "support/cube_scene.h"
#include "support/scenes.h"

#include <nlohmann/json.hpp>

#include <cstring>
#include <fstream>
#include <vector>

namespace isolux::test {
namespace {

using nlohmann::json;

class FeatureOptionsTest : public ProgramTest {
protected:
    [[nodiscard]] ProgramResult render(const std::string& options) const {
        return runProgram("render '" + projectScene("cornell_box").string() + "' -q --width 24 --spp 4 -o '" +
                          file("a.exr") + "' --json '" + file("a.json") + "' " + options);
    }
    [[nodiscard]] json reportOf(const std::string& options) const {
        const ProgramResult result = render(options);
        EXPECT_EQ(result.exitCode, 0) << options << ": " << result.output;
        std::ifstream stream(file("a.json"));
        return json::parse(stream);
    }
    [[nodiscard]] static bool has(const json& report, const std::string& feature) {
        return report.at("features").at(feature).at("used").get<bool>();
    }
};

TEST_F(FeatureOptionsTest, TheTableSaysWhatWasLeftOutAndWhy) {
    const ProgramResult result = render("--explain");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    const std::string last = "thin-lens                left out  the camera is a pinhole\n";
    for (const std::string& line : {std::string("kernels           spheres "), std::string("area-lights  "), last})
        EXPECT_TRUE(contains(result.output, line)) << result.output;
    EXPECT_EQ(render("").output, "") << "only if asked";
}

TEST_F(FeatureOptionsTest, MethodsAreFeaturesToo) {
    const json usual = reportOf("");
    const json all = reportOf("--aov all --count-tests --aperture 0.1 --focus 3 --pixel-sampler sobol");
    for (const char* feature : {"aovs", "traversal-counts", "thin-lens", "pixel-samplers", "replicates"}) {
        EXPECT_FALSE(has(usual, feature)) << feature;
        EXPECT_TRUE(has(all, feature)) << feature;
        EXPECT_NE(all.at("features").at(feature).at("reason"), usual.at("features").at(feature).at("reason"));
    }
    EXPECT_GT(usual.at("sceneBytes"), 0u);
    EXPECT_GT(usual.at("firstPixelSeconds"), 0.0);
    EXPECT_GT(usual.at("seconds").at("open"), 0.0);
}

/// Whatever else is compiled in: no bit of the image changes.
TEST_F(FeatureOptionsTest, MoreThanIsNeededChangesNoBit) {
    const json needed = reportOf("");
    const Image image = readImage(file("a.exr"));
    for (const char* options : {"--features all", "--with spheres,smooth-normals --with light-choice"}) {
        const json more = reportOf(options);
        EXPECT_TRUE(has(more, "spheres")) << options;
        EXPECT_TRUE(contains(more.at("features").at("spheres").at("reason"), "all the same")) << options;
        EXPECT_NE(more.at("specialization"), needed.at("specialization")) << options;
        const Image same = readImage(file("a.exr"));
        ASSERT_EQ(same.values.size(), image.values.size());
        EXPECT_EQ(std::memcmp(same.values.data(), image.values.data(), image.values.size() * sizeof(float)), 0)
            << options;
    }
    EXPECT_TRUE(has(reportOf("--with rough-glass"), "glass")) << "what it is reached through";
    EXPECT_FALSE(has(reportOf("--features all --integrator normals --environment 1"), "environment"));
}

/// The box has a lamp of two triangles; a sky alone is one light, and none is chosen, whatever roulette does.
TEST_F(FeatureOptionsTest, OneLightIsNotChosen) {
    EXPECT_TRUE(has(reportOf(""), "light-choice"));
    EXPECT_TRUE(has(reportOf("--roulette off --max-depth 2"), "light-choice"));
    const std::string noLamps = "--environment 1 --light-sampling ";
    EXPECT_FALSE(has(reportOf(noLamps + "bsdf"), "light-choice")) << "no light is sampled";
}

TEST_F(FeatureOptionsTest, TheReferenceHasNoKernels) {
    const json report = reportOf("--backend reference");
    EXPECT_EQ(report.at("features"), json::object());
    EXPECT_EQ(report.at("specialization"), json::object());
    EXPECT_GT(report.at("firstPixelSeconds"), 0.0);
}

TEST_F(FeatureOptionsTest, UnknownFeaturesListWhatThereIs) {
    const ProgramResult result = render("--with nonsense");
    EXPECT_EQ(result.exitCode, 2);
    for (const char* part : {"--with", "nonsense", "spheres", "smooth-normals"})
        EXPECT_TRUE(contains(result.output, part)) << result.output;
    EXPECT_EQ(render("--features some").exitCode, 2);
    const std::string help = runProgram("render --help").output;
    for (const char* part : {"Diagnostics:", "--features", "--with FEATURE,...", "--explain"})
        EXPECT_TRUE(contains(help, part)) << part;
}

// --- Compiled kernels that are kept ---

TEST_F(FeatureOptionsTest, AnyCacheFolderWillDo) {
    std::ofstream(file("file")) << "no folder";
    for (const std::string& options :
         std::vector<std::string>{"--no-cache", "--cache-dir '" + file("new/cache") + "'",
                                  "--cache-dir '" + file("file") + "'", "--cache-dir /proc/cache"}) {
        const ProgramResult result = render(options);
        EXPECT_EQ(result.exitCode, 0) << options;
        EXPECT_EQ(result.output, "") << options;
    }
    EXPECT_EQ(render("--no-cache --cache-dir /tmp").exitCode, 2);
    EXPECT_EQ(runProgram("devices", "env -u HOME -u XDG_CACHE_HOME").exitCode, 0);
}

TEST_F(FeatureOptionsTest, ProgramsAtOnceShareAFolder) {
    const std::string options = "render '" + projectScene("cornell_box").string() +
                                "' -q --width 8 --spp 1 --cache-dir '" + file("cache") + "' -o ";
    const ProgramResult both = runProgram(options + file("1.png") + " & '" + ISOLUX_BINARY_DIR + "/isolux' " + options +
                                          file("2.png") + "; one=$?; wait $! && exit $one");
    EXPECT_EQ(both.exitCode, 0) << both.output;
    EXPECT_EQ(both.output, "");
}

} // namespace
} // namespace isolux::test
