// Rays against one triangle, one sphere and one box. A ray's direction has unit length, so its parameter is a distance.
#pragma once

#include "reference/rounding.h"
#include "reference/sampling.h"
#include "reference/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace isolux {

template <typename Real> struct Ray {
    Vec3<Real> origin;
    Vec3<Real> direction; ///< unit
    Real tMax = std::numeric_limits<Real>::infinity();
};

/// Points as the ray sees them: z is the depth along the ray, (x, y) the distance from it. Each vertex gives the same
/// three numbers whichever triangle it is asked for.
template <typename Real> class RayView {
public:
    explicit RayView(const Ray<Real>& ray) : origin_(ray.origin), frame_(frameAbout(ray.direction)) {}

    [[nodiscard]] Vec3<Real> project(const Vec3<Real>& point) const {
        const Vec3<Real> relative = point - origin_;
        return {glm::dot(frame_.t, relative), glm::dot(frame_.s, relative), glm::dot(frame_.n, relative)};
    }
    [[nodiscard]] const Vec3<Real>& origin() const { return origin_; }
    [[nodiscard]] const Vec3<Real>& direction() const { return frame_.n; }

private:
    Vec3<Real> origin_;
    Frame<Real> frame_;
};

/// The signed volume d . (P x Q) of a ray's direction and an edge, as (t.P)(s.Q) - (s.P)(t.Q) (Binet and Cauchy).
/// Exactly negated for the neighbour, which runs along the edge the other way. And a difference of two rounded products
/// never has the wrong sign, it can only be 0; so with 0 counted as inside, a closed surface, whose rounded projection
/// is closed too, has no gap at its edges and vertices.
template <typename Real> [[nodiscard]] Real edgeVolume(const Vec3<Real>& p, const Vec3<Real>& q) {
    return p.x * q.y - p.y * q.x;
}

/// Distance along the ray to a triangle's plane, measured from the vertex that gives the least rounding error. NaN or
/// infinite if they are parallel. By the plane and not by interpolated depths, because its sign must be right for a ray
/// that starts just off the triangle, however long and thin that is.
template <typename Real>
[[nodiscard]] Real planeDistance(const RayView<Real>& ray, const WorldTriangle<Real>& triangle) {
    Real least = std::numeric_limits<Real>::infinity();
    Real height = 0;
    for (const Vec3<Real>& position : triangle.positions) {
        const Vec3<Real> relative = position - ray.origin();
        const Real magnitude = glm::dot(glm::abs(triangle.ng), glm::abs(relative));
        if (!(magnitude < least)) continue;
        least = magnitude;
        height = glm::dot(triangle.ng, relative);
    }
    return height / glm::dot(triangle.ng, ray.direction());
}

template <typename Real> struct TriangleHit {
    Real t;
    Vec3<Real> barycentric;
};

/// The hit in front of the origin, at any distance; either side. A triangle without area is never hit.
template <typename Real>
[[nodiscard]] std::optional<TriangleHit<Real>> intersectWatertight(const RayView<Real>& ray,
                                                                   const WorldTriangle<Real>& triangle) {
    const Vec3<Real> p0 = ray.project(triangle.positions[0]);
    const Vec3<Real> p1 = ray.project(triangle.positions[1]);
    const Vec3<Real> p2 = ray.project(triangle.positions[2]);
    const Vec3<Real> volumes(edgeVolume(p1, p2), edgeVolume(p2, p0), edgeVolume(p0, p1));
    const bool outside = glm::any(glm::lessThan(volumes, Vec3<Real>(0))) && maxComponent(volumes) > 0;
    const Real sum = volumes.x + volumes.y + volumes.z;
    if (outside || sum == 0 || triangle.area == 0) return std::nullopt;
    const Real t = planeDistance(ray, triangle);
    if (!(t > 0)) return std::nullopt;
    return TriangleHit<Real>{t, volumes / sum};
}

