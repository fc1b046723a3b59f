// What is inside solids: absorption (Beer-Lambert).
#pragma once

#include "scene/scene.h"

#include <cmath>
#include <cstdint>

namespace isolux {

/// A path's place: inside the material of this index, or in none.
inline constexpr std::uint32_t kNoMedium = 0xFFFFFFFFu;

/// What is left of light after `distance` inside a material.
template <typename Real> [[nodiscard]] Vec3<Real> transmittance(const Material& material, Real distance) {
    const Vec3<Real> color = glm::max(Vec3<Real>(material.attenuationColor), Vec3<Real>(Real(1e-30)));
    const Vec3<Real> sigma = -glm::log(color) / static_cast<Real>(material.attenuationDistance);
    return glm::exp(-sigma * distance);
}

/// The same in the medium of this index, where there is one; ones over an endless distance, where light meets nothing.
template <typename Real>
[[nodiscard]] Vec3<Real> transmittanceIn(const Scene& scene, std::uint32_t medium, Real distance) {
    if (medium == kNoMedium || !std::isfinite(distance)) return Vec3<Real>(1);
    return transmittance(scene.materials[medium], distance);
}

} // namespace isolux
