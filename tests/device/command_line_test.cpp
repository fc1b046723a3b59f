// The program as users run it: exit codes, files, messages, interrupts.
#include "film/image.h"
#include "support/program.h"
#include "support/scenes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace isolux::test {
namespace {

class CommandLine : public ProgramTest {
protected:
    [[nodiscard]] static std::string scene(const std::string& name = "cornell_box") {
        return "'" + projectScene(name).string() + "'";
    }
};

TEST_F(CommandLine, RendersImagesWithMetadataAndReport) {
    const ProgramResult result =
        runProgram("render " + scene() + " -o " + file("a.exr") + " -o " + file("a.png") + " --json " + file("a.json") +
                   " --width 32 --spp 8 --seed 5 --first-sample 3 --max-depth 4 --validation");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const Image image = readImage(file("a.exr"));
    EXPECT_EQ(image.width, 32u);
    EXPECT_EQ(image.height, 32u) << "from the camera's aspect ratio";
    for (const char* channel :
         {"R", "G", "B", "A", "variance.R", "variance.G", "variance.B", "variance.Y", "samples.Y"})
        EXPECT_TRUE(image.channel(channel)) << channel;
    EXPECT_EQ(metadataUnsigned(image.metadata, "isolux/seed"), 5u);
    EXPECT_EQ(metadataUnsigned(image.metadata, "isolux/sampleFirst"), 3u);
    EXPECT_EQ(metadataUnsigned(image.metadata, "isolux/sampleCount"), 8u);
    EXPECT_EQ(readImage(file("a.png")).width, 32u);
    std::ifstream stream(file("a.json"));
    const nlohmann::json report = nlohmann::json::parse(stream);
    EXPECT_EQ(report.at("schema"), 1);
    EXPECT_EQ(fileCount(), 3u) << "no temporary files are left";
}

TEST_F(CommandLine, QuietPrintsNothing) {
    const ProgramResult result = runProgram("render " + scene() + " -q --width 8 --spp 1 -o " + file("q.png"));
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.output, "");
}

TEST_F(CommandLine, BackendsAgreeAndComparisonsHaveLimits) {
    const std::string options = " -q --width 32 --spp 16 ";
    ASSERT_EQ(runProgram("render " + scene() + options + "-o " + file("device.exr")).exitCode, 0);
    ASSERT_EQ(runProgram("render " + scene() + options + "--backend reference -o " + file("double.exr")).exitCode, 0);
    ASSERT_EQ(
        runProgram("render " + scene() + options + "--backend reference --precision float -o " + file("float.exr"))
            .exitCode,
        0);
    ASSERT_EQ(runProgram("render " + scene() + options + "--max-depth 1 -o " + file("direct.exr")).exitCode, 0);
    const std::string limits = " --max-relative-bias 1e-4 --max-rel-mse 1e-4";
    EXPECT_EQ(runProgram("compare " + file("device.exr") + " " + file("double.exr") + limits).exitCode, 0);
    EXPECT_EQ(runProgram("compare " + file("float.exr") + " " + file("double.exr") + limits).exitCode, 0);
    const ProgramResult biased =
        runProgram("compare --json " + file("direct.exr") + " " + file("double.exr") + " --max-relative-bias 0.01");
    EXPECT_EQ(biased.exitCode, 1);
    EXPECT_EQ(nlohmann::json::parse(biased.output).at("schema"), 1);
}

TEST_F(CommandLine, ComparisonsCheckBlocksAndDrawHeatmaps) {
    const std::string options = " -q --width 32 --spp 64 ";
    ASSERT_EQ(runProgram("render " + scene() + options + "-o " + file("a.exr") + " -o " + file("a.png")).exitCode, 0);
    ASSERT_EQ(
        runProgram("render " + scene() + options + "--seed 1 -o " + file("b.exr") + " -o " + file("b.png")).exitCode,
        0);
    ASSERT_EQ(runProgram("render " + scene() + options + "--seed 2 --max-depth 1 -o " + file("direct.exr")).exitCode,
              0);
    const std::string pair = file("a.exr") + " " + file("b.exr");
    const ProgramResult agreeing = runProgram("compare --check-blocks " + pair + " --heatmap " + file("flip.png"));
    EXPECT_EQ(agreeing.exitCode, 0) << agreeing.output;
    EXPECT_EQ(readImage(file("flip.png")).width, 32u);
    const ProgramResult biased = runProgram("compare --check-blocks " + file("direct.exr") + " " + file("b.exr") +
                                            " --heatmap-of blocks --heatmap " + file("z.exr"));
    EXPECT_EQ(biased.exitCode, 1) << biased.output;
    EXPECT_TRUE(readImage(file("z.exr")).channel("error.Y"));
    const auto range = [&](const std::string& arguments) {
        return nlohmann::json::parse(runProgram("compare --json " + arguments).output).at("flip").at("range");
    };
    const std::string encoded = file("a.png") + " " + file("b.png");
    EXPECT_EQ(range(pair), "high");
    EXPECT_EQ(range(encoded), "low");
    EXPECT_EQ(range(encoded + " --flip hdr"), "high");
    EXPECT_EQ(runProgram("compare " + encoded + " --max-flip 0").exitCode, 1);
    EXPECT_EQ(runProgram("compare " + encoded + " --max-flip 1").exitCode, 0);
}

