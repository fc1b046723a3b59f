// What stress tests report: verdicts, ranges, broken promises, figures of others, text, JSON and the page.
#include "core/error.h"
#include "report/stress.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace isolux::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

StressFigures figures(const char* renderer, const Interval& bias) {
    StressFigures result;
    result.renderer = renderer;
    result.bias = bias;
    result.faults.tried = 100;
    return result;
}

/// Of the device: right, right, unknown, right, right, right, 2 % off.
StressSweep sweepOfSeven() {
    StressSweep sweep;
    sweep.name = "size";
    sweep.title = "a <lamp> of any size";
    sweep.axisTitle = "size";
    sweep.limit = "float's 24 bits";
    const std::vector<Interval> biases{{-1e-5, 0.0, 1e-5}, {-1e-4, 2e-5, 1e-4}, {-0.01, 0.0, 0.01},  {0.0, 0.0, 0.0},
                                       {0.0, 0.0, 9e-4},   {kNan, 1e-4, kNan},  {0.015, 0.02, 0.025}};
    for (std::size_t i = 0; i < biases.size(); ++i) {
        const double size = std::pow(10.0, static_cast<double>(i) - 3.0);
        sweep.steps.push_back(
            {size, "1e" + std::to_string(static_cast<int>(i) - 3), {figures(kStressDevice, biases[i])}});
    }
    return sweep;
}

StressRun runOfSeven() {
    StressRun run;
    run.version = "isolux 0";
    run.device = "a device";
    run.families = {{"lights", "Lights", {sweepOfSeven()}}};
    return run;
}

TEST(StressVerdict, TheWholeIntervalDecides) {
    EXPECT_EQ(verdictOf({-1e-4, 0.0, 1e-4}, 1e-3), StressVerdict::within);
    EXPECT_EQ(verdictOf({-1e-3, 0.0, 1e-3}, 1e-3), StressVerdict::within);
    EXPECT_EQ(verdictOf({-2e-3, 0.0, 1e-4}, 1e-3), StressVerdict::unknown);
    EXPECT_EQ(verdictOf({1.1e-3, 2e-3, 3e-3}, 1e-3), StressVerdict::beyond);
    EXPECT_EQ(verdictOf({-3e-3, -2e-3, -1.1e-3}, 1e-3), StressVerdict::beyond);
    EXPECT_EQ(verdictOf({kNan, 2e-3, kNan}, 1e-3), StressVerdict::beyond);
    EXPECT_EQ(verdictOf({kNan, kNan, kNan}, 1e-3), StressVerdict::none);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(verdictOf({infinity, infinity, infinity}, 1e-3), StressVerdict::beyond);
}

TEST(StressRange, IsTheLongestRunOfStepsThatHold) {
    const StressRange range = rangeOf(sweepOfSeven(), kStressDevice);
    EXPECT_EQ(range.first, "1e0");
    EXPECT_EQ(range.last, "1e2");
    EXPECT_EQ(range.within, 3u);
    EXPECT_EQ(range.steps, 7u);
    EXPECT_EQ(range.broken, std::vector<std::string>{"1e3"});
    EXPECT_EQ(rangeOf(sweepOfSeven(), kStressSingle).steps, 0u);
}

TEST(StressRange, FaultsAndFailuresEndIt) {
    StressSweep sweep = sweepOfSeven();
    sweep.steps[4].figures[0].faults.leaks = 1;
    EXPECT_EQ(rangeOf(sweep, kStressDevice).within, 2u);
    sweep.steps[0].figures[0].failure = "refused";
    const StressRange range = rangeOf(sweep, kStressDevice);
    EXPECT_EQ(range.within, 1u);
    EXPECT_EQ(range.broken, (std::vector<std::string>{"1e-3", "1e3"}));
}

TEST(StressRange, OfOthersEndsWhereTheyBreakDown) {
    const StressRange range = rangeOf(sweepOfSeven(), kStressDevice, StressCriterion::notBrokenDown);
    EXPECT_EQ(range.first, "1e-3");
    EXPECT_EQ(range.last, "1e2");
    EXPECT_EQ(range.within, 6u);
}

