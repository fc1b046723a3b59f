// The surface at a hit: the point with its rounding error, and the normals of the written conventions.
#pragma once

#include "reference/ray_caster.h"

#include <cstdint>

namespace isolux {

enum class Side { front, back };

template <typename Real> struct Surface {
    std::uint32_t primitive = kNoPrimitive;
    std::uint32_t material = 0;
    Vec3<Real> wo;       ///< back along the ray
    Vec3<Real> ng;       ///< unit geometric normal on the front side
    Vec3<Real> facing;   ///< ng or -ng: on the side of wo
    Vec3<Real> ns;       ///< unit shading normal on the side of wo
    Vec3<Real> position; ///< the hit point, as rounded
    Vec3<Real> origin;   ///< where rays leave from: off the surface, on the side of wo
    Vec3<Real> behind;   ///< the same on the other side: where transmission lets rays go, and SideRule::shading others
    Real t = 0;          ///< distance along the ray that found it
    Vec3<Real> barycentric{0}; ///< of a triangle

    [[nodiscard]] Place<Real> place() const { return {primitive, barycentric}; }

    [[nodiscard]] Vec3<Real> originTowards(const Vec3<Real>& wi) const {
        return glm::dot(wi, facing) >= 0 ? origin : behind;
    }
    /// Where light of a primitive is sampled from. A surface sees itself from inside alone, through itself: only a
    /// sphere that transmits does.
    [[nodiscard]] const Vec3<Real>& originFor(std::uint32_t light) const {
        return light == primitive && side() == Side::front ? behind : origin;
    }
    [[nodiscard]] Side side() const { return facing == ng ? Side::front : Side::back; }
};

/// A point on a primitive with the error bound that `offsetPoint` needs.
template <typename Real> struct BoundedPoint {
    Vec3<Real> position;
    Vec3<Real> error; ///< per axis
};

/// From the first vertex along two edges, so that coordinates far from the origin are rounded once, and it does not
/// matter that barycentric coordinates sum to 1 only up to rounding. The error covers the point's own distance from the
/// plane (gamma(3) of the way from the vertex, one rounding of the sum) and that with which `planeDistance` measures it
/// again from there, gamma(8) of the way to some vertex; the method is that of Pharr, Jakob and Humphreys 2023, 6.8.5.
template <typename Real>
[[nodiscard]] BoundedPoint<Real> pointOnTriangle(const WorldTriangle<Real>& triangle, const Vec3<Real>& barycentric) {
    const auto& p = triangle.positions;
    const Vec3<Real> along1 = barycentric[1] * (p[1] - p[0]);
    const Vec3<Real> along2 = barycentric[2] * (p[2] - p[0]);
    const Vec3<Real> position = p[0] + (along1 + along2);
    const Vec3<Real> way = glm::abs(along1) + glm::abs(along2);
    return {position, roundingBound<Real>(3 + 8) * way + roundingBound<Real>(2) * glm::abs(position)};
}

/// The point in the direction of `local` from the centre. gamma(5) of the radius for bringing it to the surface (Pharr,
/// Jakob and Humphreys 2023, 6.8.5), gamma(4) for the constant term of the quadratic, whose sign tells inside from
/// outside in `intersectSphere`, and gamma(2) for adding and subtracting the centre.
template <typename Real>
[[nodiscard]] BoundedPoint<Real> pointOnSphere(const WorldSphere<Real>& sphere, const Vec3<Real>& local) {
    const Vec3<Real> onSphere = local * (sphere.radius / glm::length(local));
    const Vec3<Real> position = sphere.center + onSphere;
    return {position, roundingBound<Real>(5 + 4) * glm::abs(onSphere) + roundingBound<Real>(2) * glm::abs(position)};
}

/// Interpolated and normalised; `ng` where the mesh has no normals or they cancel.
template <typename Real>
[[nodiscard]] Vec3<Real> shadingNormal(const WorldTriangle<Real>& triangle, const Vec3<Real>& barycentric) {
    const auto& n = triangle.normals;
    const Vec3<Real> interpolated = barycentric[0] * n[0] + barycentric[1] * n[1] + barycentric[2] * n[2];
    const Real length = glm::length(interpolated);
    return length > 0 && std::isfinite(length) ? interpolated / length : triangle.ng;
}

/// The surface that `ray` meets at `hit`.
template <typename Real>
[[nodiscard]] Surface<Real> surfaceAt(const World<Real>& world, const Ray<Real>& ray, const Hit<Real>& hit) {
    Surface<Real> surface;
    surface.primitive = hit.primitive;
    surface.material = world.materialOf(hit.primitive);
    surface.t = hit.t;
    surface.barycentric = hit.barycentric;
    surface.wo = -ray.direction;
    BoundedPoint<Real> point;
    if (world.isTriangle(hit.primitive)) {
        const WorldTriangle<Real>& triangle = world.triangles[hit.primitive];
        point = pointOnTriangle(triangle, hit.barycentric);
        surface.ng = triangle.ng;
        surface.ns = shadingNormal(triangle, hit.barycentric);
    } else {
        const WorldSphere<Real>& sphere = world.sphere(hit.primitive);
        const Vec3<Real> local = (ray.origin - sphere.center) + hit.t * ray.direction;
        point = pointOnSphere(sphere, local);
        surface.ng = glm::normalize(local);
        surface.ns = surface.ng;
    }
    surface.facing = glm::dot(surface.wo, surface.ng) >= 0 ? surface.ng : -surface.ng;
    if (glm::dot(surface.ns, surface.facing) < 0) surface.ns = -surface.ns;
    surface.position = point.position;
    surface.origin = offsetPoint(point.position, point.error, surface.facing);
    surface.behind = offsetPoint(point.position, point.error, -surface.facing);
    return surface;
}

} // namespace isolux
