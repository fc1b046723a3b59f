// A device that is lost or out of memory, which tests/support/fault_layer plays: exit code 75, one error, and whatever
// samples were finished.
#include "film/image.h"
#include "support/program.h"
#include "support/scenes.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace isolux::test {
namespace {

constexpr int kTryAgain = 75;
constexpr std::uint32_t kSamples = 64; // four batches
// The length of a dispatch follows the device's speed, so two runs need not make equally many. A device that fails
// after as many as four batches took is lost while some are finished and others are not, unless a dispatch suddenly
// does a quarter, or sixteen times, of what it did.
constexpr std::uint32_t kNeverReached = 16 * kSamples;

class LostDevice : public ProgramTest {
protected:
    /// Runs the program on a device with these faults.
    [[nodiscard]] static ProgramResult runFaulty(const std::string& arguments, const std::string& faults) {
        return runProgram(arguments, "VK_LAYER_PATH='" + std::string(ISOLUX_BINARY_DIR) +
                                         "/tests/support/fault_layer' VK_INSTANCE_LAYERS=VK_LAYER_ISOLUX_fault " +
                                         faults);
    }

    [[nodiscard]] static std::string render(const std::string& output, std::uint64_t samples = kNeverReached) {
        return "render '" + projectScene("cornell_box").string() + "' --width 32 --spp " + std::to_string(samples) +
               " -o '" + output + "'";
    }

    /// Exit code 75 and one line of error that names the cause.
    static void expectTryAgain(const ProgramResult& result, const std::string& cause) {
        EXPECT_EQ(result.exitCode, kTryAgain) << result.output;
        EXPECT_EQ(occurrences(result.output, "isolux: error:"), 1u) << result.output;
        EXPECT_EQ(occurrences(result.output, cause), 1u) << result.output;
    }

    /// The dispatches of a render that goes well, under the layer, which must not matter.
    [[nodiscard]] std::uint64_t dispatchesOfFourBatches() const {
        const ProgramResult result = runFaulty(
            render(file("whole.exr"), kSamples) + " --json '" + file("whole.json") + "'", "ISOLUX_FAULT_AFTER=1000000");
        EXPECT_EQ(result.exitCode, 0) << result.output;
        std::ifstream stream(file("whole.json"));
        return nlohmann::json::parse(stream).at("dispatches");
    }

