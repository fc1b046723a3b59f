// The device against the reference on independent random numbers, and against exact answers, with intervals.
#include "load/gltf.h"
#include "reference/reference.h"
#include "report/statistics.h"
#include "support/render.h"
#include "support/scenes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

namespace isolux::test {
namespace {

struct MeanWithError {
    double mean = 0.0;
    double variance = 0.0; ///< of the mean
};

/// Mean luminance of a film; pixels are independent, so their variances add.
MeanWithError imageMean(const Film& film) {
    MeanWithError result;
    for (const PixelStatistics& pixel : film.pixels) {
        result.mean += luminance(pixel.mean);
        result.variance += pixel.luminanceVariance() / static_cast<double>(pixel.sampleCount);
    }
    const auto count = static_cast<double>(film.pixels.size());
    return {result.mean / count, result.variance / (count * count)};
}

/// Twenty pairs of renders that share no random number: their differences must scatter about zero as their own
/// variances say. The pooled test would see a relative bias of about 2.6 standard errors.
TEST(DeviceStatistics, IndependentSeedsAgreeWithTheReference) {
    const Scene scene = loadScene(projectScene("cornell_box"));
    const Device device({});
    constexpr int kPairs = 20;
    RenderSettings settings;
    settings.width = settings.height = 64;
    settings.sampleCount = 256;
    int inside = 0;
    double pooledDifference = 0.0;
    double pooledVariance = 0.0;
    double level = 0.0;
    const double z95 = normalQuantile(0.975);
    for (int pair = 0; pair < kPairs; ++pair) {
        settings.seed = static_cast<std::uint64_t>(2 * pair);
        const MeanWithError a = imageMean(renderOnDevice(device, scene, settings));
        settings.seed = static_cast<std::uint64_t>(2 * pair + 1);
        const MeanWithError b = imageMean(renderReference(scene, settings, {}, {}));
        const double difference = a.mean - b.mean;
        const double variance = a.variance + b.variance;
        if (std::abs(difference) <= z95 * std::sqrt(variance)) ++inside;
        pooledDifference += difference / kPairs;
        pooledVariance += variance / (kPairs * kPairs);
        level += b.mean / kPairs;
    }
    const double standardError = std::sqrt(pooledVariance);
    RecordProperty("inside", inside);
    RecordProperty("pooledRelativeDifference", std::to_string(pooledDifference / level));
    RecordProperty("detectableRelativeBias", std::to_string(normalQuantile(0.995) * standardError / level));
    EXPECT_GE(inside, 15);
    EXPECT_LT(std::abs(pooledDifference), normalQuantile(0.995) * standardError);
    EXPECT_LT(normalQuantile(0.995) * standardError / level, 3e-3) << "the test is too weak to mean anything";
}

nlohmann::json readExpected(const std::string& name) {
    std::ifstream stream(projectScene(name).parent_path() / "expected.json");
    return nlohmann::json::parse(stream);
}

void expectFurnace(const Film& film, const Vec3d& expected) {
    Vec3d sum(0.0);
    Vec3d variance(0.0);
    const auto count = static_cast<double>(film.pixels.size());
    for (const PixelStatistics& pixel : film.pixels) {
        sum += pixel.mean;
        variance += pixel.variance() / static_cast<double>(pixel.sampleCount);
    }
    for (int c = 0; c < 3; ++c) {
        const double mean = sum[c] / count;
        const double standardError = std::sqrt(variance[c]) / count;
        EXPECT_NEAR(mean, expected[c], 0.002 * expected[c]) << "channel " << c;
        EXPECT_NEAR(mean, expected[c], normalQuantile(1.0 - 5e-5) * standardError) << "channel " << c;
    }
}

TEST(DeviceStatistics, FurnaceOnTheDevice) {
    const Device device({});
    for (const double albedo : {0.2, 0.5, 0.8}) {
        const Vec3d a(albedo, 1.0 - albedo, 0.5 * albedo);
        const Vec3d e(1.0, 0.25, 2.0);
        RenderSettings settings;
        settings.width = settings.height = 64;
        settings.sampleCount = 128;
        expectFurnace(renderOnDevice(device, furnaceScene(a, e), settings), e / (Vec3d(1.0) - a));
        expectFurnace(renderReference(furnaceScene(a, e), settings, {}, {}), e / (Vec3d(1.0) - a));
    }
}

/// The figures that the project's own scenes promise in their expected.json.
TEST(DeviceStatistics, ProjectScenesShowTheirFigures) {
    const Device device({});
    for (const char* name : {"cornell_box", "cornell_spheres", "furnace"}) {
        const nlohmann::json expected = readExpected(name);
        const Scene scene = loadScene(projectScene(name));
        RenderSettings settings;
        settings.width = settings.height = 64;
        settings.sampleCount = 128;
        const auto vector = [&](const char* key) {
            const auto& value = expected.at(key);
            return Vec3d(value.at(0), value.at(1), value.at(2));
        };
        if (expected.contains("radiance")) {
            expectFurnace(renderOnDevice(device, scene, settings), vector("radiance"));
            continue;
        }
        // Without a bounce only lamps are seen, and each pixel that one fills shows its radiance.
        settings.maxDepth = 0;
        Vec3d brightest(0.0);
        for (const PixelStatistics& pixel : renderOnDevice(device, scene, settings).pixels)
            brightest = glm::max(brightest, pixel.mean);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(brightest[c], vector("lightRadiance")[c], 1e-5 * brightest[c]) << name;
    }
}

} // namespace
} // namespace isolux::test
