// Images and expectations shared by the tests of reports.
#pragma once

#include "film/image.h"
#include "report/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace isolux::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline Image makeImage(std::uint32_t width, std::uint32_t height, std::vector<std::string> channels,
                       float fill = 0.0f) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = std::move(channels);
    image.values.assign(image.pixelCount() * image.channels.size(), fill);
    return image;
}

inline Image rgbImage(std::uint32_t width, std::uint32_t height, std::vector<float> values) {
    Image image = makeImage(width, height, {"R", "G", "B"});
    image.values = std::move(values);
    return image;
}

inline Image uniformImage(std::uint32_t width, std::uint32_t height, float value) {
    return makeImage(width, height, {"R", "G", "B"}, value);
}

inline void expectMentions(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
}

/// The number of successes of `trials` is one that a success probability p gives 99.99 % of the time.
inline void expectBinomial(int successes, int trials, double p) {
    const double deviation = std::sqrt(trials * p * (1.0 - p));
    EXPECT_NEAR(successes, trials * p, normalQuantile(0.99995) * deviation + 0.5);
}

} // namespace isolux::test
