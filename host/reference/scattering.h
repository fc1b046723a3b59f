// Directions that a Lambertian surface scatters to: distributed like what it reflects, or uniformly.
#pragma once

#include "core/philox.h"
#include "reference/surface.h"

#include <algorithm>

namespace isolux {

template <typename Real> struct ScatteredDirection {
    Vec3<Real> wi;   ///< unit; may lie below the surface
    Real pdf = 0;    ///< in solid angle
    Real weight = 0; ///< f cos / pdf, without the base colour
};

template <typename Real>
[[nodiscard]] Vec3<Real> aboutShadingNormal(const Surface<Real>& surface, const Vec3<Real>& local) {
    return glm::normalize(frameAbout(surface.ns).toWorld(local));
}

/// By the first two words of a scattering block.
template <typename Real>
[[nodiscard]] ScatteredDirection<Real> scatterByCosine(const Surface<Real>& surface, const PhiloxBlock& words) {
    const Vec3<Real> wi =
        aboutShadingNormal(surface, sampleCosineHemisphere(unitReal<Real>(words[0]), unitReal<Real>(words[1])));
    return {wi, glm::dot(wi, surface.ns) / static_cast<Real>(kPi), 1};
}

template <typename Real>
[[nodiscard]] ScatteredDirection<Real> scatterUniformly(const Surface<Real>& surface, const PhiloxBlock& words) {
    const Vec3<Real> wi =
        aboutShadingNormal(surface, sampleUniformHemisphere(unitReal<Real>(words[0]), unitReal<Real>(words[1])));
    // A direction in the horizon may be rounded to below it, and nothing is reflected there.
    const Real cosine = std::max(glm::dot(wi, surface.ns), Real(0));
    return {wi, 1 / static_cast<Real>(2 * kPi), 2 * cosine};
}

} // namespace isolux