/// The same by Möller and Trumbore 1997 ("Fast, minimum storage ray/triangle intersection"), on whose rounding nothing
/// is known: neighbours may both miss their edge.
template <typename Real>
[[nodiscard]] std::optional<TriangleHit<Real>> intersectMollerTrumbore(const Ray<Real>& ray,
                                                                       const WorldTriangle<Real>& triangle) {
    const Vec3<Real> e1 = triangle.positions[1] - triangle.positions[0];
    const Vec3<Real> e2 = triangle.positions[2] - triangle.positions[0];
    const Vec3<Real> s = ray.origin - triangle.positions[0];
    const Vec3<Real> s1 = glm::cross(ray.direction, e2);
    const Vec3<Real> s2 = glm::cross(s, e1);
    const Real determinant = glm::dot(s1, e1);
    if (determinant == 0 || triangle.area == 0) return std::nullopt;
    const Real b1 = glm::dot(s1, s) / determinant;
    const Real b2 = glm::dot(s2, ray.direction) / determinant;
    const Real t = glm::dot(s2, e2) / determinant;
    const bool inside = b1 >= 0 && b2 >= 0 && b1 + b2 <= 1;
    if (!inside || !(t > 0)) return std::nullopt;
    return TriangleHit<Real>{t, {1 - b1 - b2, b1, b2}};
}

/// Distance to the nearest crossing in front of the origin, from outside or inside. Haines, Günther and Akenine-Möller
/// 2019, "Precision improvements for ray/sphere intersection": the discriminant from the distance of the centre to the
/// ray, the second root from the product of both.
template <typename Real>
[[nodiscard]] std::optional<Real> intersectSphere(const Ray<Real>& ray, const WorldSphere<Real>& sphere) {
    const Vec3<Real> f = ray.origin - sphere.center;
    const Real b = -glm::dot(f, ray.direction);
    const Vec3<Real> nearest = f + b * ray.direction;
    const Real radiusSquared = sphere.radius * sphere.radius;
    const Real discriminant = radiusSquared - glm::dot(nearest, nearest);
    if (!(discriminant >= 0)) return std::nullopt;
    const Real q = b + std::copysign(std::sqrt(discriminant), b);
    if (q == 0) return std::nullopt;
    const Real other = (glm::dot(f, f) - radiusSquared) / q;
    const Real first = std::min(q, other);
    const Real t = first > 0 ? first : std::max(q, other);
    return t > 0 ? std::optional<Real>(t) : std::nullopt;
}

template <typename Real> struct RaySegment {
    Real lower;
    Real upper;
};

/// The part of the ray inside a box grown by the rounding error of anything in it: never too short, and never longer
/// for a box than for one around it. Slabs (Kay and Kajiya 1986), the far ends widened (Ize 2013).
template <typename Real>
[[nodiscard]] std::optional<RaySegment<Real>> clipToBox(const Ray<Real>& ray, const Box3f& box) {
    const Vec3<Real> lower = Vec3<Real>(box.lower) - ray.origin;
    const Vec3<Real> upper = Vec3<Real>(box.upper) - ray.origin;
    // A vertex in the box is projected with an error of less than gamma(8) of its distance along each axis.
    const Real slack = roundingBound<Real>(16) * maxComponent(glm::max(glm::abs(lower), glm::abs(upper)));
    RaySegment<Real> inside{0, ray.tMax};
    for (int axis = 0; axis < 3; ++axis) {
        const Real low = lower[axis] - slack;
        const Real high = upper[axis] + slack;
        const Real d = ray.direction[axis];
        if (d == 0 && (low > 0 || high < 0)) return std::nullopt;
        if (d == 0) continue;
        inside.lower = std::max(inside.lower, std::min(low / d, high / d));
        inside.upper = std::min(inside.upper, std::max(low / d, high / d) * (1 + 2 * roundingBound<Real>(3)));
    }
    return inside.lower <= inside.upper ? std::optional(inside) : std::nullopt;
}

} // namespace isolux
