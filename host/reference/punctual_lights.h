// Lights without extent: the one direction to them and what arrives from there.
#pragma once

#include "reference/light_sample.h"
#include "reference/rounding.h"
#include "scene/scene.h"

#include <algorithm>
#include <optional>

namespace isolux {

/// The light as seen from `origin`; pdf 1, the choice of the light not included. None for one at that very point, or a
/// spot that leaves it dark.
template <typename Real>
[[nodiscard]] std::optional<LightSample<Real>> samplePunctualLight(const PunctualLight& light,
                                                                   const Vec3<Real>& origin) {
    LightSample<Real> sample;
    sample.pdf = 1;
    sample.measure = Measure::discrete;
    const Vec3<Real> axis = glm::normalize(Vec3<Real>(light.direction));
    const Vec3<Real> intensity(light.intensity);
    if (light.kind == PunctualKind::directional) {
        sample.wi = -axis;
        sample.emission = intensity;
        sample.shadowRay = {origin, sample.wi};
        return sample;
    }
    const Vec3<Real> way = Vec3<Real>(light.position) - origin;
    const Real distance = glm::length(way);
    if (!(distance > 0)) return std::nullopt;
    sample.wi = way / distance;
    // A surface in which the light lies does not block it: the ray ends short by the rounding of both points and of the
    // distance to such a surface, for incidences down to a few degrees.
    const Real size = maxComponent(glm::abs(Vec3<Real>(light.position))) + maxComponent(glm::abs(origin));
    sample.shadowRay = {origin, sample.wi, std::max(distance - roundingBound<Real>(64) * size, Real(0))};
    const bool spot = light.kind == PunctualKind::spot;
    const Real attenuation = spot ? spotAttenuation(light, -glm::dot(axis, sample.wi)) : Real(1);
    // Not a number where `Real` cannot tell the inner cone from the outer one.
    if (!(attenuation > 0)) return std::nullopt;
    sample.emission = attenuation * intensity / (distance * distance);
    return sample;
}

} // namespace isolux
