// `isolux converge`: what it writes, what it refuses, references that are kept, and what an interrupted run leaves.
#include "film/image.h"
#include "report/convergence.h"
#include "support/cube_scene.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <set>
#include <sstream>
#include <vector>

namespace isolux::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class ConvergeCommandTest : public CubeSceneTest {
protected:
    /// Small enough for a second or two, unless the options say otherwise.
    [[nodiscard]] ProgramResult converge(const std::string& options, const std::string& prefix = "") const {
        std::string arguments = "converge " + scene() + " -o '" + file("out") + "' --cache-dir '" + file("cache") +
                                "' --environment 1 --progress none " + options;
        for (const std::string usual : {"--size 8x6", "--seeds 3", "--max-spp 8"})
            if (!contains(options, usual.substr(0, usual.find(' ')))) arguments += " " + usual;
        return runProgram(arguments, prefix);
    }
    [[nodiscard]] std::string text(const std::string& name) const {
        std::ifstream stream(file("out") + "/" + name);
        std::stringstream text;
        text << stream.rdbuf();
        return text.str();
    }
    [[nodiscard]] json report() const { return json::parse(text("convergence.json")); }
    [[nodiscard]] std::vector<ErrorSample> samples() const { return fromCsv(text("convergence.csv"), "csv"); }
    [[nodiscard]] std::vector<fs::path> references() const {
        std::set<fs::path> found;
        for (const auto& entry : fs::directory_iterator(file("cache") + "/references")) found.insert(entry.path());
        return {found.begin(), found.end()};
    }
    void expectRefused(const std::string& options, const std::vector<std::string>& parts) const {
        const ProgramResult result = converge("-q " + options);
        EXPECT_EQ(result.exitCode, 2) << options << ": " << result.output;
        EXPECT_EQ(occurrences(result.output, "\n"), 1u) << result.output;
        for (const std::string& part : parts) EXPECT_TRUE(contains(result.output, part)) << result.output;
        EXPECT_FALSE(fs::exists(file("out") + "/convergence.csv"));
    }
};

TEST_F(ConvergeCommandTest, WritesFiguresAndImages) {
    const ProgramResult result =
        converge("--variant mis --variant 'a b:--light-sampling hemisphere --pixel-sampler sobol' --errors 0.5,0.1");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "a b: --light-sampling hemisphere --pixel-sampler sobol")) << result.output;
    EXPECT_TRUE(contains(result.output, "rendering two references of 512 samples a pixel")) << result.output;
    const std::vector<ErrorSample> all = samples();
    ASSERT_EQ(all.size(), 2u * 3u * 4u);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].variant, i < 12 ? "mis" : "a b");
        EXPECT_EQ(all[i].seed, i % 12 / 4);
        EXPECT_EQ(all[i].checkpoint, i % 4);
        EXPECT_EQ(all[i].samplesPerPixel, 1u << i % 4);
        EXPECT_GT(all[i].wallSeconds, i % 4 == 0 ? 0.0 : all[i - 1].wallSeconds);
        EXPECT_GT(all[i].setupSeconds, 0.0);
        EXPECT_TRUE(std::isfinite(all[i].flip));
        EXPECT_EQ(std::isnan(all[i].estimate), i % 4 == 0) << "one sample a pixel tells nothing of its error";
    }
    const json written = report();
    EXPECT_EQ(written.at("kind"), "convergence");
    EXPECT_EQ(written.at("errors"), json({0.5, 0.1}));
    EXPECT_EQ(written.at("seeds"), json({0, 1, 2}));
    EXPECT_EQ(written.at("width"), 8);
    EXPECT_EQ(written.at("reference").at("samplesPerPixel"), 1024);
    EXPECT_EQ(written.at("reference").at("method"), "two independent");
    EXPECT_EQ(written.at("variants").at(1).at("options"), "--light-sampling hemisphere --pixel-sampler sobol");
    EXPECT_EQ(written.at("variants").at(1).at("checkpoints").at(3).at("calibration").at("meanLuminance").at("total"),
              3);
    for (const json& image : written.at("images").at("variants")) {
        EXPECT_EQ(readImage(file("out") + "/" + std::string(image.at("image"))).width, 8u);
        EXPECT_EQ(readImage(file("out") + "/" + std::string(image.at("flip"))).width, 8u);
    }
    EXPECT_EQ(written.at("images").at("variants").at(1).at("image"), "a_b.png");
    EXPECT_TRUE(fs::exists(file("out") + "/reference.png"));
}

