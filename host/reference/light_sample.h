// What sampling a light tells the path.
#pragma once

#include "reference/ray_caster.h"

#include <cstdint>

namespace isolux {

/// What the density of a light sample counts. Scattering finds a light's direction with a density in solid angle too,
/// and the two are weighed; a single direction (`discrete`) it never finds, so light sampling counts in full.
enum class Measure { solidAngle, discrete };

template <typename Real> struct LightSample {
    Vec3<Real> wi;       ///< unit, towards the light
    Real pdf = 0;        ///< in `measure`
    Vec3<Real> emission; ///< towards the receiver: radiance, or if discrete the irradiance of what faces the light
    Ray<Real> shadowRay; ///< ends at the light
    std::uint32_t primitive = kNoPrimitive; ///< that emits, if one does
    Measure measure = Measure::solidAngle;
};

} // namespace isolux
