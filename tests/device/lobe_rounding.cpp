#include "device/lobe_rounding.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace isolux::test {
namespace {

constexpr double kUnit = 0x1p-24; ///< relative error of a rounding to single precision

/// Everything a lobe's answer depends on.
struct Inputs {
    MaterialPoint<double> point;
    Vec3d wo;
    Vec3d wi{0.0};
    PhiloxBlock words{};
};

/// The inputs with one of them rounded up and down, in turn: what is computed from a number has at best its accuracy.
std::vector<Inputs> roundedInputs(const Inputs& inputs) {
    std::vector<Inputs> all;
    for (const double factor : {1.0 - kUnit, 1.0 + kUnit}) {
        const auto with = [&](auto change) { change(all.emplace_back(inputs)); };
        for (int axis = 0; axis < 3; ++axis) {
            with([&](Inputs& rounded) { rounded.wo[axis] *= factor; });
            with([&](Inputs& rounded) { rounded.wi[axis] *= factor; });
        }
        with([&](Inputs& rounded) { rounded.point.alpha *= factor; });
        with([&](Inputs& rounded) { rounded.point.ior *= factor; });
    }
    return all;
}

/// The same for the words, which the device takes as multiples of 2^-24.
std::vector<Inputs> roundedSampleInputs(const Inputs& inputs) {
    std::vector<Inputs> all = roundedInputs(inputs);
    for (const std::size_t word : {0u, 1u, 3u})
        for (const std::uint32_t step : {256u, ~255u}) {
            const std::uint32_t moved = inputs.words[word] + step;
            if ((moved < inputs.words[word]) != (step > 256u)) continue; // over an end of [0, 1)
            all.push_back(inputs);
            all.back().words[word] = moved;
        }
    return all;
}

/// 1 less the share that a microfacet reflects cannot be better than the rounding of 1.
double roundingOfTransmission(const DeviceLobe& lobe, const Inputs& inputs) {
    if (inputs.wi.z >= 0.0) return 0.0;
    const double outer = glm::dot(inputs.wo, lobe.microfacetOf(inputs.wo, inputs.wi));
    const double through = 1.0 - dielectricFresnel(std::max(outer, 0.0), lobe.eta());
    return through > 0.0 ? kUnit / through : 0.0;
}

} // namespace

Rounded evaluateRounded(const LobeKernel& kernel, std::size_t lobe, const Vec3f& wo, const Vec3f& wi) {
    const Side side = kernel.lobe(lobe).side;
    const Inputs inputs{kernel.point(lobe), Vec3d(wo), Vec3d(wi)};
    Rounded result;
    result.exact = Bsdf<double>(inputs.point, inputs.wo, side).evaluate(inputs.wi);
    // The base darkens by 1 less what the specular lobe reflects, and is chosen as often.
    const double ofBase = kUnit * std::max(inputs.wi.z, 0.0) / kPi;
    const double relative = kUnit + roundingOfTransmission(kernel.lobe(lobe), inputs);
    result.value = Vec3d(ofBase) + relative * result.exact.value;
    result.pdf = ofBase + relative * result.exact.pdf;
    for (const Inputs& rounded : roundedInputs(inputs)) {
        const Scattered<double> moved = Bsdf<double>(rounded.point, rounded.wo, side).evaluate(rounded.wi);
        result.value += glm::abs(moved.value - result.exact.value) / 2.0; // of each input up and down
        result.pdf += std::abs(moved.pdf - result.exact.pdf) / 2.0;
    }
    return result;
}

RoundedSample sampleRounded(const LobeKernel& kernel, std::size_t lobe, const Vec3f& wo, const PhiloxBlock& words) {
    const Side side = kernel.lobe(lobe).side;
    const Inputs inputs{kernel.point(lobe), Vec3d(wo), Vec3d(0.0), words};
    RoundedSample result;
    result.exact = Bsdf<double>(inputs.point, inputs.wo, side).sample(words);
    result.direction = kUnit;
    for (const Inputs& rounded : roundedSampleInputs(inputs)) {
        const auto moved = Bsdf<double>(rounded.point, rounded.wo, side).sample(rounded.words);
        const bool same =
            moved.has_value() == result.exact.has_value() && (!moved || moved->lobe == result.exact->lobe);
        if (!same) result.stable = false;
        if (!same || !moved) continue;
        result.direction += glm::length(moved->wi - result.exact->wi) / 2.0;
        result.weight += glm::abs(moved->weight - result.exact->weight) / 2.0;
    }
    if (result.exact) result.weight += kUnit * result.exact->weight;
    return result;
}

} // namespace isolux::test
