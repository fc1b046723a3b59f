// Materials and directions that the tests of lobes go through.
#pragma once

#include "reference/bsdf.h"
#include "unit/reference_scenes.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace isolux::test {

/// A surface seen from one of its sides.
struct LobeCase {
    std::string name;
    MaterialPoint<double> point;
    Side side = Side::front;
};

inline MaterialPoint<double> metalPoint(double alpha, const Vec3d& color = Vec3d(1.0)) {
    MaterialPoint<double> point;
    point.base = color;
    point.metal = 1.0;
    point.alpha = alpha;
    return point;
}

/// A diffuse base under a dielectric.
inline MaterialPoint<double> coatedPoint(double alpha, double ior, const Vec3d& color = Vec3d(1.0)) {
    MaterialPoint<double> point;
    point.base = color;
    point.alpha = alpha;
    point.ior = ior;
    const double root = (ior - 1.0) / (ior + 1.0);
    point.f0 = Vec3d(root * root);
    point.f90 = 1.0;
    return point;
}

/// Partly metal, as filters between texels make it.
inline MaterialPoint<double> partlyMetalPoint(double alpha, double metal) {
    MaterialPoint<double> point = coatedPoint(alpha, 1.5);
    point.metal = metal;
    return point;
}

inline MaterialPoint<double> glassPoint(double alpha, double ior, Body body, const Vec3d& color = Vec3d(1.0)) {
    MaterialPoint<double> point = coatedPoint(alpha, ior, color);
    point.transmission = 1.0;
    point.body = body;
    return point;
}

/// A bit of everything: a metal, a dielectric with its base, and glass.
inline MaterialPoint<double> mixedPoint(double alpha, Body body) {
    MaterialPoint<double> point = coatedPoint(alpha, 1.5, {0.8, 0.5, 0.2});
    point.metal = 0.4;
    point.transmission = 0.35;
    point.body = body;
    return point;
}

inline std::vector<LobeCase> lobeCases(double alpha) {
    return {{"metal", metalPoint(alpha, {0.9, 0.6, 0.2})},
            {"coated", coatedPoint(alpha, 1.5, {0.8, 0.7, 0.1})},
            {"thin glass", glassPoint(alpha, 1.5, Body::wall, {0.9, 0.8, 0.7})},
            {"glass from outside", glassPoint(alpha, 1.5, Body::solid, {0.9, 0.8, 0.7})},
            {"glass from inside", glassPoint(alpha, 1.5, Body::solid, {0.9, 0.8, 0.7}), Side::back},
            {"dense glass from inside", glassPoint(alpha, 2.4, Body::solid), Side::back},
            {"mixture", mixedPoint(alpha, Body::solid)},
            {"mixture, thin", mixedPoint(alpha, Body::wall)},
            {"mixture from inside", mixedPoint(alpha, Body::solid), Side::back}};
}

inline Vec3d directionOfCosine(double cosine, double phi = 0.0) {
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

inline std::uint32_t wordOf(double u) { return static_cast<std::uint32_t>(u * 0x1p32); }

/// The words of a scattering block: points of a rank-1 lattice, which integrate smooth functions far better than random
/// ones. The generalised golden ratio, Roberts 2018, "The unreasonable effectiveness of quasirandom sequences".
inline PhiloxBlock latticeWords(std::uint32_t index) {
    constexpr double kGolden = 1.2207440846057596; // x^4 = x + 1
    const auto part = [&](double factor) {
        const double x = 0.5 + factor * index;
        return wordOf(x - std::floor(x));
    };
    return {part(1 / kGolden), part(1 / (kGolden * kGolden)), 0, part(1 / (kGolden * kGolden * kGolden))};
}

/// A mean with the standard error that random numbers in the place of the lattice would leave.
struct Albedo {
    Vec3d mean{0.0};
    Vec3d standardError{0.0};
};

/// The mean weight of `count` samples, with the scaling of radiance undone: the part of light that is not absorbed.
template <typename Real> Albedo albedoOf(const Bsdf<Real>& bsdf, std::uint32_t count) {
    Albedo albedo;
    Vec3d squares(0.0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto sample = bsdf.sample(latticeWords(i));
        if (!sample) continue;
        const Vec3d weight(sample->weight / (sample->transmits() ? bsdf.radianceScale() : Real(1)));
        albedo.mean += weight / double(count);
        squares += weight * weight / double(count);
    }
    const Vec3d variance = glm::max(squares - albedo.mean * albedo.mean, Vec3d(0.0));
    albedo.standardError = glm::sqrt(variance / double(count));
    return albedo;
}

} // namespace isolux::test
