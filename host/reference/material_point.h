// A material at a point: every map and vertex colour multiplied in, and what the lobes need made from them.
#pragma once

#include "reference/attributes.h"

#include <algorithm>
#include <cstdint>

namespace isolux {

/// What transmission leads into: nothing but the other side, or the inside of a closed surface.
enum class Body { wall, solid };

template <typename Real> struct MaterialPoint {
    std::uint32_t material = 0;
    Vec3<Real> base{1};
    Real metal = 0;        ///< of the opaque part
    Real transmission = 0; ///< the share of the glass part
    Real alpha = 1;        ///< of GGX
    Vec3<Real> f0{0};      ///< reflectance at normal incidence of what lies over the diffuse base, which is no metal
    Real f90 = 0;          ///< and at grazing
    Real ior = 1;
    Body body = Body::wall;

    [[nodiscard]] bool isLambertian() const { return transmission == 0 && metal == 0 && f90 == 0; }
    [[nodiscard]] bool isSolid() const { return body == Body::solid; }
};

template <typename Real> [[nodiscard]] Vec3<Real> baseAt(const Attributes<Real>& attributes, const Place<Real>& place) {
    const Vec3<Real> own(attributes.materialAt(place).baseColor);
    return own * Vec3<Real>(attributes.map(place, MapSlot::baseColor)) * Vec3<Real>(attributes.color(place));
}

/// F0 and F90 of the dielectric (KHR_materials_specular; Schlick 1994), once the index is known.
template <typename Real>
void setReflectance(MaterialPoint<Real>& point, const Attributes<Real>& attributes, const Place<Real>& place) {
    const Material& material = attributes.materialAt(place);
    const Real specular = static_cast<Real>(material.specular) * attributes.map(place, MapSlot::specular).w;
    const auto color = Vec3<Real>(material.specularColor) * Vec3<Real>(attributes.map(place, MapSlot::specularColor));
    const Real root = (point.ior - 1) / (point.ior + 1);
    point.f0 = specular * glm::min(root * root * color, Vec3<Real>(1));
    point.f90 = specular;
}

/// The material at a point of a primitive.
template <typename Real>
[[nodiscard]] MaterialPoint<Real> materialPointAt(const Attributes<Real>& attributes, std::uint32_t index,
                                                  const Place<Real>& place) {
    const Material& material = attributes.materialAt(place);
    const Vec4<Real> metallicRoughness = attributes.map(place, MapSlot::metallicRoughness);
    const Real metallic = static_cast<Real>(material.metallic) * metallicRoughness.z;
    const Real roughness = static_cast<Real>(material.roughness) * metallicRoughness.y;
    const Real transmits = static_cast<Real>(material.transmission) * attributes.map(place, MapSlot::transmission).x;
    const Real thickness = static_cast<Real>(material.thickness) * attributes.map(place, MapSlot::thickness).y;
    MaterialPoint<Real> point;
    point.material = index;
    point.base = baseAt(attributes, place);
    point.transmission = (1 - metallic) * transmits;
    // Rounding may leave a little more than 1.
    if (point.transmission < 1) point.metal = std::min(metallic / (1 - point.transmission), Real(1));
    point.alpha = roughness * roughness;
    point.ior = static_cast<Real>(material.ior);
    point.body = point.transmission > 0 && thickness > 0 ? Body::solid : Body::wall;
    setReflectance(point, attributes, place);
    return point;
}

} // namespace isolux