TEST_F(ConvergeCommandTest, StatisticsAloneComeFromACsvFile) {
    ASSERT_EQ(converge("-q --no-images --flip-seeds 0").exitCode, 0);
    EXPECT_TRUE(report().at("images").is_null());
    EXPECT_FALSE(fs::exists(file("out") + "/reference.png"));
    const std::string csv = file("out") + "/convergence.csv";
    const ProgramResult result = runProgram("converge --fit '" + csv + "' -o '" + file("again") + "'");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    std::ifstream stream(file("again") + "/convergence.json");
    const json fitted = json::parse(stream);
    EXPECT_EQ(fitted.at("device"), "");
    for (const char* unknown : {"scene", "images", "reference", "diagnostics"})
        EXPECT_TRUE(fitted.at(unknown).is_null()) << unknown;
    EXPECT_EQ(fitted.at("variants").at(0).at("slopeSamples"), report().at("variants").at(0).at("slopeSamples"));
    EXPECT_EQ(runProgram("converge --fit '" + file("none.csv") + "' -o '" + file("b") + "'").exitCode, 2);
    EXPECT_EQ(runProgram("converge " + scene() + " --fit '" + csv + "' -o '" + file("b") + "'").exitCode, 2);
    EXPECT_FALSE(fs::exists(file("b")));
}

TEST_F(ConvergeCommandTest, WhatCannotBeMeantIsRefused) {
    expectRefused("--variant ':--light-sampling bsdf'", {"--variant", "no name"});
    expectRefused("--variant a --variant 'a:--accel none'", {"--variant 'a'", "another variant has this name"});
    expectRefused("--variant 'a:--light-sampling foo'", {"--variant 'a'", "--light-sampling", "foo"});
    expectRefused("--variant 'a:--spp 8'", {"--variant 'a'", "--spp"});
    expectRefused("--variant 'a:--time 3'", {"--variant 'a'", "--time", "--max-time"});
    expectRefused("--variant 'a:--roulette off'", {"--variant 'a'", "--roulette off"});
    expectRefused("--variant 'a:--adaptive-batch 8'", {"--variant 'a'", "--adaptive-batch"});
    expectRefused("--reference a.exr --reference-spp 8", {"--reference"});
    expectRefused("--reference '" + file("none.exr") + "'", {"none.exr"});
    expectRefused("--seeds 1", {"--seeds", "range"});
    EXPECT_EQ(runProgram("converge -o '" + file("out") + "'").exitCode, 2);
}

TEST_F(ConvergeCommandTest, VariantsConvergeToTheSameImage) {
    for (const char* options : {"--max-depth 3", "--integrator albedo", "--light direct", "--back-faces culled",
                                "--pixel-filter triangle", "--aperture 0.1 --focus 5"}) {
        const std::string name = std::string(options).substr(0, std::string(options).find(' '));
        expectRefused("--variant 'a:" + std::string(options) + "'", {"--variant 'a'", name, "outside of --variant"});
    }
    const ProgramResult result =
        converge("-q --no-images --max-depth 3 --variant 'a:--max-depth 3 --roulette off' --variant b");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_EQ(report().at("maxDepth"), 3);
}

TEST_F(ConvergeCommandTest, ReferencesAreKeptForTheImageTheyShow) {
    const std::string brief = "--no-images --flip-seeds 0 ";
    ASSERT_TRUE(contains(converge(brief).output, "rendering two references"));
    ASSERT_EQ(references().size(), 2u);
    EXPECT_FALSE(contains(converge(brief + "--variant 'a:--light-sampling bsdf'").output, "rendering two references"));
    EXPECT_FALSE(contains(converge(brief + "--reference-spp 100").output, "rendering two references"));
    EXPECT_EQ(references().size(), 2u);
    EXPECT_TRUE(contains(converge(brief + "--reference-spp 600").output, "rendering two references"));
    EXPECT_EQ(references().size(), 2u) << "more samples replace fewer";
    EXPECT_TRUE(contains(converge(brief + "--max-depth 2").output, "rendering two references"));
    EXPECT_EQ(references().size(), 4u);
    EXPECT_TRUE(contains(converge(brief + "--back-faces culled").output, "rendering two references"));
    EXPECT_EQ(references().size(), 6u);
}

