// What a render says of itself: figures of the film, methods, stopping, and their text.
#include "report/format.h"
#include "report/run_report.h"
#include "report_images.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <random>

namespace isolux {
namespace {

using namespace test;

TEST(RunReport, QualityIsThatOfTheFilm) {
    Film film(2, 1);
    for (const double value : {1.0, 3.0}) {
        film.pixels[0].add(Vec3d(value));
        film.pixels[1].add(Vec3d(value));
    }
    const ImageQuality quality = imageQuality(film);
    EXPECT_NEAR(quality.meanLuminance.estimate, 2.0, 1e-12);
    EXPECT_NEAR(quality.meanLuminance.high - 2.0, 1.959964 * std::sqrt(0.5), 1e-6); // variance 2/2 a pixel, two pixels
    EXPECT_NEAR(quality.relativeRmse, 0.5, 1e-12);
    film.pixels[0].sampleCount = 1;
    EXPECT_TRUE(std::isnan(imageQuality(film).relativeRmse));
    EXPECT_FALSE(imageQuality(film).meanLuminance.known());
}

/// Two replicates of 1 and 2 samples a pixel with image means 1 and 2.5: the mean is (1 + 2 * 2.5) / 3 = 2, its
/// variance (1 * 1 + 2 * 0.25) / (2 - 1) / 3 = 0.5, at one degree of freedom; sample counts of the pixels cancel.
TEST(RunReport, ReplicatesTellHowSureTheMeanIs) {
    Film film(2, 1);
    film.keepReplicates();
    const auto add = [&](std::size_t pixel, std::uint32_t sample, double value) {
        film.pixels[pixel].add(Vec3d(value));
        film.replicates[pixel].add(sample, Vec3d(value));
    };
    for (const std::size_t pixel : {0u, 1u}) {
        const double offset = pixel == 0 ? -0.5 : 0.5; // it is the image's mean that counts
        add(pixel, 3, 1.0 + offset);
        add(pixel, 5, 2.0 + offset);
        add(pixel, 5 + PixelReplicates::kCount, 3.0 + offset);
    }
    const Interval interval = imageQuality(film).meanLuminance;
    EXPECT_NEAR(interval.estimate, 2.0, 1e-12);
    EXPECT_NEAR(interval.high - interval.estimate, 12.706204736174706 * std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(interval.estimate - interval.low, interval.high - interval.estimate, 1e-12);
}

/// One replicate alone says nothing, nor one that a pixel lacks.
TEST(RunReport, TooFewReplicatesHaveNoInterval) {
    Film film(2, 1);
    film.keepReplicates();
    for (const std::size_t pixel : {0u, 1u}) {
        film.pixels[pixel].add(Vec3d(1.0));
        film.replicates[pixel].add(0, Vec3d(1.0));
    }
    film.pixels[0].add(Vec3d(1.0));
    film.replicates[0].add(1, Vec3d(1.0));
    EXPECT_FALSE(imageQuality(film).meanLuminance.known());
    EXPECT_NEAR(imageQuality(film).meanLuminance.estimate, 1.0, 1e-12);
}

TEST(RunReport, ReplicateIntervalCoversTheMeanAsOftenAsItSays) {
    constexpr int kTrials = 2000;
    std::mt19937 engine(7);
    std::normal_distribution<double> noise;
    int covered = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        Film film(2, 1);
        film.keepReplicates();
        for (std::uint32_t sample = 0; sample < 24; ++sample) {
            const double shared = noise(engine); // pixels that share random numbers, as under blue noise
            for (const std::size_t pixel : {0u, 1u}) {
                film.pixels[pixel].add(Vec3d(10.0 + shared));
                film.replicates[pixel].add(sample, Vec3d(10.0 + shared));
            }
        }
        covered += imageQuality(film).meanLuminance.contains(10.0) ? 1 : 0;
    }
    expectBinomial(covered, kTrials, kConfidence);
}

TEST(RunReport, NamesTheMethods) {
    RunReport report;
    EXPECT_EQ(toText(report).find("methods"), std::string::npos);
    EXPECT_EQ(toJson(report)["methods"], nlohmann::ordered_json::object());
    report.methods = {{"light-sampling", "light"}, {"roulette", "constant:0.3"}};
    expectMentions(toText(report), "methods           light-sampling light, roulette constant:0.3\n");
    EXPECT_EQ(toJson(report)["methods"]["roulette"], "constant:0.3");
}

TEST(RunReport, SaysWhatAdaptiveSamplingDid) {
    Film film(4, 1);
    for (int i = 0; i < 4; ++i) film.pixels[i].sampleCount = i == 0 ? 64 : 128;
    RunReport report;
    describeFilm(report, film);
    report.adaptive = summariseAdaptive(film, {0.1, 32, 64}, 128);
    expectMentions(toText(report), "up to 128 samples");
    expectMentions(toText(report),
                   "tolerance 0.1, 64 to 128 samples a pixel, 112 on average, 25.0 % of the pixels below "
                   "the maximum of 128\n");
    expectMentions(toText(report), "biased");
    const nlohmann::ordered_json json = toJson(report)["adaptive"];
    EXPECT_EQ(json["samplesPerPixel"]["min"], 64u);
    EXPECT_EQ(json["samplesPerPixel"]["mean"], 112.0);
    EXPECT_EQ(json["samplesPerPixel"]["max"], 128u);
    EXPECT_EQ(json["stoppedShare"], 0.25);
    EXPECT_EQ(json["maxSamples"], 128u);
    EXPECT_TRUE(json["biased"]);
    EXPECT_TRUE(toJson(RunReport{})["adaptive"].is_null());
}

TEST(RunReport, SaysWhetherTheErrorAskedForWasReached) {
    RunReport report;
    report.samplesPerPixel = 48;
    EXPECT_TRUE(toJson(report)["untilError"].is_null());
    report.errorTarget = 0.1;
    EXPECT_FALSE(report.errorTargetReached()) << "it is unknown";
    report.quality.relativeRmse = 0.1;
    expectMentions(toText(report), "until error       relative RMSE 0.1: reached after 48 samples a pixel\n");
    EXPECT_TRUE(toJson(report)["untilError"]["reached"]);
    report.quality.relativeRmse = 0.11;
    expectMentions(toText(report), "not reached after 48");
    EXPECT_FALSE(toJson(report)["untilError"]["reached"]);
    EXPECT_EQ(toJson(report)["untilError"]["relativeRmse"], 0.11);
    EXPECT_EQ(toJson(report)["untilError"]["asked"], 0.1);
}

TEST(RunReport, SaysHowManyTestsARayTakes) {
    Film film(1, 1);
    film.rays = 4;
    RunReport report;
    describeFilm(report, film);
    EXPECT_EQ(toText(report).find("tests"), std::string::npos);
    EXPECT_TRUE(toJson(report)["tests"].is_null());
    film.boxTests = 50;
    film.primitiveTests = 10;
    describeFilm(report, film);
    expectMentions(toText(report), "tests             12.5 boxes and 2.5 primitives a ray\n");
    EXPECT_EQ(toJson(report)["tests"]["boxes"], 50u);
    EXPECT_EQ(toJson(report)["tests"]["primitivesPerRay"], 2.5);
}

TEST(RunReport, NamesMapsAndTheSkyByDefault) {
    EnvironmentSummary map{Vec3d(2.0), "sphere"};
    map.map = "sky.hdr";
    map.rotation = 90.0;
    EXPECT_EQ(toText(map), "sky.hdr, times (2, 2, 2), turned by 90 degrees");
    EXPECT_EQ(toJson(map)["map"], "sky.hdr");
    EXPECT_EQ(toJson(map)["rotationDegrees"], 90.0);
    EnvironmentSummary sky{Vec3d(1.0), "sphere"};
    EXPECT_EQ(toText(sky), "(1, 1, 1), sphere");
    EXPECT_FALSE(toJson(sky)["default"]);
    sky.origin = SkyOrigin::byDefault;
    EXPECT_EQ(toText(sky), "(1, 1, 1), sphere, the sky of scenes without a light");
    EXPECT_TRUE(toJson(sky)["default"]);
    EXPECT_TRUE(toJson(sky)["map"].is_null());
}

TEST(RunReport, ExplainsWhatTheKernelsHave) {
    RunReport report;
    report.features = {{"spheres", false, "no exact sphere"}, {"smooth-normals", true, "1 of 2 meshes has normals"}};
    report.specialization = {{3, 0}, {11, 1}};
    EXPECT_EQ(toText(report.features), "kernels           spheres         left out  no exact sphere\n"
                                       "                  smooth-normals  has       1 of 2 meshes has normals\n");
    const nlohmann::ordered_json json = toJson(report);
    EXPECT_EQ(json["features"]["spheres"]["used"], false);
    EXPECT_EQ(json["features"]["smooth-normals"]["reason"], "1 of 2 meshes has normals");
    EXPECT_EQ(json["specialization"], (nlohmann::ordered_json{{"3", 0}, {"11", 1}}));
    EXPECT_EQ(toJson(RunReport{})["features"], nlohmann::ordered_json::object());
}

TEST(RunReport, SaysWhenTheFirstPixelWasThere) {
    RunReport report;
    report.timings.open = 0.25;
    report.timings.compile = 0.5;
    expectMentions(toText(report), "start-up          0.750 s: open 0.250");
    EXPECT_EQ(toText(report).find("first pixel"), std::string::npos);
    EXPECT_TRUE(nlohmann::ordered_json::parse(jsonText(toJson(report)))["firstPixelSeconds"].is_null());
    report.timings.firstPixel = 1.25;
    expectMentions(toText(report), "compile 0.500; first pixel after 1.25\n");
    EXPECT_EQ(toJson(report)["firstPixelSeconds"], 1.25);
    EXPECT_EQ(toJson(report)["seconds"]["open"], 0.25);
}

TEST(RunReport, SaysWhatWasRendered) {
    Film film(4, 2);
    for (PixelStatistics& pixel : film.pixels) pixel.sampleCount = 8;
    film.rays = 3000000;
    film.diagnostics.nonFiniteSamples = 2;
    RunReport report;
    report.scene = "box.glb";
    report.deviceName = "a device \xFF"; // no UTF-8
    report.timings.render = 2.0;
    report.validationMessages = {"a barrier is missing"};
    describeFilm(report, film);
    EXPECT_EQ(report.samples, 64u);
    EXPECT_DOUBLE_EQ(report.raysPerSecond(), 1.5e6);
    EXPECT_DOUBLE_EQ(report.samplesPerSecond(), 32.0);
    const std::string text = toText(report);
    expectMentions(text, "4 x 2, 8 samples");
    expectMentions(text, "1.5 Mrays/s");
    expectMentions(text, "2 samples NaN or infinite");
    expectMentions(text, "a barrier is missing");
    const nlohmann::ordered_json json = nlohmann::ordered_json::parse(jsonText(toJson(report)));
    EXPECT_EQ(json["schema"], 1);
    EXPECT_TRUE(json["maxDepth"].is_null());
    EXPECT_EQ(json["seconds"]["render"], 2.0);
    EXPECT_EQ(json["diagnostics"]["nonFiniteSamples"], 2);
    EXPECT_TRUE(json["meanLuminance"].is_array());
}

} // namespace
} // namespace isolux
