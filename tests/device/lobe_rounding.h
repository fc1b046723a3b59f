// What single precision may make of a lobe: the double reference, and how far it moves when its inputs are rounded.
#pragma once

#include "device/lobe_harness.h"

#include <optional>

namespace isolux::test {

/// A result of the reference and the sum of what rounding each input moves it by, absolute.
struct Rounded {
    Scattered<double> exact;
    Vec3d value{0.0};
    double pdf = 0.0;
};

/// What the reference evaluates at directions that the device has in single precision.
[[nodiscard]] Rounded evaluateRounded(const LobeKernel& kernel, std::size_t lobe, const Vec3f& wo, const Vec3f& wi);

/// A sample of the reference and the sum of what rounding each input moves it by.
struct RoundedSample {
    std::optional<LobeSample<double>> exact;
    double direction = 0.0;
    Vec3d weight{0.0};  ///< of a delta lobe: others follow from what is evaluated at the direction
    bool stable = true; ///< no rounding leads to another lobe, or to the wrong side
};

[[nodiscard]] RoundedSample sampleRounded(const LobeKernel& kernel, std::size_t lobe, const Vec3f& wo,
                                          const PhiloxBlock& words);

} // namespace isolux::test
