// The options that choose how to render and when to stop: what is refused, what is said of them, what they write.
#include "film/image.h"
#include "support/cube_scene.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <vector>

namespace isolux::test {
namespace {

using nlohmann::json;

constexpr const char* kLit = " --environment 1,0.5,0.25 ";

class MethodOptionsTest : public CubeSceneTest {
protected:
    [[nodiscard]] ProgramResult render(const std::string& options) const {
        return runProgram("render " + scene() + " -o '" + file("a.exr") + "' --json '" + file("a.json") + "'" + kLit +
                          "--progress none " + options);
    }
    [[nodiscard]] json report() const {
        std::ifstream stream(file("a.json"));
        return json::parse(stream);
    }
    /// The report of a render that must go well.
    [[nodiscard]] json reportOf(const std::string& options) const {
        const ProgramResult result = render(options);
        EXPECT_EQ(result.exitCode, 0) << options << ": " << result.output;
        return result.exitCode == 0 ? report() : json();
    }
    /// Exit code 2, one line with all of these parts, and no file.
    void expectRefused(const std::string& options, const std::vector<std::string>& parts) const {
        const ProgramResult result = render("-q --size 8x8 " + options);
        EXPECT_EQ(result.exitCode, 2) << options << ": " << result.output;
        EXPECT_EQ(occurrences(result.output, "\n"), 1u) << result.output;
        for (const std::string& part : parts) EXPECT_TRUE(contains(result.output, part)) << result.output;
        EXPECT_FALSE(std::filesystem::exists(file("a.exr")));
    }
    /// That a render says nothing else, or warns and names all of these.
    void expectWarning(const std::string& options, const std::vector<std::string>& parts) const {
        const ProgramResult result = render("--backend reference --size 8x8 --spp 2 2>&1 >/dev/null " + options);
        EXPECT_EQ(result.exitCode, 0) << result.output;
        EXPECT_EQ(contains(result.output, "warning"), !parts.empty()) << options << ": " << result.output;
        for (const std::string& part : parts) EXPECT_TRUE(contains(result.output, part)) << result.output;
    }
};

// --- What is refused ---

TEST_F(MethodOptionsTest, UnknownChoicesListWhatThereIs) {
    expectRefused("--integrator foo", {"--integrator", "foo", "path,direct,normals,albedo,depth,ao"});
    expectRefused("--integrator 0", {"--integrator", "path,direct"});
    expectRefused("--light-sampling foo", {"--light-sampling", "hemisphere,bsdf,light,mis"});
    expectRefused("--mis-heuristic foo", {"--mis-heuristic", "power,balance"});
    expectRefused("--light-choice foo", {"--light-choice", "one,all"});
    expectRefused("--bounces foo", {"--bounces", "accumulate,last"});
    expectRefused("--light foo", {"--light", "all,direct,indirect"});
    expectRefused("--roulette foo", {"--roulette", "foo", "off, throughput or constant:P"});
    expectRefused("--pixel-sampler foo", {"--pixel-sampler", "independent,stratified,sobol,sobol-blue-noise"});
    expectRefused("--pixel-filter foo", {"--pixel-filter", "box,triangle,gaussian,blackman-harris"});
    expectRefused("--accel foo", {"--accel", "none,mean-split,sah"});
    expectRefused("--triangle-test foo", {"--triangle-test", "watertight,moller-trumbore"});
    expectRefused("--back-faces foo", {"--back-faces", "foo", "shown,culled"});
    expectRefused("--back-faces", {"--back-faces"});
}

TEST_F(MethodOptionsTest, WhatNeedsAnotherOptionSaysWhich) {
    expectRefused("--bounces last", {"--bounces last", "--max-depth"});
    expectRefused("--roulette off", {"--roulette off", "--max-depth"});
    expectRefused("--aperture 1", {"--aperture", "--focus"});
    expectRefused("--focus 1", {"--focus", "--aperture"});
    expectRefused("--ao-distance 1", {"--ao-distance", "--integrator ao"});
    expectRefused("--filter-radius 1", {"--filter-radius", "--pixel-filter"});
    expectRefused("--pixel-filter box --filter-radius 0.5", {"--filter-radius", "--pixel-filter"});
    expectRefused("--adaptive-batch 16", {"--adaptive-batch", "--adaptive"});
    expectRefused("--adaptive-min 16", {"--adaptive-min", "--adaptive"});
}

TEST_F(MethodOptionsTest, NumbersOutOfRangeAreRefused) {
    for (const char* roulette :
         {"constant", "constant:", "constant:0", "constant:0.0009", "constant:0.9991", "constant:1", "constant:nan",
          "constant:inf", "constant:0.3x", "constant:-0.3", "throughput:0.3", "off:0.3", "Constant:0.3"})
        expectRefused("--max-depth 3 --roulette " + std::string(roulette), {"--roulette", roulette, "0.001", "0.999"});
    for (const char* radius : {"0", "-1", "16.1", "nan", "inf"})
        expectRefused("--pixel-filter gaussian --filter-radius=" + std::string(radius), {"--filter-radius", radius});
    for (const char* length : {"0", "-1", "nan", "inf"}) {
        expectRefused("--aperture 1 --focus=" + std::string(length), {"--focus", length});
        expectRefused("--integrator ao --ao-distance=" + std::string(length), {"--ao-distance", length});
        expectRefused("--adaptive=" + std::string(length), {"--adaptive", length});
        expectRefused("--until-error=" + std::string(length), {"--until-error", length});
    }
    for (const char* aperture : {"-1", "nan", "inf"})
        expectRefused("--focus 1 --aperture=" + std::string(aperture), {"--aperture", aperture});
    for (const char* count : {"0", "-1", "1.5", "many"})
        expectRefused("--light-samples=" + std::string(count), {"--light-samples", count});
    expectRefused("--aperture 1e300 --focus 1e-300", {"--aperture", "--focus"});
    expectRefused("--aperture 1e-30 --focus 1e-30", {"--aperture", "single precision", "--backend reference"});
    expectRefused("--light-choice one --light-samples 4000000000", {"--light-samples", "4000000000"});
    for (const char* size : {"0", "9", "-1", "two"})
        expectRefused("--leaf-size=" + std::string(size), {"--leaf-size", size});
    expectRefused("--adaptive 0.1 --adaptive-batch 0", {"--adaptive-batch", "0"});
    expectRefused("--adaptive 0.1 --adaptive-min 1", {"--adaptive-min", "1"});
    expectRefused("--roulette-start=-1", {"--roulette-start"});
}

TEST_F(MethodOptionsTest, SomeBounceMustBeLeft) {
    expectRefused("--light indirect --max-depth 1", {"--light indirect", "--max-depth 1"});
    expectRefused("--light indirect --integrator direct", {"--light indirect", "--integrator direct"});
    expectRefused("--bounces last --max-depth 2 --light direct", {"--bounces last", "--light direct"});
    expectRefused("--bounces last --max-depth 2 --integrator direct", {"--bounces last", "--integrator direct"});
}

/// 2 log2(8) bits tell the pixels apart, and 26 are left for 16 replicates each: 2^30 samples.
TEST_F(MethodOptionsTest, BlueNoiseHasSoManySamples) {
    expectRefused("--pixel-sampler sobol-blue-noise --spp 1073741825", {"--spp", "sobol-blue-noise", "1073741824"});
    expectRefused("--pixel-sampler sobol-blue-noise --spp 1 --first-sample 1073741824", {"--spp"});
    expectRefused("--pixel-sampler sobol-blue-noise --time 1", {"--spp", "sobol-blue-noise"});
    expectRefused("--pixel-sampler sobol-blue-noise --until-error 1", {"--spp", "sobol-blue-noise"});
    const std::string last = "-q --backend reference --size 8x8 --spp 1 --first-sample 1073741823 ";
    EXPECT_EQ(reportOf(last + "--pixel-sampler sobol-blue-noise").at("methods").at("pixel-sampler"),
              "sobol-blue-noise");
}

TEST_F(MethodOptionsTest, ASampleMapMustNotReplaceTheImage) {
    expectRefused("--sample-map '" + file("a.exr") + "'", {"--sample-map"});
    expectRefused("--sample-map '" + file("./a.exr") + "'", {"--sample-map"});
    expectRefused("--sample-map '" + file("absent/a.png") + "'", {"absent/a.png"});
    expectRefused("--sample-map '" + file("a.txt") + "'", {"a.txt"});
}

/// Where something else ends paths, none is endless.
TEST_F(MethodOptionsTest, PathsThatEndNeedNoRoulette) {
    const std::string quick = "-q --backend reference --size 8x8 --spp 1 --roulette off ";
    for (const char* ends : {"--integrator direct", "--light direct", "--integrator normals"})
        EXPECT_EQ(render(quick + ends).exitCode, 0) << ends;
}

// --- What is warned of ---

TEST_F(MethodOptionsTest, MethodsWithoutEffectAreNamed) {
    expectWarning("", {});
    expectWarning("--light-sampling light --light-samples 2 --light-choice all --roulette constant:0.5", {});
    expectWarning("--integrator normals --light-sampling light --roulette-start 2",
                  {"--light-sampling", "--roulette-start"});
    expectWarning("--integrator ao --ao-distance 1", {});
    expectWarning("--integrator ao --ao-distance 1 --light-samples 2", {"--light-samples"});
    expectWarning("--light-sampling light --mis-heuristic balance", {"--mis-heuristic"});
    expectWarning("--light-sampling bsdf --light-samples 2", {"--light-samples"});
    expectWarning("--max-depth 2 --roulette off --roulette-start 1", {"--roulette-start"});
    expectWarning("--accel none --leaf-size 2", {"--leaf-size"});
    expectWarning("--adaptive 0.1", {"--adaptive", "--spp is 2"});
    expectWarning("--time 1000 --pixel-sampler stratified", {"--pixel-sampler stratified"});
    expectWarning("--time 1000 --pixel-sampler sobol", {});
}

/// Scattered rays find every light but punctual ones.
TEST_F(MethodOptionsTest, LightSamplesGoToPunctualLightsAlways) {
    json document = cubeDocument();
    addPunctualLight(document, "point");
    writeScene(document);
    expectWarning("--light-sampling bsdf --light-samples 2", {});
}

TEST_F(MethodOptionsTest, CullingNeedsSomethingSingleSided) {
    expectWarning("--back-faces culled", {});
    json document = cubeDocument();
    for (json& material : document["materials"]) material["doubleSided"] = true;
    writeScene(document);
    expectWarning("--back-faces culled", {"--back-faces culled", "double-sided"});
    expectWarning("--back-faces shown", {});
}

// --- What is said of the methods ---

TEST_F(MethodOptionsTest, HelpNamesThemInGroups) {
    const std::string render = runProgram("render --help").output;
    const std::string verify = runProgram("verify --help").output;
    for (const char* word :
         {"Light transport:", "Sampling:",        "Camera:",         "Intersection:",    "--integrator",
          "--ao-distance",    "--light-sampling", "--mis-heuristic", "--light-samples",  "--light-choice",
          "--bounces",        "--light ",         "--roulette ",     "--roulette-start", "--pixel-sampler",
          "--pixel-filter",   "--filter-radius",  "--aperture",      "--focus",          "--accel",
          "--leaf-size",      "--triangle-test",  "--count-tests",   "--back-faces"}) {
        EXPECT_TRUE(contains(render, word)) << word;
        EXPECT_TRUE(contains(verify, word)) << word;
    }
    for (const char* word : {"Stopping:", "--time", "--adaptive ", "--adaptive-batch", "--adaptive-min",
                             "--until-error", "--sample-map"}) {
        EXPECT_TRUE(contains(render, word)) << word;
        EXPECT_FALSE(contains(verify, word)) << word;
    }
}

struct MethodCase {
    std::string options;
    json methods;
};

const std::vector<MethodCase> kMethodCases{
    {"--integrator path --light-sampling mis --pixel-filter box --accel sah --roulette throughput", json::object()},
    {"--integrator direct", {{"integrator", "direct"}}},
    {"--integrator normals", {{"integrator", "normals"}}},
    {"--integrator albedo", {{"integrator", "albedo"}}},
    {"--integrator depth", {{"integrator", "depth"}}},
    {"--integrator ao --ao-distance 0.5", {{"integrator", "ao"}, {"ao-distance", "0.5"}}},
    {"--light-sampling hemisphere", {{"light-sampling", "hemisphere"}}},
    {"--light-sampling bsdf", {{"light-sampling", "bsdf"}}},
    {"--light-sampling light", {{"light-sampling", "light"}}},
    {"--mis-heuristic balance", {{"mis-heuristic", "balance"}}},
    {"--light-samples 2 --light-choice all", {{"light-samples", "2"}, {"light-choice", "all"}}},
    {"--bounces last --max-depth 1", {{"bounces", "last"}}},
    {"--light direct", {{"light", "direct"}}},
    {"--light indirect", {{"light", "indirect"}}},
    {"--roulette off --max-depth 3", {{"roulette", "off"}}},
    {"--roulette constant:0.3 --roulette-start 2", {{"roulette", "constant:0.3"}, {"roulette-start", "2"}}},
    {"--pixel-sampler stratified", {{"pixel-sampler", "stratified"}}},
    {"--pixel-sampler sobol", {{"pixel-sampler", "sobol"}}},
    {"--pixel-sampler sobol-blue-noise", {{"pixel-sampler", "sobol-blue-noise"}}},
    {"--pixel-filter triangle", {{"pixel-filter", "triangle"}}},
    {"--pixel-filter gaussian --filter-radius 1.5", {{"pixel-filter", "gaussian"}}},
    {"--pixel-filter blackman-harris --filter-radius 2", {{"pixel-filter", "blackman-harris"}, {"filter-radius", "2"}}},
    {"--aperture 0 --focus 3", json::object()},
    {"--aperture 0.25 --focus 5", {{"aperture", "0.25"}, {"focus", "5"}}},
    {"--accel none", {{"accel", "none"}}},
    {"--accel mean-split --leaf-size 2", {{"accel", "mean-split"}, {"leaf-size", "2"}}},
    {"--triangle-test moller-trumbore", {{"triangle-test", "moller-trumbore"}}},
    {"--back-faces shown", json::object()},
    {"--back-faces culled", {{"back-faces", "culled"}}}};

class MethodOptionsOfTest : public MethodOptionsTest, public ::testing::WithParamInterface<const char*> {};

/// Every option is accepted and named in the report and, so that the image can be made again, in its metadata.
TEST_P(MethodOptionsOfTest, AreAcceptedAndNamed) {
    for (const MethodCase& method : kMethodCases) {
        const json said =
            reportOf(std::string("-q --size 12x8 --spp 4 --backend ") + GetParam() + " " + method.options);
        ASSERT_TRUE(said.is_object());
        EXPECT_EQ(said.at("methods"), method.methods) << method.options;
        const auto options = metadataText(readImage(file("a.exr")).metadata, "isolux/options");
        ASSERT_TRUE(options);
        for (const auto& [option, value] : method.methods.items())
            EXPECT_TRUE(contains(*options, "--" + option + " " + value.get<std::string>())) << *options;
    }
}

TEST_P(MethodOptionsOfTest, TestsAreCountedIfAsked) {
    const std::string options = std::string("-q --size 12x8 --spp 4 --backend ") + GetParam() + " ";
    EXPECT_TRUE(reportOf(options).at("tests").is_null());
    const json counted = reportOf(options + "--count-tests").at("tests");
    EXPECT_GT(counted.at("boxesPerRay"), 0.0);
    EXPECT_GT(counted.at("primitivesPerRay"), 0.0);
    const json exhaustive = reportOf(options + "--count-tests --accel none").at("tests");
    EXPECT_EQ(exhaustive.at("boxes"), 0u);
    EXPECT_GT(exhaustive.at("primitivesPerRay"), counted.at("primitivesPerRay"));
}

// --- Stopping ---

TEST_P(MethodOptionsOfTest, UntilErrorStopsBeforeTheMaximum) {
    const std::string options = std::string("-q --size 12x8 --backend ") + GetParam() + " --until-error 0.2";
    const json open = reportOf(options).at("untilError");
    EXPECT_EQ(open.at("asked"), 0.2);
    EXPECT_EQ(open.at("reached"), true);
    EXPECT_LE(open.at("relativeRmse"), 0.2);
    EXPECT_GT(open.at("samplesPerPixel"), 1u);
    EXPECT_EQ(open.at("samplesPerPixel"), report().at("samplesPerPixel"));
    const std::string maximum = std::to_string(4 * open.at("samplesPerPixel").get<std::uint64_t>());
    EXPECT_EQ(reportOf(options + " --spp " + maximum).at("untilError"), open) << "the maximum is not met";
    EXPECT_TRUE(contains(*metadataText(readImage(file("a.exr")).metadata, "isolux/options"), "--until-error 0.2"));
}

TEST_P(MethodOptionsOfTest, AnErrorThatIsNotReachedIsToldAndNoFailure) {
    const ProgramResult result = render(std::string("--size 12x8 --spp 4 --until-error 1e-9 --backend ") + GetParam());
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "warning: --until-error 1e-09: not reached after 4 samples")) << result.output;
    EXPECT_TRUE(contains(result.output, "relative RMSE 1e-09: not reached after 4 samples a pixel")) << result.output;
    EXPECT_EQ(report().at("untilError").at("reached"), false);
}

