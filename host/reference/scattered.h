// What lobes say of a pair of directions, and what sampling them gives. wo and wi both point away from the surface, in
// a frame about the shading normal in which wo lies above it. `value` includes the cosine: it is f |cos(wi)|. Light
// travels from wi to wo.
#pragma once

#include "core/math.h"

#include <cstdint>
#include <optional>

namespace isolux {

/// f |cos|, and the density in solid angle with which sampling finds wi. Delta lobes are part of neither.
template <typename Real> struct Scattered {
    Vec3<Real> value{0};
    Real pdf = 0;
};

/// In the order of their words in a path's signature.
enum class Lobe : std::uint32_t { diffuse, specular, glassReflection, glassTransmission };

template <typename Real> struct LobeSample {
    Vec3<Real> wi;           ///< local
    Vec3<Real> weight;       ///< f |cos| over the density, or of a delta lobe over the probability
    std::optional<Real> pdf; ///< none of a delta lobe
    Lobe lobe = Lobe::diffuse;

    [[nodiscard]] bool transmits() const { return wi.z < 0; }
};

} // namespace isolux