TEST(StressPromises, AreBrokenByFaultsFailuresAndBiasesOfTheDeviceAlone) {
    std::vector<StressFamily> families = runOfSeven().families;
    EXPECT_EQ(brokenPromises(families), std::vector<std::string>{"lights, size, 1e3: +2.00 % [+1.50 %, +2.50 %]"});
    StressSweep& sweep = families[0].sweeps[0];
    sweep.steps.pop_back();
    EXPECT_TRUE(brokenPromises(families).empty());
    sweep.steps[0].figures[0].faults.nonFinite = 2;
    sweep.steps[1].figures[0].failure = "no";
    sweep.steps[2].figures.push_back(figures(kStressSingle, {0.5, 0.5, 0.5}));
    const std::vector<std::string> broken = brokenPromises(families);
    ASSERT_EQ(broken.size(), 2u);
    EXPECT_EQ(broken[0], "lights, size, 1e-3: 2 NaN or infinite of 100");
    EXPECT_EQ(broken[1], "lights, size, 1e-2: no");
}

TEST(StressPromises, AreBrokenByAReferenceThatSaysNothing) {
    std::vector<StressFamily> families = runOfSeven().families;
    StressSweep& sweep = families[0].sweeps[0];
    sweep.steps.pop_back();
    StressFigures reference = figures(kStressDouble, {});
    reference.mean = 1.0;
    sweep.steps[0].figures.push_back(reference);
    EXPECT_TRUE(brokenPromises(families).empty());
    sweep.steps[0].figures[0].bias = {};
    EXPECT_EQ(brokenPromises(families),
              std::vector<std::string>{"lights, size, 1e-3: the device's image has nothing to be compared with"});
    reference.failure = "no";
    reference.faults.nonFinite = 3;
    sweep.steps[0].figures.back() = reference;
    sweep.promisedFrom = 1.0; // it is needed beyond the promised range as well
    EXPECT_EQ(brokenPromises(families).size(), 3u);
}

/// Also where device and reference agree: within chance, as many errors are asked.
TEST(StressPromises, AreBrokenByAnswersThatContradictTheClosedForm) {
    std::vector<StressFamily> families = runOfSeven().families;
    StressSweep& sweep = families[0].sweeps[0];
    sweep.steps.pop_back();
    StressFigures& device = sweep.steps[0].figures[0];
    device.error = {0.002, 0.006, 0.010};
    EXPECT_TRUE(brokenPromises(families).empty()) << "three standard errors";
    device.error = {0.004, 0.006, 0.008};
    const std::vector<std::string> broken = brokenPromises(families);
    ASSERT_EQ(broken.size(), 1u);
    EXPECT_EQ(broken[0],
              "lights, size, 1e-3: device is +0.600 % [+0.400 %, +0.800 %] from what is known in closed form");
    sweep.promisedFrom = 1.0;
    EXPECT_TRUE(brokenPromises(families).empty());
}

TEST(StressSummary, CountsPromisedStepsAndThoseThatCannotBeTold) {
    std::vector<StressFamily> families = runOfSeven().families;
    StressSweep& sweep = families[0].sweeps[0];
    sweep.promisedTo = 100.0;
    sweep.steps[0].figures[0].bias = {-0.002, 0.0, 0.002};
    StressSummary summary = summarize(families);
    EXPECT_EQ(summary.steps, 7u);
    EXPECT_EQ(summary.promised, 6u);
    EXPECT_EQ(summary.broken, 0u);
    EXPECT_GE(summary.unknown, 1u);
    EXPECT_TRUE(toText(summary).starts_with("7 steps, 6 of them promised: none has a fault")) << toText(summary);
    sweep.promisedTo = 1000.0;
    EXPECT_EQ(summarize(families).broken, 1u);
    EXPECT_TRUE(toText(summarize(families)).starts_with("7 steps, 7 of them promised: promises are broken at 1"));
}

TEST(StressPromises, EndWhereTheSweepSaysSo) {
    std::vector<StressFamily> families = runOfSeven().families;
    families[0].sweeps[0].promisedTo = 100.0;
    EXPECT_TRUE(brokenPromises(families).empty());
    families[0].sweeps[0].steps[6].figures[0].faults.leaks = 1;
    EXPECT_TRUE(brokenPromises(families).empty());
    families[0].sweeps[0].steps[6].figures[0].faults.nonFinite = 1;
    EXPECT_EQ(brokenPromises(families).size(), 1u);
}

