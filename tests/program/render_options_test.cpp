// What the options of `isolux render` change in the image, its metadata and what is said of it.
#include "film/cryptomatte.h"
#include "film/image.h"
#include "support/cube_scene.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

namespace isolux::test {
namespace {

using nlohmann::json;

constexpr const char* kSmall = " -q --size 12x8 --spp 4 ";
constexpr const char* kLit = " --environment 1,0.5,0.25 ";

class RenderOptionsTest : public CubeSceneTest {
protected:
    [[nodiscard]] ProgramResult render(const std::string& options, const std::string& output = "a.exr") const {
        return runProgram("render " + scene() + " -o '" + file(output) + "' " + options);
    }
    /// The EXR image of a render that must go well.
    [[nodiscard]] Image image(const std::string& options) const {
        const ProgramResult result = render(options);
        EXPECT_EQ(result.exitCode, 0) << result.output;
        return readImage(file("a.exr"));
    }
    /// Exit code 2 and one line with all of these parts, and no file.
    void expectBadInput(const std::string& options, const std::vector<std::string>& parts) const {
        const ProgramResult result = render(options, "bad.exr");
        EXPECT_EQ(result.exitCode, 2) << options << ": " << result.output;
        EXPECT_EQ(occurrences(result.output, "\n"), 1u) << result.output;
        for (const std::string& part : parts) EXPECT_TRUE(contains(result.output, part)) << result.output;
        EXPECT_FALSE(std::filesystem::exists(file("bad.exr")));
    }
};

std::vector<std::string> linesOf(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// A channel's smallest and largest value.
std::pair<float, float> rangeOf(const Image& image, const std::string& channel) {
    const std::size_t index = image.channel(channel).value();
    std::pair<float, float> range{image.value(0, index), image.value(0, index)};
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        range.first = std::min(range.first, image.value(pixel, index));
        range.second = std::max(range.second, image.value(pixel, index));
    }
    return range;
}

float centre(const Image& image, const std::string& channel) {
    return image.value(image.width / 2 + image.height / 2 * image.width, image.channel(channel).value());
}

// --- Size and camera ---

TEST_F(RenderOptionsTest, SizeIsBothEdges) {
    const Image both = image("-q --spp 1 --size 40x30");
    EXPECT_EQ(both.width, 40u);
    EXPECT_EQ(both.height, 30u);
    EXPECT_EQ(render("--size 40x30 --width 40").exitCode, 2);
    EXPECT_EQ(render("--size 40x30 --height 30").exitCode, 2);
}

TEST_F(RenderOptionsTest, MalformedSizesAreRefused) {
    for (const char* size : {"40", "x30", "40x", "99999999x1", "40x30x20", "4ax30", "-4x3", "40 x 30"})
        expectBadInput("'--size=" + std::string(size) + "'", {"--size", size});
    expectBadInput("--size 0x5", {"0 x 5"});
    expectBadInput("--size 65537x1", {"65537 x 1"});
    expectBadInput("--size 65536x65536", {"65536 x 65536"});
}

TEST_F(RenderOptionsTest, CamerasAreNamedOrNumbered) {
    const std::string options = kSmall + std::string(kLit);
    const Image perspective = image(options);
    const Image orthographic = image(options + "--camera 1");
    EXPECT_FALSE(perspective.values == orthographic.values);
    for (const char* camera : {"0", "'front view'", "view"})
        EXPECT_TRUE(image(options + "--camera " + camera).values == perspective.values) << camera;
    for (const char* camera : {"'front plan'", "plan"})
        EXPECT_TRUE(image(options + "--camera " + camera).values == orthographic.values) << camera;
}

TEST_F(RenderOptionsTest, UnclearCamerasListThemAll) {
    for (const char* camera : {"front", "2", "nothing", "-1"})
        expectBadInput("--camera=" + std::string(camera), {"--camera", camera, "0 'front view'", "1 'front plan'"});
}

// --- Environment ---

TEST_F(RenderOptionsTest, EnvironmentLightsASceneWithout) {
    const Image coloured = image(kSmall + std::string(kLit));
    // Camera rays of the corner miss the cube: they carry the environment as it is, in binary fractions.
    EXPECT_EQ(coloured.value(0, coloured.channel("R").value()), 1.0f);
    EXPECT_EQ(coloured.value(0, coloured.channel("G").value()), 0.5f);
    EXPECT_EQ(coloured.value(0, coloured.channel("B").value()), 0.25f);
    EXPECT_GT(centre(coloured, "R"), 0.0f);
    const Image grey = image(std::string(kSmall) + "--environment 0.5");
    for (const char* channel : {"R", "G", "B"}) EXPECT_EQ(grey.value(0, grey.channel(channel).value()), 0.5f);
}

TEST_F(RenderOptionsTest, MalformedEnvironmentsAreRefused) {
    for (const char* radiance :
         {"1,2", "a", "-1", "1,2,3,4", "nan", "inf", "1,", ",1", "1,,1", "1e39", "1;2;3", "absent.hdr", "None"})
        expectBadInput("'--environment=" + std::string(radiance) + "'", {"--environment"});
}

/// Comparisons with bounds let NaN pass: it must be refused as what it is.
TEST_F(RenderOptionsTest, NumbersMustBeFinite) {
    for (const std::string option : {"--exposure", "--time", "--dispatch-ms"})
        for (const std::string value : {"nan", "inf"}) {
            const ProgramResult result = render(option + " " + value);
            EXPECT_EQ(result.exitCode, 2) << result.output;
            EXPECT_TRUE(contains(result.output, option + ": '" + value + "' is not a finite number")) << result.output;
        }
    for (const std::string option : {"--max-relative-bias", "--max-rel-mse", "--max-flip", "--pixels-per-degree"})
        EXPECT_EQ(runProgram("compare a.exr b.exr " + option + " nan").exitCode, 2) << option;
    EXPECT_EQ(runProgram("verify a.gltf --tolerance nan").exitCode, 2);
}

TEST_F(RenderOptionsTest, AReportThatCannotBeWrittenIsRefusedFirst) {
    expectBadInput("--json '" + file("absent/a.json") + "'", {"absent/a.json", "folder"});
}

// --- Time ---

TEST_F(RenderOptionsTest, TimeAloneDecidesHowManySamples) {
    const ProgramResult result =
        render("-q --size 32x24 --time 1 --progress json --json '" + file("a.json") + "'" + kLit);
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const auto [least, most] = rangeOf(readImage(file("a.exr")), "samples.Y");
    EXPECT_EQ(least, most) << "every pixel has as many";
    EXPECT_GE(least, 1.0f);
    std::ifstream stream(file("a.json"));
    const json report = json::parse(stream);
    EXPECT_EQ(report.at("samplesPerPixel"), most);
    EXPECT_EQ(report.at("timeLimitSeconds"), 1.0);
    // A busy machine may take longer than a second; a limit that nobody looks at takes days for 2^32 samples.
    EXPECT_LT(report.at("seconds").at("render"), 30.0);
}

TEST_F(RenderOptionsTest, SamplesEndBeforeTheTimeDoes) {
    const auto [least, most] = rangeOf(image("-q --size 32x24 --time 1000 --spp 2"), "samples.Y");
    EXPECT_EQ(least, 2.0f);
    EXPECT_EQ(most, 2.0f);
    EXPECT_EQ(render("--time 0").exitCode, 2);
    EXPECT_EQ(render("--time -1").exitCode, 2);
}

TEST_F(RenderOptionsTest, ProgressIsJsonLines) {
    const ProgramResult result = render("-q --size 32x24 --time 2 --progress json 2>&1 >/dev/null");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    std::set<std::string> stages;
    double fraction = -1.0;
    for (const std::string& line : linesOf(result.output)) {
        const json progress = json::parse(line, nullptr, false);
        ASSERT_TRUE(progress.is_object()) << line;
        EXPECT_GE(progress.at("elapsedSeconds"), 0.0);
        stages.insert(progress.at("stage"));
        if (!progress.contains("fraction")) continue;
        EXPECT_GE(progress.at("fraction"), fraction) << "it never goes back";
        fraction = progress.at("fraction");
        EXPECT_LE(fraction, 1.0);
    }
    EXPECT_TRUE(stages.count("compiling")) << result.output;
    EXPECT_TRUE(stages.count("rendering")) << result.output;
    EXPECT_EQ(render("-q --size 8x8 --spp 1 --progress none").output, "");
}

// --- Layers and metadata ---

TEST_F(RenderOptionsTest, AllLayersAreWritten) {
    const Image all = image("-q --size 33x25 --spp 4 --aov all");
    std::set<std::string> expected{"R",         "G",          "B",        "A",        "Z",
                                   "samples.Y", "variance.Y", "normal.X", "normal.Y", "normal.Z"};
    for (const char* layer : {"variance", "albedo", "CryptoObject00", "CryptoMaterial00"})
        for (const char* channel : {".R", ".G", ".B"}) expected.insert(std::string(layer) + channel);
    expected.insert({"CryptoObject00.A", "CryptoMaterial00.A"});
    EXPECT_EQ(std::set<std::string>(all.channels.begin(), all.channels.end()), expected);
    // The cube's front at z = 1 faces the camera at z = 6.
    EXPECT_FLOAT_EQ(centre(all, "Z"), 5.0f);
    EXPECT_FLOAT_EQ(centre(all, "albedo.G"), 0.5f);
    EXPECT_FLOAT_EQ(centre(all, "normal.Z"), 1.0f);
    EXPECT_EQ(centre(all, "CryptoObject00.R"), cryptomatteId("cube"));
    EXPECT_EQ(centre(all, "CryptoObject00.G"), 1.0f);
    EXPECT_EQ(centre(all, "CryptoMaterial00.R"), cryptomatteId("clay"));
}

TEST_F(RenderOptionsTest, CryptomatteManifestsNameWhatIsThere) {
    const Image all = image(std::string(kSmall) + "--aov object,material");
    std::set<std::string> names;
    for (const auto& item : all.metadata) {
        if (!item.first.starts_with("cryptomatte/") || !item.first.ends_with("/manifest")) continue;
        const json manifest = json::parse(metadataText(all.metadata, item.first).value());
        for (const auto& entry : manifest.items()) names.insert(entry.key());
    }
    EXPECT_EQ(names, (std::set<std::string>{"clay", "cube"}));
}

TEST_F(RenderOptionsTest, LayersAreChosen) {
    const auto channels = [&](const std::string& layers) {
        const Image chosen = image(std::string(kSmall) + "--aov " + layers);
        return std::set<std::string>(chosen.channels.begin(), chosen.channels.end());
    };
    EXPECT_EQ(channels("none"), (std::set<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(channels("depth,samples"), (std::set<std::string>{"R", "G", "B", "A", "Z", "samples.Y"}));
    expectBadInput("--aov nonsense", {"nonsense", "variance", "samples", "albedo", "normal", "depth", "object",
                                      "material", "all", "none"});
    expectBadInput("--aov depth,", {"albedo"});
}

TEST_F(RenderOptionsTest, MetadataHoldsTheCamera) {
    const Image seen = image(kSmall);
    ASSERT_TRUE(seen.metadata.count("worldToCamera"));
    ASSERT_TRUE(seen.metadata.count("worldToNDC"));
    // OpenEXR's camera looks along +z, and the last row translates: z = 6 of the world becomes 0.
    EXPECT_EQ(std::get<MetadataMatrix>(seen.metadata.at("worldToCamera")),
              (MetadataMatrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 6, 1}));
    // The world's origin lies in the middle of the image.
    const auto ndc = std::get<MetadataMatrix>(seen.metadata.at("worldToNDC"));
    EXPECT_FLOAT_EQ(ndc[12] / ndc[15], 0.5f);
    EXPECT_FLOAT_EQ(ndc[13] / ndc[15], 0.5f);
}

// --- Display, report ---

TEST_F(RenderOptionsTest, ToneMapsAndExposureAreOfPngAlone) {
    const std::string two = " -o '" + file("a.png") + "'" + kSmall + kLit;
    const Image plain = image(two);
    const Image plainPng = readImage(file("a.png"));
    const Image mapped = image(two + "--tonemap agx --exposure 1");
    EXPECT_TRUE(plain.values == mapped.values);
    EXPECT_FALSE(plainPng.values == readImage(file("a.png")).values);
    expectBadInput("--tonemap sepia", {"sepia", "agx"});
    EXPECT_EQ(render("--exposure bright").exitCode, 2);
}

TEST_F(RenderOptionsTest, StatisticsArePrintedEvenIfQuiet) {
    const ProgramResult result = render(std::string(kSmall) + "--stats 2>/dev/null");
    EXPECT_EQ(result.exitCode, 0);
    for (const char* line : {"scene ", "device ", "render ", "speed ", "diagnostics "})
        EXPECT_TRUE(contains("\n" + result.output, std::string("\n") + line)) << result.output;
}

// --- Samples ---

TEST_F(RenderOptionsTest, DispatchLengthChangesNoBit) {
    const std::string options =
        std::string("-q --size 64x48 --spp 40 --aov all --json '") + file("a.json") + "'" + kLit;
    const auto dispatches = [&] {
        std::ifstream stream(file("a.json"));
        return json::parse(stream).at("dispatches").get<int>();
    };
    const Image usual = image(options);
    const int few = dispatches();
    const Image cut = image(options + "--dispatch-ms 1");
    EXPECT_GE(dispatches(), few) << "more, unless the device is done in a millisecond anyway";
    EXPECT_EQ(usual.channels, cut.channels);
    // Not ==, to which the NaN of an unknown variance would differ from itself.
    EXPECT_EQ(std::memcmp(usual.values.data(), cut.values.data(), usual.values.size() * sizeof(float)), 0);
    EXPECT_EQ(render("--dispatch-ms 0").exitCode, 2);
}

/// Batches are of 16 samples from the first on, so the halves consist of the whole's own batches, joined in double:
/// what differs is the rounding of the three files to float32, by 2^-24 of each value (and of the joins, by 2^-53).
TEST_F(RenderOptionsTest, HalvesAverageToTheWhole) {
    const std::string options = std::string("-q --size 32x24") + kLit;
    const Image whole = image(options + "--spp 32");
    const Image first = image(options + "--spp 16");
    const Image second = image(options + "--spp 16 --first-sample 16");
    EXPECT_FALSE(first.values == second.values);
    for (const char* channel : {"R", "G", "B"}) {
        const std::size_t index = whole.channel(channel).value();
        for (std::size_t pixel = 0; pixel < whole.pixelCount(); ++pixel) {
            const double average = 0.5 * first.value(pixel, index) + 0.5 * second.value(pixel, index);
            const double expected = whole.value(pixel, index);
            ASSERT_NEAR(average, expected, std::ldexp(average + expected, -24) * (1.0 + 1e-6)) << pixel;
        }
    }
}

} // namespace
} // namespace isolux::test