TEST_F(CommandLine, ComparisonsRefuseWhatCannotBe) {
    ASSERT_EQ(runProgram("render " + scene() + " -q --width 8 --spp 2 -o " + file("a.png")).exitCode, 0);
    const std::string pair = "compare " + file("a.png") + " " + file("a.png");
    EXPECT_EQ(runProgram(pair + " --check-blocks").exitCode, 2) << "no variance";
    EXPECT_EQ(runProgram(pair + " --heatmap " + file("missing/x.png")).exitCode, 2);
    EXPECT_EQ(runProgram(pair + " --heatmap " + file("a.png")).exitCode, 2) << "it would replace an input";
    EXPECT_EQ(runProgram(pair + " --heatmap-of blocks --heatmap " + file("x.png")).exitCode, 2) << "no variance";
    EXPECT_EQ(runProgram(pair + " --flip none --heatmap " + file("x.png")).exitCode, 2);
    EXPECT_EQ(runProgram(pair + " --flip none --max-flip 0.1").exitCode, 2);
    EXPECT_EQ(runProgram(pair + " --flip maybe").exitCode, 2);
    EXPECT_EQ(fileCount(), 1u);
    EXPECT_EQ(runProgram(pair + " --flip none").exitCode, 0);
}

TEST_F(CommandLine, VerifyAgrees) {
    const ProgramResult result = runProgram("verify -q " + scene("cornell_spheres") + " --width 48 --spp 8");
    EXPECT_EQ(result.exitCode, 0) << result.output;
    const ProgramResult json = runProgram("verify -q --json " + scene() + " --width 16 --spp 4");
    EXPECT_EQ(json.exitCode, 0);
    EXPECT_TRUE(nlohmann::json::parse(json.output).at("passed"));
}

TEST_F(CommandLine, DevicesAreListed) {
    const ProgramResult text = runProgram("devices");
    EXPECT_EQ(text.exitCode, 0) << text.output;
    const ProgramResult json = runProgram("devices --json");
    const nlohmann::json devices = nlohmann::json::parse(json.output).at("devices");
    ASSERT_FALSE(devices.empty());
    for (const auto& device : devices) {
        EXPECT_TRUE(contains(text.output, device.at("name"))) << text.output;
        EXPECT_NE(device.at("driverVersion"), "") << "every driver has one, if only as a number";
    }
    EXPECT_EQ(runProgram("devices", "VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent ").exitCode, 1);
}

TEST_F(CommandLine, BadUsageAndInputExitWithTwo) {
    const std::string output = " -o " + file("x.png");
    EXPECT_EQ(runProgram("").exitCode, 2);
    EXPECT_EQ(runProgram("frobnicate").exitCode, 2);
    EXPECT_EQ(runProgram("render " + scene()).exitCode, 2) << "no output";
    EXPECT_EQ(runProgram("render " + scene() + " --spp many" + output).exitCode, 2);
    EXPECT_EQ(runProgram("render " + scene() + " --spp 0" + output).exitCode, 2);
    EXPECT_EQ(runProgram("render " + scene() + " --width 0" + output).exitCode, 2);
    EXPECT_EQ(runProgram("render " + scene() + " --first-sample 4294967295 --spp 2" + output).exitCode, 2);
    EXPECT_EQ(runProgram("render " + scene() + " -o " + file("x.tiff")).exitCode, 2);
    EXPECT_EQ(runProgram("render " + scene() + " -o " + file("missing/x.png")).exitCode, 2);
    EXPECT_EQ(runProgram("render " + scene() + " --device nonsense" + output).exitCode, 2);
    EXPECT_EQ(runProgram("render " + file("missing.glb") + output).exitCode, 2);
    EXPECT_EQ(runProgram("compare " + file("missing.exr") + " " + file("missing.exr")).exitCode, 2);
    EXPECT_EQ(fileCount(), 0u);
    const ProgramResult missing = runProgram("render " + file("missing.glb") + output);
    EXPECT_NE(missing.output.find("missing.glb"), std::string::npos);
    EXPECT_EQ(std::count(missing.output.begin(), missing.output.end(), '\n'), 1) << missing.output;
}