/// The background is the environment itself, without noise: it stops at once, the cube later or not.
TEST_P(MethodOptionsOfTest, AdaptiveSamplingSaysWhatItDid) {
    const ProgramResult result =
        render(std::string("--size 24x16 --spp 128 --adaptive 0.02 --adaptive-min 16 --adaptive-batch 8 --backend ") +
               GetParam() + " --sample-map '" + file("map.png") + "'");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "tolerance 0.02, 16 to 128 samples a pixel")) << result.output;
    EXPECT_TRUE(contains(result.output, "biased")) << result.output;
    const json adaptive = report().at("adaptive");
    EXPECT_EQ(adaptive.at("tolerance"), 0.02);
    EXPECT_EQ(adaptive.at("batch"), 8u);
    EXPECT_EQ(adaptive.at("minSamples"), 16u);
    EXPECT_EQ(adaptive.at("maxSamples"), 128u);
    EXPECT_EQ(adaptive.at("samplesPerPixel").at("min"), 16u);
    EXPECT_EQ(adaptive.at("samplesPerPixel").at("max"), 128u);
    EXPECT_EQ(adaptive.at("samplesPerPixel").at("mean").get<double>() * 24 * 16, report().at("samples"));
    EXPECT_GT(adaptive.at("stoppedShare"), 0.0);
    EXPECT_LT(adaptive.at("stoppedShare"), 1.0);
    const Image map = readImage(file("map.png"));
    EXPECT_EQ(map.width, 24u);
    EXPECT_EQ(map.height, 16u);
    EXPECT_FALSE(std::filesystem::exists(file("a.partial.exr"))) << "pixels that stopped make no render partial";
}

