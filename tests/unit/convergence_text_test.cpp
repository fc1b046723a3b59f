// convergence.csv there and back, what is refused in it, and reports as text and as JSON.
#include "convergence_samples.h"
#include "core/error.h"
#include "report_images.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace isolux {
namespace {

using namespace convergence_test;
using test::expectMentions;
using test::kNan;

constexpr const char* kHeader =
    "variant,seed,checkpoint,samples_per_pixel,rays,device_seconds,wall_seconds,setup_seconds,mse,rel_mse,"
    "rel_mse_trimmed,mae,flip,bias,relative_rmse,estimate\n";

/// The error that a file of this text (after the header) gives.
std::string refusal(const std::string& text) {
    try {
        (void)fromCsv(text, "a.csv");
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::badInput);
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

ErrorSample distinctSample() {
    ErrorSample sample;
    sample.variant = "mis";
    sample.seed = 18446744073709551615u;
    sample.checkpoint = 3;
    sample.samplesPerPixel = 16.5;
    sample.rays = 123456789012345;
    sample.deviceSeconds = 0.1;
    sample.wallSeconds = 1.0 / 3.0;
    sample.setupSeconds = 0.25;
    sample.mse = -1.5e-7;
    sample.relMse = 2.5;
    sample.relMseTrimmed = 1.25;
    sample.mae = 0.75;
    sample.flip = 0.0625;
    sample.bias = -1e-300;
    sample.relativeRmse = -3e-4;
    sample.estimate = 1e10;
    return sample;
}

// --- CSV ---

TEST(ConvergenceCsv, IsWrittenInTheOrderOfTheHeader) {
    EXPECT_EQ(toCsv({distinctSample()}), std::string(kHeader) +
                                             "mis,18446744073709551615,3,16.5,123456789012345,0.1,0.3333333333333333,"
                                             "0.25,-1.5e-07,2.5,1.25,0.75,0.0625,-1e-300,-0.0003,10000000000\n");
}

TEST(ConvergenceCsv, ReadsBackExactly) {
    ErrorSample odd = distinctSample();
    odd.variant = "a \"b\", c\r\nd";
    odd.deviceSeconds = odd.flip = odd.estimate = odd.mse = kNan;
    odd.relMse = std::numeric_limits<double>::infinity();
    const std::string text = toCsv({distinctSample(), odd, distinctSample()});
    const std::vector<ErrorSample> read = fromCsv(text, "a.csv");
    ASSERT_EQ(read.size(), 3u);
    EXPECT_EQ(toCsv(read), text);
    EXPECT_EQ(read[1].variant, odd.variant);
    EXPECT_TRUE(std::isnan(read[1].flip));
    EXPECT_TRUE(std::isinf(read[1].relMse));
    EXPECT_EQ(read[2].wallSeconds, 1.0 / 3.0);
    EXPECT_EQ(read[0].seed, 18446744073709551615u);
}

TEST(ConvergenceCsv, TakesOtherEndsOfLinesAndUnknownFigures) {
    std::string text = std::string(kHeader) + "\n\"x\",1,0,4,,,0.5,,0.1,,,,,,0.2,"; // no end of the last line
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
    const std::vector<ErrorSample> read = fromCsv(text, "a.csv");
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0].variant, "x");
    EXPECT_EQ(read[0].rays, 0u);
    EXPECT_TRUE(std::isnan(read[0].setupSeconds));
    EXPECT_EQ(read[0].relativeRmse, 0.2);
}

TEST(ConvergenceCsv, NamesTheLineOfWhatIsWrong) {
    const std::string header = kHeader;
    const std::string good = "x,1,0,4,9,,0.5,,0.1,,,,,,0.2,\n";
    expectMentions(refusal(""), "a.csv:1: the first line must be variant,seed");
    expectMentions(refusal("variant,seed\n"), "a.csv:1: the first line must be variant,seed");
    EXPECT_EQ(refusal(header), "a.csv: has no samples");
    EXPECT_EQ(refusal(header + good + "x,1,0\n"), "a.csv:3: 3 fields where 16 are expected");
    EXPECT_EQ(refusal(header + good + "x,-1,0,4,9,,0.5,,0.1,,,,,,0.2,\n"),
              "a.csv:3: field 2: \"-1\" is not a number that fits here");
    EXPECT_EQ(refusal(header + "x,1,0,4,9,,0.5s,,0.1,,,,,,0.2,\n"),
              "a.csv:2: field 7: \"0.5s\" is not a number that fits here");
    EXPECT_EQ(refusal(header + "x,1,0,4,9,,,,0.1,,,,,,0.2,\n"),
              "a.csv:2: field 7: \"\" is not a number that fits here");
    EXPECT_EQ(refusal(header + "x,1,0,4,9,,0.5,,1e999,,,,,,0.2,\n"),
              "a.csv:2: field 9: \"1e999\" is not a number that fits here");
    EXPECT_EQ(refusal(header + "\"x\n\ny\",1,0,4,9,,0.5,,0.1,,,,,,0.2,\nz\n"),
              "a.csv:5: 1 fields where 16 are expected");
    EXPECT_EQ(refusal(header + good + "\"x,1\n\n"), "a.csv:5: a quoted field without end");
    EXPECT_EQ(refusal(header + "x\"y,1\n"), "a.csv:2: a quote in the middle of a field");
}

