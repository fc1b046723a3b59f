// Lobes and whole materials by the shaders that ship: sampled with the density they claim, no energy lost or gained,
// the same as the double reference.
#include "device/device_test.h"
#include "device/lobe_distribution.h"
#include "report/statistics.h"

#include <cmath>
#include <string>
#include <vector>

namespace isolux::test {
namespace {

const std::vector<double> kAlphas = {1e-3, 1e-2, 0.1, 0.5, 1.0};
const std::vector<double> kCosines = {1.0, 0.7, 0.1, 1e-3};

using LobeTable = std::vector<DeviceLobe> (*)(double alpha);

std::vector<DeviceLobe> lobesOf(LobeTable table, const std::vector<double>& alphas) {
    std::vector<DeviceLobe> lobes;
    for (const double alpha : alphas)
        for (const DeviceLobe& lobe : table(alpha)) lobes.push_back(lobe);
    return lobes;
}

/// A lobe and a direction it is seen from.
struct View {
    std::size_t lobe;
    double cosine;
};

/// All pairs; on drivers that repeat what another has done a tenth of them.
std::vector<View> viewsOf(std::size_t lobes, const std::vector<double>& cosines) {
    std::vector<View> views;
    const auto step = static_cast<std::size_t>(std::lround(1.0 / workShare()));
    for (std::size_t i = 0; i < lobes * cosines.size(); i += step)
        views.push_back({i / cosines.size(), cosines[i % cosines.size()]});
    return views;
}

std::string nameOf(const DeviceLobe& lobe, double cosine) {
    return lobe.name + ", ior " + std::to_string(lobe.material.ior) + ", alpha " + std::to_string(lobe.alpha()) +
           ", cosine " + std::to_string(cosine);
}

/// Standard normal deviates that none of `comparisons` exceeds by chance but once in a thousand runs (Sidak 1967).
double limitOf(std::size_t comparisons) {
    return normalQuantile(std::pow(1.0 - 1e-3, 1.0 / static_cast<double>(comparisons)));
}

class Lobes : public DeviceTest {};

TEST_F(Lobes, AreSampledWithTheirDensity) {
    std::vector<double> alphas = kAlphas;
    alphas.push_back(0.0);
    const std::vector<DeviceLobe> lobes = lobesOf(deviceLobes, alphas);
    LobeKernel kernel(device_, lobes);
    const std::vector<View> views = viewsOf(lobes.size(), kCosines);
    const double limit = limitOf(3 * views.size()); // the second comparison has two sides
    for (std::size_t i = 0; i < views.size(); ++i) {
        const View& view = views[i];
        const DistributionDeviates found = compareDistribution(kernel, view.lobe, outgoingOfCosine(view.cosine), i);
        EXPECT_LT(found.shape, limit) << nameOf(lobes[view.lobe], view.cosine);
        EXPECT_LT(std::abs(found.whole), limit) << nameOf(lobes[view.lobe], view.cosine);
    }
}

} // namespace
} // namespace isolux::test