/// An interrupted adaptive render is worth its samples on average: its least are those of pixels that were done.
TEST_P(MethodOptionsOfTest, AdaptiveRendersAreInterruptedAsOthers) {
    const std::string endless = std::string("-q --size 24x16 --spp 10000000 --adaptive 1e-6 --backend ") + GetParam();
    const auto interrupted = [&](const std::string& seconds) {
        return runProgram("render " + scene() + kLit + endless + " -o '" + file("a.exr") + "'",
                          "timeout --preserve-status --signal INT " + seconds);
    };
    EXPECT_EQ(interrupted("2").exitCode, 130);
    const Image first = readImage(file("a.exr"));
    ASSERT_TRUE(first.metadata.count("isolux/sampleMean"));
    EXPECT_LT(std::get<double>(first.metadata.at("isolux/sampleMean")), 10000000.0);
    EXPECT_EQ(interrupted("6").exitCode, 130);
    EXPECT_GT(std::get<double>(readImage(file("a.exr")).metadata.at("isolux/sampleMean")),
              std::get<double>(first.metadata.at("isolux/sampleMean")))
        << "more samples replace fewer";
    EXPECT_FALSE(std::filesystem::exists(file("a.partial.exr")));
}

TEST_P(MethodOptionsOfTest, SampleMapsAreOfTheImagesSize) {
    EXPECT_EQ(reportOf(std::string("-q --size 12x8 --spp 4 --backend ") + GetParam() + " --sample-map '" +
                       file("map.png") + "'")
                  .at("adaptive"),
              nullptr);
    EXPECT_EQ(readImage(file("map.png")).width, 12u);
    EXPECT_EQ(readImage(file("map.png")).height, 8u);
}

