// Methods that must not change the expectation of an image do not: one table, one error budget.
#include "reference/reference.h"
#include "report/run_report.h"
#include "report/statistics.h"
#include "support/methods.h"
#include "support/render.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace isolux::test {
namespace {

constexpr int kSeeds = 16;
constexpr double kErrorBudget = 1e-3; // probability that any row of the table fails though all means are equal

RenderSettings tinyImage() {
    RenderSettings settings;
    settings.width = 32;
    settings.height = 24;
    settings.sampleCount = 64;
    return settings;
}

/// Renders share no random number with those of another method: each has seeds of its own.
class Seeds {
public:
    template <typename Render> std::vector<double> means(RenderSettings settings, const Render& render) {
        std::vector<double> result;
        for (int i = 0; i < kSeeds; ++i) {
            settings.seed = next_++;
            result.push_back(imageQuality(render(settings)).meanLuminance.estimate);
        }
        return result;
    }

private:
    std::uint64_t next_ = 1;
};

/// Welch's t of two sets of independent values, and its two-sided probability.
struct Welch {
    double difference = 0.0;
    double standardError = 0.0;
    double degrees = 1.0;

    Welch(const std::vector<double>& a, const std::vector<double>& b) : difference(mean(a) - mean(b)) {
        const double va = variance(a) / static_cast<double>(a.size());
        const double vb = variance(b) / static_cast<double>(b.size());
        standardError = std::sqrt(va + vb);
        degrees = (va + vb) * (va + vb) /
                  (va * va / static_cast<double>(a.size() - 1) + vb * vb / static_cast<double>(b.size() - 1));
    }
    [[nodiscard]] double probability() const {
        return 2.0 * studentUpperTail(std::abs(difference) / standardError, degrees);
    }
};

/// The baseline: the reference by default methods, four times the samples of a row.
TEST(EqualMeans, OfEveryMethodThatPromisesThem) {
    const Scene scene = mixedLightsScene();
    const Device device({});
    Seeds seeds;
    RenderSettings settings = tinyImage();
    settings.sampleCount *= 4;
    const std::vector<double> baseline =
        seeds.means(settings, [&](const RenderSettings& s) { return renderReference(scene, s, {}, {}); });
    std::vector<Method> methods{{"Default", Expectation::same, [](RenderSettings&) {}}};
    for (const Method& method : allMethods())
        if (method.expectation == Expectation::same) methods.push_back(method);
    const double level = mean(baseline);
    std::cout << "method                      relative difference   standard error   p\n";
    for (const Method& method : methods) {
        settings = tinyImage();
        method.apply(settings);
        const Welch test(
            seeds.means(settings, [&](const RenderSettings& s) { return renderOnDevice(device, scene, s); }), baseline);
        std::printf("%-27s %+.4f %%  %.4f %%  %.3g\n", method.name.c_str(), 100.0 * test.difference / level,
                    100.0 * test.standardError / level, test.probability());
        EXPECT_GT(test.probability(), kErrorBudget / static_cast<double>(methods.size())) << method.name;
        // A bias of five standard errors is seen almost surely: that must be a small one.
        EXPECT_LT(5.0 * test.standardError / level, 0.02) << method.name << ": too noisy to mean anything";
    }
}

} // namespace
} // namespace isolux::test
