// The fixture of tests that hold the device against the double reference on the same random numbers.
#pragma once

#include "device/device_test.h"
#include "reference/reference.h"
#include "report/paired.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace isolux::test {

inline constexpr double kTolerance = 1e-3;
inline constexpr double kAgreement = 0.999;
inline constexpr double kMaxRelativeBias = 1e-4;

class Paired : public DeviceTest {
protected:
    PairedDifferences compare(const Scene& scene, const RenderSettings& settings) {
        RenderOptions options;
        options.signatures = PathSignatures::on;
        const Film film = render(scene, settings, options);
        const Film reference = renderReference(scene, settings, {Precision::doublePrecision, PathSignatures::on}, {});
        const PairedDifferences differences = pairedDifferences(film, reference, {kTolerance, {}});
        if (differences.differentSignatures == 0) {
            EXPECT_EQ(film.rays, reference.rays);
        }
        if (differences.unexplained == 0) return differences;
        const Film single = renderReference(scene, settings, {Precision::singlePrecision}, {});
        return pairedDifferences(film, reference, {kTolerance, std::span(&single, 1)});
    }

    void expectAgreement(const Scene& scene, const RenderSettings& settings, double agreement = kAgreement) {
        const PairedDifferences differences = compare(scene, settings);
        SCOPED_TRACE(toText(differences));
        record(differences);
        EXPECT_GT(differences.litPixels, settings.width * settings.height / 10);
        EXPECT_EQ(differences.unexplained, 0u);
        // One explained pixel is allowed in images of any size: every driver rounds its own way.
        const auto apart = static_cast<double>(differences.litPixels - differences.withinTolerance);
        EXPECT_LE(apart, std::max(1.0, (1.0 - agreement) * static_cast<double>(differences.litPixels)));
        // As `isolux verify` has it: paths that rounding turned differ at random, by more than this where they are few.
        EXPECT_LT(differences.luminanceBias.low, kMaxRelativeBias);
        EXPECT_GT(differences.luminanceBias.high, -kMaxRelativeBias);
        // But none so wide that it says nothing.
        EXPECT_LT(std::abs(differences.luminanceBias.estimate), 10.0 * kMaxRelativeBias);
    }

private:
    /// Figures of the test's last comparison, for `tools/bench/drivers --surfaces`.
    static void record(const PairedDifferences& differences) { RecordProperty("paired", toJson(differences).dump()); }
};

} // namespace isolux::test