INSTANTIATE_TEST_SUITE_P(Backends, MethodOptionsOfTest, ::testing::Values("vulkan", "reference"),
                         [](const auto& backend) { return std::string(backend.param); });

// --- Black images of other integrators ---

TEST_F(MethodOptionsTest, BlackIsNoFaultOfImagesThatHoldNoLight) {
    const std::string unlit =
        "render " + scene() + " -o '" + file("b.png") + "' --backend reference --size 12x8 --spp 1 ";
    const ProgramResult normals = runProgram(unlit + "--integrator normals");
    EXPECT_EQ(normals.exitCode, 0);
    EXPECT_FALSE(contains(normals.output, "note")) << normals.output;
    const ProgramResult away = runProgram(unlit + "--integrator albedo --camera 1 --size 1x1 --max-depth 0");
    EXPECT_FALSE(contains(away.output, "no light")) << away.output;
}

// --- verify ---

TEST_F(MethodOptionsTest, BackendsAreVerifiedWithEachMethod) {
    const std::string verify = "verify -q " + scene() + kLit + "--size 12x8 --spp 8 --json ";
    for (const MethodCase& method : kMethodCases) {
        const ProgramResult result = runProgram(verify + method.options + " 2>/dev/null");
        EXPECT_EQ(result.exitCode, 0) << method.options << ": " << result.output;
        EXPECT_EQ(json::parse(result.output).at("methods"), method.methods);
    }
    EXPECT_EQ(runProgram("verify " + scene() + " --adaptive 0.1").exitCode, 2);
    EXPECT_EQ(runProgram("verify " + scene() + " --roulette off").exitCode, 2);
}

} // namespace
} // namespace isolux::test