TEST_F(ConvergeCommandTest, DamagedReferencesAreReplaced) {
    const std::string brief = "--no-images --flip-seeds 0 ";
    ASSERT_EQ(converge(brief).exitCode, 0);
    const fs::path damaged = references().front();
    const Image whole = readImage(damaged);
    fs::resize_file(damaged, fs::file_size(damaged) / 2);
    const ProgramResult result = converge(brief);
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "it is rendered again")) << result.output;
    EXPECT_EQ(readImage(damaged).values, whole.values);
}

TEST_F(ConvergeCommandTest, ReferencesMayBeGiven) {
    for (const char* name : {"a.exr", "b.exr"})
        ASSERT_EQ(runProgram("render -q " + scene() + " --environment 1 --size 8x6 --spp 256 --seed " +
                             (name[0] == 'a' ? "90" : "91") + " -o '" + file(name) + "'")
                      .exitCode,
                  0);
    ASSERT_EQ(converge("-q --no-images --reference '" + file("a.exr") + "'").exitCode, 0);
    EXPECT_EQ(report().at("reference").at("method"), "variance subtracted");
    ASSERT_EQ(
        converge("-q --no-images --reference '" + file("a.exr") + "' --reference '" + file("b.exr") + "'").exitCode, 0);
    EXPECT_EQ(report().at("reference").at("method"), "two independent");
    EXPECT_EQ(report().at("reference").at("samplesPerPixel"), 512);
    EXPECT_FALSE(fs::exists(file("cache") + "/references"));
    fs::remove_all(file("out"));
    expectRefused("--size 9x6 --reference '" + file("a.exr") + "'", {"a.exr", "8 x 6", "9 x 6"});
}

/// Adaptive renders end at the same mean; those that stop by their error, each for itself, have a checkpoint there.
TEST_F(ConvergeCommandTest, RendersThatStopByThemselvesEndWithACheckpoint) {
    const ProgramResult result =
        converge("-q --no-images --max-spp 256 --reference-spp 512 --variant 'adaptive:--adaptive 0.02' "
                 "--variant 'error:--until-error 0.1'");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const json written = report();
    for (const json& variant : written.at("variants")) {
        const json& last = variant.at("checkpoints").back();
        EXPECT_EQ(last.at("calibration").at("meanLuminance").at("total"), 3) << variant.at("name");
        if (variant.at("name") != "error") continue;
        EXPECT_LT(last.at("samplesPerPixel"), 256.0);
    }
}

TEST_F(ConvergeCommandTest, TheReferenceRendererIsMeasuredToo) {
    ASSERT_EQ(converge("-q --no-images --backend reference").exitCode, 0);
    EXPECT_EQ(report().at("device"), "CPU, double precision");
    for (const ErrorSample& sample : samples()) EXPECT_TRUE(std::isnan(sample.deviceSeconds));
}

TEST_F(ConvergeCommandTest, AnInterruptedRunKeepsWholeSeeds) {
    ASSERT_EQ(converge("-q --no-images --flip-seeds 0").exitCode, 0); // the references
    const ProgramResult result =
        converge("--seeds 4096 --max-spp 256 --reference-spp 512 --flip-seeds 0", "timeout --preserve-status -s INT 5");
    EXPECT_EQ(result.exitCode, 130) << result.output;
    EXPECT_TRUE(contains(result.output, "has the seeds that were whole")) << result.output;
    const std::vector<ErrorSample> kept = samples();
    EXPECT_EQ(kept.size() % 9, 0u);
    EXPECT_GT(kept.size(), 0u);
    EXPECT_LT(kept.size(), 9u * 4096u);
    EXPECT_EQ(report().at("seeds").size(), kept.size() / 9);
}

} // namespace
} // namespace isolux::test