    /// `image` is, to the last bit, what a render of as many samples as it says leaves, and the program says so.
    void expectSamplesFinished(const std::string& image, const std::string& output) const {
        const Image kept = readImage(image);
        const auto samples = metadataUnsigned(kept.metadata, "isolux/sampleCount");
        ASSERT_TRUE(samples);
        EXPECT_GE(*samples, 1u);
        EXPECT_LT(*samples, kNeverReached);
        const std::string kind = "stopped by the error: " + std::to_string(*samples) + " samples a pixel are in ";
        EXPECT_EQ(occurrences(output, kind + image), 1u) << output;
        ASSERT_EQ(runProgram(render(file("same.exr"), *samples) + " -q").exitCode, 0);
        const Image same = readImage(file("same.exr"));
        EXPECT_EQ(kept.channels, same.channels);
        EXPECT_TRUE(kept.values == same.values);
    }
};

TEST_F(LostDevice, KeepsTheSamplesThatWereFinished) {
    const std::string after = " ISOLUX_FAULT_AFTER=" + std::to_string(dispatchesOfFourBatches());
    const auto loseIn = [&](const std::string& call) {
        const std::string image = file(call + ".exr");
        const ProgramResult result = runFaulty(render(image), "ISOLUX_FAULT_IN=" + call + after);
        expectTryAgain(result, "VK_ERROR_DEVICE_LOST");
        expectSamplesFinished(image, result.output);
    };
    loseIn("submit");
    loseIn("wait");
}

/// Who reads errors alone still learns what was saved: a name that may not be the one they gave.
TEST_F(LostDevice, QuietStillSaysWhatWasSaved) {
    const std::string after = "ISOLUX_FAULT_AFTER=" + std::to_string(dispatchesOfFourBatches());
    std::ofstream(file("a.exr")) << "not an image of ours";
    const ProgramResult result = runFaulty(render(file("a.exr")) + " -q", after);
    expectTryAgain(result, "VK_ERROR_DEVICE_LOST");
    EXPECT_EQ(occurrences(result.output, "\n"), 2u) << result.output;
    expectSamplesFinished(file("a.partial.exr"), result.output);
}

/// A scheduler that runs it again must be told so every time, also when nothing may be replaced any more.
TEST_F(LostDevice, AsksToTryAgainEveryTime) {
    const std::string image = file("kept.hdr"); // says nothing of its samples, so it is never replaced by a part
    const std::string after = "ISOLUX_FAULT_AFTER=" + std::to_string(dispatchesOfFourBatches());
    for (int run = 0; run < 3; ++run) EXPECT_EQ(runFaulty(render(image), after).exitCode, kTryAgain) << run;
}

TEST_F(LostDevice, WithoutASampleThereIsNoFile) {
    // Of the submissions, the first warms up and the second takes the first samples.
    for (const char* faults :
         {"ISOLUX_FAULT_AFTER=0", "ISOLUX_FAULT_AFTER=1", "ISOLUX_FAULT_AFTER=1 ISOLUX_FAULT_IN=wait"})
        expectTryAgain(runFaulty(render(file("a.exr")), faults), "VK_ERROR_DEVICE_LOST");
    EXPECT_EQ(fileCount(), 0u);
}

TEST_F(LostDevice, VerifyAsksToTryAgain) {
    const std::string verify = "verify '" + projectScene("cornell_box").string() + "' --width 16 --spp 4";
    expectTryAgain(runFaulty(verify, "ISOLUX_FAULT_AFTER=2"), "VK_ERROR_DEVICE_LOST");
}

/// The families that were whole and the steps of the one that was not; how many dispatches a step takes is not known.
TEST_F(LostDevice, StressKeepsTheStepsThatWereWhole) {
    const std::string stress = "stress --quick --progress none --family scale -o '" + file("out") + "'";
    std::uint64_t steps = 0;
    for (std::uint64_t after = 1; steps == 0; after *= 2) {
        const ProgramResult result = runFaulty(stress, "ISOLUX_FAULT_AFTER=" + std::to_string(after));
        expectTryAgain(result, "VK_ERROR_DEVICE_LOST");
        ASSERT_EQ(result.exitCode, kTryAgain) << "done before the second step after " << after << " submissions";
        std::ifstream stream(file("out") + "/stress.json");
        const nlohmann::json report = nlohmann::json::parse(stream);
        for (const nlohmann::json& family : report["families"])
            for (const nlohmann::json& sweep : family["sweeps"]) steps += sweep["steps"].size();
    }
}

/// Memory runs out at the first allocation, the second, and so on to the last.
TEST_F(LostDevice, OutOfMemoryLeavesNoFile) {
    constexpr int kMostAllocations = 100;
    int failed = 0;
    for (;; ++failed) {
        ASSERT_LT(failed, kMostAllocations);
        const ProgramResult result =
            runFaulty(render(file("a.exr"), 1), "ISOLUX_FAULT_MEMORY_AFTER=" + std::to_string(failed));
        if (result.exitCode == 0) break;
        expectTryAgain(result, "VK_ERROR_OUT_OF_DEVICE_MEMORY");
        EXPECT_TRUE(contains(result.output, "(a buffer of ")) << "how much was asked for: " << result.output;
        EXPECT_EQ(fileCount(), 0u);
    }
    RecordProperty("allocations", failed);
    EXPECT_GE(failed, 5) << "the layer was not asked for the buffers of scene, paths, stacks, film and parameters";
}

} // namespace
} // namespace isolux::test
