// Albedos of the microfacet lobes, interpolated in the tables of scene/albedo_tables.h.
#pragma once

#include "core/math.h"
#include "reference/surface.h"
#include "scene/albedo_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace isolux {

/// Two neighbours among the nodes of an axis, and the part of the way from one to the next.
template <typename Real> struct NodePair {
    std::uint32_t low;
    Real part;

    /// At `place` in [0, 1] among `nodes` nodes.
    NodePair(Real place, std::uint32_t nodes) {
        const Real x = std::clamp(place, Real(0), Real(1)) * static_cast<Real>(nodes - 1);
        low = std::min(static_cast<std::uint32_t>(x), nodes - 2);
        part = x - static_cast<Real>(low);
    }
};

/// Bilinear in a table whose rows of `width` nodes belong to `y`.
template <typename Real>
[[nodiscard]] Real lookUp(std::span<const float> table, std::uint32_t width, const NodePair<Real>& x,
                          const NodePair<Real>& y) {
    const auto row = [&](std::uint32_t index) {
        const std::size_t place = std::size_t{index} * width + x.low;
        return glm::mix(static_cast<Real>(table[place]), static_cast<Real>(table[place + 1]), x.part);
    };
    return glm::mix(row(y.low), row(y.low + 1), y.part);
}

/// Where an angle's cosine lies among the nodes of the reflection and glass tables: by its ratio to alpha near 0.
template <typename Real> [[nodiscard]] Real anglePlace(Real cosine, Real alpha) {
    const Real m = std::sqrt(cosine), y = std::sqrt(alpha);
    return m * (1 + y) / (m + y);
}

/// Albedo of GGX that reflects everything.
template <typename Real> [[nodiscard]] Real reflectionAlbedoAt(Real cosine, Real alpha) {
    return lookUp(reflectionAlbedo(), kAlbedoAngles, NodePair<Real>(anglePlace(cosine, alpha), kAlbedoAngles),
                  NodePair<Real>(std::sqrt(alpha), kAlbedoRoughnesses));
}

/// The average of (1 - cosine at the microfacet)^5 under it.
template <typename Real> [[nodiscard]] Real fresnelAlbedoAt(Real cosine, Real alpha) {
    return lookUp(fresnelAlbedo(), kFresnelAngles, NodePair<Real>(std::sqrt(cosine), kFresnelAngles),
                  NodePair<Real>(std::sqrt(alpha), kAlbedoRoughnesses));
}

/// Albedo of rough glass of index `ior` as seen from one of its sides, reflection and transmission together.
template <typename Real> [[nodiscard]] Real glassAlbedoAt(Real cosine, Real alpha, Real ior, Side side) {
    constexpr std::size_t kIndexSize = std::size_t{kGlassAngles} * kGlassRoughnesses;
    const NodePair<Real> x(anglePlace(cosine, alpha), kGlassAngles), y(std::sqrt(alpha), kGlassRoughnesses);
    const NodePair<Real> z(std::sqrt((ior - 1) / (ior + 1)), kGlassIndices);
    const std::size_t sideStart = side == Side::front ? 0 : kIndexSize * kGlassIndices;
    const auto slice = [&](std::uint32_t index) {
        return lookUp(glassAlbedo().subspan(sideStart + index * kIndexSize, kIndexSize), kGlassAngles, x, y);
    };
    return glm::mix(slice(z.low), slice(z.low + 1), z.part);
}

} // namespace isolux
