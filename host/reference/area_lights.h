// Primitives that emit: choosing a point on one, and the density of having done so. Densities are in solid angle and
// seen from the point where rays leave the surface, the only one that sampled and traced rays share.
#pragma once

#include "reference/alpha.h"
#include "reference/light_sample.h"
#include "reference/surface.h"

#include <cstdint>
#include <optional>

namespace isolux {

/// Radiance that a point emits to one of its sides.
template <typename Real>
[[nodiscard]] Vec3<Real> emissionAt(const Attributes<Real>& attributes, const Place<Real>& place, Side side) {
    const Material& material = attributes.materialAt(place);
    const bool emits = material.emits() && (side == Side::front || material.doubleSided);
    if (!emits) return Vec3<Real>(0);
    return Vec3<Real>(material.emission) * Vec3<Real>(attributes.map(place, MapSlot::emission));
}

/// Samples one primitive at a time; densities do not include the choice of it. Keeps references.
template <typename Real> class AreaLights {
public:
    AreaLights(const Scene& scene, const World<Real>& world) : world_(world), attributes_(scene, world) {}

    /// A point on the primitive; none if it does not emit towards `origin`. Its emission is times its coverage, for
    /// shadow rays pass through the light that they end at.
    [[nodiscard]] std::optional<LightSample<Real>> sample(const Vec3<Real>& origin, std::uint32_t primitive,
                                                          const Vec2<Real>& uv) const {
        if (world_.isTriangle(primitive)) return sampleTriangleLight(origin, primitive, sampleTriangle(uv.x, uv.y));
        if (sees(origin, world_.sphere(primitive)) == Side::front) return sampleSphereOutside(origin, primitive, uv);
        return sampleSphereInside(origin, primitive, sampleSphere(uv.x, uv.y));
    }

    /// The density with which `sample` from `origin` chooses the direction to `hit`, a point of the primitive.
    [[nodiscard]] Real pdf(const Vec3<Real>& origin, const Surface<Real>& hit) const {
        if (world_.isTriangle(hit.primitive)) return trianglePdf(hit.primitive, hit.t, glm::dot(hit.wo, hit.ng));
        const WorldSphere<Real>& sphere = world_.sphere(hit.primitive);
        if (sees(origin, sphere) == Side::front) return conePdf(coneHeightFrom(origin, sphere));
        return spherePdf(hit.primitive, hit.t, glm::dot(hit.wo, hit.ng));
    }

private:
    [[nodiscard]] Vec3<Real> coveredEmission(const Place<Real>& place, Side side) const {
        const Vec3<Real> emission = emissionAt(attributes_, place, side);
        return emission == Vec3<Real>(0) ? emission : coverageAt(attributes_, place) * emission;
    }

    /// The side of a sphere that a point sees. The same expression as the constant term of `intersectSphere`, so that
    /// both agree for a point just off the sphere.
    [[nodiscard]] static Side sees(const Vec3<Real>& point, const WorldSphere<Real>& sphere) {
        const Vec3<Real> f = point - sphere.center;
        return glm::dot(f, f) > sphere.radius * sphere.radius ? Side::front : Side::back;
    }
    [[nodiscard]] static Real coneHeightFrom(const Vec3<Real>& point, const WorldSphere<Real>& sphere) {
        const Vec3<Real> f = point - sphere.center;
        return coneHeight(sphere.radius * sphere.radius, glm::dot(f, f));
    }

    [[nodiscard]] Real trianglePdf(std::uint32_t primitive, Real distance, Real cosine) const {
        const Real area = world_.triangles[primitive].area;
        return distance * distance / (area * std::abs(cosine));
    }
    [[nodiscard]] static Real conePdf(Real height) { return 1 / (static_cast<Real>(2 * kPi) * height); }
    [[nodiscard]] Real spherePdf(std::uint32_t primitive, Real distance, Real cosine) const {
        const Real radius = world_.sphere(primitive).radius;
        const Real area = static_cast<Real>(4 * kPi) * radius * radius;
        return distance * distance / (area * std::abs(cosine));
    }

    /// A ray to a light's point, ending short of it by its error bound; the receiver is on the side `facing`.
    [[nodiscard]] static Ray<Real> rayTo(const Vec3<Real>& origin, const BoundedPoint<Real>& point,
                                         const Vec3<Real>& facing) {
        const Vec3<Real> way = offsetPoint(point.position, point.error, facing) - origin;
        const Real distance = glm::length(way);
        return {origin, way / distance, distance};
    }

    [[nodiscard]] std::optional<LightSample<Real>>
    sampleTriangleLight(const Vec3<Real>& origin, std::uint32_t primitive, const Vec3<Real>& barycentric) const {
        const WorldTriangle<Real>& triangle = world_.triangles[primitive];
        const BoundedPoint<Real> point = pointOnTriangle(triangle, barycentric);
        const Vec3<Real> way = point.position - origin;
        const Real distance = glm::length(way);
        const Vec3<Real> wi = way / distance;
        const Real cosine = -glm::dot(wi, triangle.ng);
        const Side side = cosine > 0 ? Side::front : Side::back;
        const Vec3<Real> emission = coveredEmission({primitive, barycentric}, side);
        if (!(distance > 0) || cosine == 0 || emission == Vec3<Real>(0)) return std::nullopt;
        const Vec3<Real> facing = side == Side::front ? triangle.ng : -triangle.ng;
        return LightSample<Real>{wi, trianglePdf(primitive, distance, cosine), emission, rayTo(origin, point, facing),
                                 primitive};
    }

    [[nodiscard]] std::optional<LightSample<Real>>
    sampleSphereOutside(const Vec3<Real>& origin, std::uint32_t primitive, const Vec2<Real>& uv) const {
        const WorldSphere<Real>& sphere = world_.sphere(primitive);
        const Vec3<Real> toCenter = sphere.center - origin;
        const Real distance = glm::length(toCenter);
        const Real height = coneHeightFrom(origin, sphere);
        const Vec3<Real> local = sampleCone(height, uv.x, uv.y);
        const Vec3<Real> wi = frameAbout(toCenter / distance).toWorld(local);
        // The nearer root of t^2 - 2 t d cos + (d^2 - r^2) = 0, by the product of both: no cancellation next to the
        // sphere.
        const Real sinSquared = local.x * local.x + local.y * local.y;
        const Real halfChord =
            std::sqrt(std::max(Real(0), sphere.radius * sphere.radius - distance * distance * sinSquared));
        const Real t = (distance - sphere.radius) * (distance + sphere.radius) / (distance * local.z + halfChord);
        const Vec3<Real> onSphere = t * wi - toCenter;
        const BoundedPoint<Real> point = pointOnSphere(sphere, onSphere);
        return LightSample<Real>{wi, conePdf(height), coveredEmission({primitive}, Side::front),
                                 rayTo(origin, point, glm::normalize(onSphere)), primitive};
    }

    [[nodiscard]] std::optional<LightSample<Real>> sampleSphereInside(const Vec3<Real>& origin, std::uint32_t primitive,
                                                                      const Vec3<Real>& normal) const {
        const WorldSphere<Real>& sphere = world_.sphere(primitive);
        const BoundedPoint<Real> point = pointOnSphere(sphere, normal);
        const Vec3<Real> way = point.position - origin;
        const Real distance = glm::length(way);
        const Vec3<Real> wi = way / distance;
        const Real cosine = glm::dot(wi, normal);
        const Vec3<Real> emission = coveredEmission({primitive}, Side::back);
        if (!(distance > 0) || !(cosine > 0) || emission == Vec3<Real>(0)) return std::nullopt;
        return LightSample<Real>{wi, spherePdf(primitive, distance, cosine), emission, rayTo(origin, point, -normal),
                                 primitive};
    }

    const World<Real>& world_;
    Attributes<Real> attributes_;
};

} // namespace isolux
