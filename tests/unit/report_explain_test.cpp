// Explanations of black and faulty images: one symptom, one line with a remedy.
#include "report/explain.h"
#include "report/run_report.h"
#include "report_images.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace isolux::test {
namespace {

/// A black image of a scene in which nothing is wrong to see.
ImageSymptoms blackImage() {
    ImageSymptoms symptoms;
    symptoms.meanLuminance = 0.0;
    symptoms.hitShare = 1.0;
    symptoms.sampleCount = 64;
    symptoms.pixelCount = 16;
    symptoms.surfaceCount = 12;
    symptoms.lightCount = 1;
    symptoms.cameraPlace = CameraPlace::outside;
    symptoms.sceneSide = SceneSide::inFront;
    return symptoms;
}

void expectOnly(const ImageSymptoms& symptoms, const std::string& part) {
    const std::vector<std::string> lines = explainImage(symptoms);
    ASSERT_EQ(lines.size(), 1u) << part;
    expectMentions(lines[0], part);
    EXPECT_NE(lines[0].find(';'), std::string::npos) << "no remedy: " << lines[0];
    EXPECT_EQ(lines[0].find('\n'), std::string::npos);
}

TEST(Explain, AGoodImageNeedsNoWords) {
    ImageSymptoms symptoms = blackImage();
    symptoms.meanLuminance = 0.1;
    symptoms.cameraPlace = CameraPlace::insideSolid;
    symptoms.lightCount = 0;
    EXPECT_TRUE(explainImage(symptoms).empty());
    EXPECT_TRUE(explainImage({}).empty()) << "nothing was rendered";
}

TEST(Explain, BlackImages) {
    ImageSymptoms symptoms = blackImage();
    expectOnly(symptoms, "the image is black: no light reaches what the camera sees");
    symptoms.lightCount = 0;
    expectOnly(symptoms, "the image is black: the scene has no light; add one, or --environment 1,1,1");
    symptoms = blackImage();
    symptoms.surfaceCount = 0;
    symptoms.hitShare = 0.0;
    expectOnly(symptoms, "the scene has no surface");
    symptoms = blackImage();
    symptoms.hitShare = 0.0;
    expectOnly(symptoms, "the scene lies beside the image");
    symptoms.sceneSide = SceneSide::behind;
    expectOnly(symptoms, "the camera looks away from everything");
    symptoms = blackImage();
    symptoms.cameraPlace = CameraPlace::insideSolid;
    expectOnly(symptoms, "every path ends inside a solid: the camera lies inside a closed object");
}

TEST(Explain, DepthLimitsHideLight) {
    ImageSymptoms symptoms = blackImage();
    symptoms.maxDepth = 0;
    expectOnly(symptoms, "--max-depth 0 shows emitted light alone");
    symptoms.maxDepth = 1;
    expectOnly(symptoms, "--max-depth 1 shows direct light alone");
    symptoms.maxDepth = 2;
    expectOnly(symptoms, "no light reaches what the camera sees");
}

TEST(Explain, SeveralCausesAreAllNamed) {
    ImageSymptoms symptoms = blackImage();
    symptoms.lightCount = 0;
    symptoms.sceneSide = SceneSide::behind;
    symptoms.hitShare = 0.0;
    EXPECT_EQ(explainImage(symptoms).size(), 2u);
}

TEST(Explain, FaultsAreCountedAndLocated) {
    Film film(4, 2);
    for (PixelStatistics& pixel : film.pixels) pixel.add(Vec3d(1.0));
    film.at(1, 1).add(Vec3d(kNan));
    film.at(2, 1).add(Vec3d(kInfinity));
    film.diagnostics.nonFiniteSamples = 2;
    const ImageSymptoms symptoms = symptomsOf(film);
    EXPECT_EQ(symptoms.firstNonFinite, (PixelPosition{1, 1}));
    EXPECT_TRUE(std::isnan(symptoms.meanLuminance));
    expectOnly(symptoms, "2 samples were NaN or infinite, in 2 pixels (25 %), first at pixel (1, 1)");
}

TEST(Explain, OtherFaultsHaveLinesOfTheirOwn) {
    ImageSymptoms symptoms = blackImage();
    symptoms.meanLuminance = 1.0;
    symptoms.diagnostics.negativeSamples = 3;
    expectOnly(symptoms, "3 samples were negative");
    symptoms.diagnostics = {};
    symptoms.diagnostics.stackOverflows = 4;
    expectOnly(symptoms, "4 traversal stack overflows");
    symptoms.diagnostics = {};
    symptoms.diagnostics.invalidIndices = 5;
    expectOnly(symptoms, "5 invalid indices");
}

TEST(Explain, SymptomsComeFromTheFilm) {
    Film film(2, 1);
    for (int i = 0; i < 4; ++i) {
        for (PixelStatistics& pixel : film.pixels) pixel.add(Vec3d(0.0));
    }
    film.pixels[0].hitCount = 2;
    const ImageSymptoms symptoms = symptomsOf(film);
    EXPECT_EQ(symptoms.meanLuminance, 0.0);
    EXPECT_EQ(symptoms.hitShare, 0.25);
    EXPECT_EQ(symptoms.sampleCount, 8u);
    EXPECT_EQ(symptoms.pixelCount, 2u);
    EXPECT_EQ(symptoms.nonFinitePixels, 0u);
    EXPECT_FALSE(symptoms.firstNonFinite);
}

// --- In the report of a run ---

TEST(RunReport, SaysWhatWasAskedForBesidesTheScene) {
    RunReport report;
    report.camera = "from above";
    report.environment = EnvironmentSummary{Vec3d(1.0, 0.5, 0.25), "upper half"};
    report.timeLimit = 2.5;
    report.layers = {"albedo", "normal"};
    report.explanations = {"the image is black: the scene has no light; add one"};
    const std::string text = toText(report);
    expectMentions(text, "camera            from above\n");
    expectMentions(text, "environment       (1, 0.5, 0.25), upper half\n");
    expectMentions(text, "time limit        2.5 s\n");
    expectMentions(text, "layers            albedo, normal\n");
    expectMentions(text, "note              the image is black: the scene has no light; add one\n");
    const nlohmann::ordered_json json = toJson(report);
    EXPECT_EQ(json["camera"], "from above");
    EXPECT_EQ(json["environment"]["radiance"][1], 0.5);
    EXPECT_EQ(json["environment"]["extent"], "upper half");
    EXPECT_EQ(json["timeLimitSeconds"], 2.5);
    EXPECT_EQ(json["layers"][1], "normal");
    EXPECT_EQ(json["explanations"].size(), 1u);
}

TEST(RunReport, LeavesOutWhatWasNotAskedFor) {
    const std::string text = toText(RunReport{});
    for (const char* label : {"camera", "environment", "time limit", "layers", "note"})
        EXPECT_EQ(text.find(label), std::string::npos) << label;
    const nlohmann::ordered_json json = toJson(RunReport{});
    EXPECT_TRUE(json["camera"].is_null());
    EXPECT_TRUE(json["environment"].is_null());
    EXPECT_TRUE(json["timeLimitSeconds"].is_null());
    EXPECT_TRUE(json["layers"].empty());
    EXPECT_TRUE(json["explanations"].empty());
}

} // namespace
} // namespace isolux::test