TEST_F(CommandLine, HelpNamesEveryOption) {
    EXPECT_EQ(runProgram("--help").exitCode, 0);
    EXPECT_EQ(runProgram("--version").exitCode, 0);
    const ProgramResult help = runProgram("render --help");
    EXPECT_EQ(help.exitCode, 0);
    for (const char* option : {"--output", "--spp", "--first-sample", "--width", "--height", "--seed", "--max-depth",
                               "--backend", "--precision", "--device", "--quiet", "--json", "Examples"})
        EXPECT_NE(help.output.find(option), std::string::npos) << option;
    const ProgramResult compareHelp = runProgram("compare --help");
    EXPECT_EQ(compareHelp.exitCode, 0);
    for (const char* option : {"--json", "--max-relative-bias", "--max-rel-mse", "--max-flip", "--check-blocks",
                               "--flip", "--pixels-per-degree", "--heatmap", "--heatmap-of", "Examples"})
        EXPECT_NE(compareHelp.output.find(option), std::string::npos) << option;
}

TEST_F(CommandLine, EveryHelpHasExamples) {
    for (const char* command : {"", "render", "compare", "verify", "scene", "devices"}) {
        const ProgramResult help = runProgram(std::string(command) + " --help");
        EXPECT_EQ(help.exitCode, 0) << command;
        EXPECT_TRUE(contains(help.output, "Examples:")) << help.output;
        EXPECT_TRUE(contains(help.output, std::string("  isolux ") + command)) << help.output;
    }
}

TEST_F(CommandLine, WithoutADriverTheReferenceStillRenders) {
    const std::string noDriver = "VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent ";
    const ProgramResult result =
        runProgram("render " + scene() + " -q --width 8 --spp 1 -o " + file("x.png"), noDriver);
    EXPECT_EQ(result.exitCode, 1) << result.output;
    EXPECT_NE(result.output.find("driver"), std::string::npos) << "the message names the remedy: " << result.output;
    EXPECT_EQ(
        runProgram("render " + scene() + " -q --backend reference --width 8 --spp 1 -o " + file("x.png"), noDriver)
            .exitCode,
        0);
}

/// Ctrl-C after a while: what is done is written and says how much it is; a file with more samples is kept.
TEST_F(CommandLine, InterruptsKeepWhatIsDone) {
    // Small, so that the slowest driver has finished a batch in time; so many samples that the fastest has not all.
    constexpr std::uint64_t kEndless = 10'000'000;
    const std::string endless = "render " + scene() + " --width 32 --spp " + std::to_string(kEndless) + " -o ";
    const std::string interrupt = "timeout --preserve-status --signal INT 3 ";
    const ProgramResult first = runProgram(endless + file("a.exr"), interrupt);
    EXPECT_EQ(first.exitCode, 130) << first.output;
    Image image = readImage(file("a.exr"));
    const auto samples = metadataUnsigned(image.metadata, "isolux/sampleCount");
    ASSERT_TRUE(samples);
    EXPECT_GT(*samples, 0u);
    EXPECT_LT(*samples, kEndless);
    // One tile, so that its pixels have the same number of samples.
    EXPECT_TRUE(contains(first.output, "interrupted: " + std::to_string(*samples) + " sample")) << first.output;
    EXPECT_TRUE(contains(first.output, "in " + file("a.exr"))) << first.output;
    // An image of more samples is worth more than what the next interruption leaves.
    image.metadata["isolux/sampleCount"] = unsignedMetadata(kEndless);
    writeImage(file("b.exr"), image);
    EXPECT_EQ(runProgram(endless + file("b.exr"), interrupt).exitCode, 130);
    EXPECT_EQ(metadataUnsigned(readImage(file("b.exr")).metadata, "isolux/sampleCount"), kEndless);
    EXPECT_LT(*metadataUnsigned(readImage(file("b.partial.exr")).metadata, "isolux/sampleCount"), kEndless);
}

} // namespace
} // namespace isolux::test