TEST(StressFigures, WithoutABiasTheErrorIsTheDeviation) {
    StressFigures double_ = figures(kStressDouble, {});
    double_.error = {0.1, 0.2, 0.3};
    EXPECT_EQ(double_.deviation().estimate, 0.2);
    double_.bias = {0.0, 0.0, 0.0};
    EXPECT_EQ(double_.deviation().estimate, 0.0);
}

TEST(StressReport, OfAnotherRendererIsShownBesideOurs) {
    StressRun run = runOfSeven();
    StressRun other = runOfSeven();
    other.families[0].sweeps[0].steps.resize(2);
    for (StressStep& step : other.families[0].sweeps[0].steps) step.figures = {figures("another", {0.2, 0.3, 0.4})};
    other.families.push_back({"unknown", "", {}});
    addFigures(run, nlohmann::ordered_json::parse(toJson(other).dump()), "other.json");
    const StressSweep& sweep = run.families[0].sweeps[0];
    ASSERT_NE(sweep.steps[1].of("another"), nullptr);
    EXPECT_EQ(sweep.steps[1].of("another")->bias.estimate, 0.3);
    EXPECT_EQ(sweep.steps[2].of("another"), nullptr);
    EXPECT_EQ(rangeOf(sweep, "another").broken, std::vector<std::string>{"1e-3"});
    EXPECT_THROW(addFigures(run, nlohmann::ordered_json::parse(R"({"families": [{}]})"), "other.json"), Error);
    EXPECT_THROW(addFigures(run, nlohmann::ordered_json::parse("[]"), "other.json"), Error);
}

TEST(StressReport, TextNamesRangeLimitAndFaults) {
    StressRun run = runOfSeven();
    run.families[0].sweeps[0].steps[1].figures[0].faults.selfHits = 3;
    const std::string text = toText(run.families[0]);
    EXPECT_NE(text.find("device            from 1e0 to 1e2 (3 of 7 steps), beyond 1 % at 1e3\n"), std::string::npos)
        << text;
    EXPECT_NE(text.find("device: 3 self-hits of 100"), std::string::npos) << text;
    EXPECT_NE(text.find("limit: float's 24 bits"), std::string::npos) << text;
}

TEST(StressReport, JsonHasEveryFigure) {
    const nlohmann::ordered_json json = nlohmann::ordered_json::parse(toJson(runOfSeven()).dump());
    EXPECT_EQ(json["schema"], 1);
    const auto& sweep = json["families"][0]["sweeps"][0];
    EXPECT_EQ(sweep["range"]["device"]["broken"][0], "1e3");
    EXPECT_EQ(sweep["steps"].size(), 7u);
    EXPECT_EQ(sweep["steps"][6]["figures"][0]["bias"][1], 0.02);
    EXPECT_TRUE(sweep["steps"][5]["figures"][0]["bias"][0].is_null());
    EXPECT_EQ(json["broken"].size(), 1u);
}

TEST(StressReport, PageIsSelfContainedAndEscaped) {
    const std::string page = toHtml(runOfSeven());
    EXPECT_NE(page.find("a &lt;lamp&gt; of any size"), std::string::npos);
    EXPECT_EQ(page.find("<lamp>"), std::string::npos);
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos);
    EXPECT_EQ(page.find("nan"), std::string::npos);
    const auto count = [&](const std::string& what) {
        std::size_t found = 0;
        for (std::size_t at = page.find(what); at != std::string::npos; at = page.find(what, at + 1)) ++found;
        return found;
    };
    EXPECT_EQ(count("<circle"), 7u);
    EXPECT_EQ(count("<section"), count("</section>"));
    EXPECT_EQ(count("<table"), count("</table>"));
}

TEST(StressReport, SweepsWithoutDeviationsOrWithOneStepHaveNoChart) {
    StressRun run = runOfSeven();
    run.families[0].sweeps[0].steps.resize(1);
    EXPECT_EQ(toHtml(run).find("<svg"), std::string::npos);
    run = runOfSeven();
    for (StressStep& step : run.families[0].sweeps[0].steps) step.figures[0].bias = {};
    EXPECT_EQ(toHtml(run).find("<svg"), std::string::npos);
}

} // namespace
} // namespace isolux::test