/// Whatever the bytes, it is samples or one error.
TEST(ConvergenceCsv, SurvivesAnyText) {
    const std::string good = toCsv({distinctSample(), distinctSample()});
    std::mt19937_64 random(2);
    const std::string bytes = ",\"\r\n0a-.";
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string text = good;
        for (int k = 0; k < 3; ++k) text[random() % text.size()] = bytes[random() % bytes.size()];
        try {
            (void)fromCsv(text.substr(0, random() % text.size()), "a.csv");
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000);
}

// --- Reports ---

ConvergenceReport exampleReport() {
    std::vector<ErrorSample> samples = exactSamples({}, 1.0, 0.0);
    Synthetic faster;
    faster.name = "mis";
    faster.secondsPerSample = 0.005;
    for (ErrorSample sample : exactSamples(faster, 1.0, 0.0)) {
        sample.estimate = 1.5 * sample.relativeRmse;
        sample.flip = 0.125;
        samples.push_back(sample);
    }
    ConvergenceReport report = summarise(samples, exactReference(), {{0.1, 0.01}, 100});
    report.variants[1].options = "--light-sampling mis";
    Calibration calibration;
    calibration.meanLuminance = {15, 16};
    calibration.pixels.assign(5, {95, 100});
    calibration.brightness = {0.1, 0.2, 0.3, 0.4, 0.5};
    calibration.estimateOverError = {0.9, 1.0, 1.1};
    report.variants[1].checkpoints.back().calibration = calibration;
    return report;
}

TEST(ConvergenceText, HasATableFitsAndTheHeadline) {
    const std::string text = toText(exampleReport());
    expectMentions(text, "variant           mis: --light-sampling mis, 16 seeds, set-up 0 s\n");
    expectMentions(text, "  samples  seconds               relative RMSE");
    expectMentions(
        text, "       16     0.08           0.25 [0.25, 0.25]  +0.00 % [+0.00 %, +0.00 %]  0.125            1.5\n");
    expectMentions(text, "slope             -1 [-1, -1] over samples, -1 [-1, -1] over time: holds\n");
    expectMentions(text, "time to 10 %      1 [1, 1] s\n");
    expectMentions(text, "time to 1 %       100 [100, 100] s, extrapolated\n");
    expectMentions(text, "calibration       95 % intervals hold the mean luminance of 15 of 16 seeds, pixels 95.0 95.0 "
                         "95.0 95.0 95.0 % (dark to bright)\n");
    expectMentions(text, "\nmis reaches 10 % relative RMSE 2 (2-2) times sooner than plain\n");
    const std::size_t table = text.find("  samples");
    const std::size_t width = text.find('\n', table) - table;
    for (std::size_t line = table, i = 0; i < 9; ++i, line += width + 1) EXPECT_EQ(text[line + width], '\n');
}

TEST(ConvergenceJson, HasTheFieldsOfTheFile) {
    const nlohmann::ordered_json json = toJson(exampleReport());
    EXPECT_EQ(json["errors"].dump(), "[0.1,0.01]");
    const auto& variant = json["variants"][1];
    EXPECT_EQ(variant["name"], "mis");
    EXPECT_EQ(variant["options"], "--light-sampling mis");
    EXPECT_EQ(variant["seeds"], 16);
    EXPECT_EQ(variant["slopeHolds"], true);
    for (const char* name : {"setupSeconds", "slopeTime", "slopeSamples", "floor", "efficiency"})
        EXPECT_TRUE(variant.contains(name)) << name;
    EXPECT_EQ(variant["timeTo"][1]["error"], 0.01);
    EXPECT_EQ(variant["timeTo"][1]["extrapolated"], true);
    EXPECT_EQ(variant["timeTo"][1]["reason"], "");
    EXPECT_EQ(variant["timeTo"][1]["seconds"].size(), 3u);
    const auto& checkpoint = variant["checkpoints"][7];
    for (const char* name :
         {"mse", "relMse", "relMseTrimmed", "mae", "flip", "bias", "biasSquared", "relativeRmse", "estimate"})
        EXPECT_EQ(checkpoint[name].size(), 3u) << name;
    EXPECT_EQ(checkpoint["samplesPerPixel"], 128.0);
    EXPECT_EQ(checkpoint["calibration"]["meanLuminance"]["inside"], 15);
    EXPECT_EQ(checkpoint["calibration"]["pixels"][4]["below"], 0.5);
    EXPECT_EQ(checkpoint["calibration"]["pixels"][4]["total"], 100);
    EXPECT_EQ(checkpoint["calibration"]["estimateOverError"].dump(), "[0.9,1.0,1.1]");
    EXPECT_TRUE(variant["checkpoints"][0]["calibration"].is_null());
    EXPECT_EQ(nlohmann::json::parse(json.dump())["variants"][0]["checkpoints"][0]["deviceSeconds"], nullptr);
    const auto& ratio = json["ratios"][0];
    EXPECT_EQ(ratio["faster"], "mis");
    EXPECT_EQ(ratio["slower"], "plain");
    EXPECT_EQ(ratio["text"], "mis reaches 10 % relative RMSE 2 (2-2) times sooner than plain");
}

TEST(ConvergenceJson, SaysHowSureTheReferenceIs) {
    ReferenceQuality reference{8192.0, 0.5, 1e-4, 3e-4, 16};
    EXPECT_EQ(toJson(reference).dump(), R"({"samplesPerPixel":8192.0,"relativeRmse":0.02,"relativeBiasError":0.0003})");
    EXPECT_EQ(toJson(ReferenceQuality{}).dump(),
              R"({"samplesPerPixel":null,"relativeRmse":null,"relativeBiasError":0.0})");
}

} // namespace
} // namespace isolux
