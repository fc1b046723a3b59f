// How sampled directions are distributed, against the integral of the density that is claimed for them.
#pragma once

#include "device/lobe_harness.h"

namespace isolux::test {

/// Standard normal deviates of what was found from what is expected.
struct DistributionDeviates {
    double shape; ///< of Pearson's statistic over all directions, delta lobes, and samples that lead nowhere
    double whole; ///< of how many samples lead somewhere, delta lobes apart: the density's integral
};

[[nodiscard]] DistributionDeviates compareDistribution(LobeKernel& kernel, std::size_t lobe, const Vec3f& wo,
                                                       std::uint64_t seed);

} // namespace isolux::test
