// Shading normals bent by a normal map.
#pragma once

#include "reference/attributes.h"
#include "reference/surface.h"

namespace isolux {

/// The normal of a texel about `normal`, which is unit and on the front side, as is the result; `normal` itself where
/// the tangent or the result has no length, or the result lies below the geometric surface.
template <typename Real>
[[nodiscard]] Vec3<Real> bendNormal(const Vec3<Real>& normal, const Vec3<Real>& ng, const Tangent<Real>& tangent,
                                    const Vec3<Real>& inFrame) {
    const Vec3<Real> across = tangent.direction - glm::dot(tangent.direction, normal) * normal;
    const Real length = glm::length(across);
    if (!(length > 0) || !std::isfinite(length)) return normal;
    const Vec3<Real> t = across / length;
    const Vec3<Real> b = tangent.sign * glm::cross(normal, t);
    const Vec3<Real> bent = inFrame.x * t + inFrame.y * b + inFrame.z * normal;
    const Real bentLength = glm::length(bent);
    const bool above = bentLength > 0 && glm::dot(bent, ng) > 0;
    return above ? bent / bentLength : normal;
}

/// The surface with its shading normal by the material's normal map, if it has one.
template <typename Real>
[[nodiscard]] Surface<Real> withNormalMap(Surface<Real> surface, const Attributes<Real>& attributes) {
    const Place<Real> place = surface.place();
    const Material& material = attributes.materialAt(place);
    if (!material.map(MapSlot::normal).present()) return surface;
    const Vec3<Real> stored = Real(2) * Vec3<Real>(attributes.map(place, MapSlot::normal)) - Real(1);
    const auto scale = static_cast<Real>(material.normalScale);
    const Real sign = surface.side() == Side::front ? Real(1) : Real(-1);
    const Vec3<Real> bent = bendNormal(sign * surface.ns, surface.ng, attributes.tangent(place),
                                       Vec3<Real>(scale * stored.x, scale * stored.y, stored.z));
    surface.ns = sign * bent;
    return surface;
}

} // namespace isolux
