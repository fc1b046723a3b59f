// Coverage: whether a surface is there for a ray. The answer depends on the ray's key and the primitive alone, so it
// does not matter in which order primitives are met.
#pragma once

#include "core/philox.h"
#include "reference/attributes.h"

#include <algorithm>
#include <cstdint>

namespace isolux {

/// A hash without bias between its bits (Wellons 2018, "lowbias32").
[[nodiscard]] constexpr std::uint32_t lowbias32(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x7FEB352Du;
    h ^= h >> 15;
    h *= 0x846CA68Bu;
    return h ^ (h >> 16);
}

/// The number in [0, 1) that decides on a primitive for the ray of `key`.
template <typename Real> [[nodiscard]] Real coverageNumber(std::uint32_t key, std::uint32_t primitive) {
    return unitReal<Real>(lowbias32(key ^ (primitive * 0x9E3779B9u)));
}

/// The probability with which a surface is there: 0 or 1 unless it blends.
template <typename Real> [[nodiscard]] Real coverageAt(const Attributes<Real>& attributes, const Place<Real>& place) {
    const Material& material = attributes.materialAt(place);
    if (material.alphaMode == AlphaMode::opaque) return 1;
    const Real alpha =
        static_cast<Real>(material.alpha) * attributes.map(place, MapSlot::baseColor).w * attributes.color(place).w;
    if (material.alphaMode == AlphaMode::blend) return alpha;
    return alpha < static_cast<Real>(material.alphaCutoff) ? Real(0) : Real(1);
}

/// Whether any surface of the scene may not be there.
[[nodiscard]] inline bool hasCoverage(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& material) { return material.alphaMode != AlphaMode::opaque; });
}

/// Which surfaces are there for one ray. Keeps a reference.
template <typename Real> class Presence {
public:
    Presence(const Attributes<Real>& attributes, std::uint32_t key) : attributes_(attributes), key_(key) {}

    [[nodiscard]] bool operator()(const Place<Real>& place) const {
        const Real coverage = coverageAt(attributes_, place);
        return coverage == 1 || coverageNumber<Real>(key_, place.primitive) < coverage;
    }

private:
    const Attributes<Real>& attributes_;
    std::uint32_t key_;
};

} // namespace isolux
