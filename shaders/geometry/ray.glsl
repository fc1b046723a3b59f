// Rays prepared for traversal, and origins that leave a surface without meeting it again.
#ifndef ISOLUX_GEOMETRY_RAY_GLSL
#define ISOLUX_GEOMETRY_RAY_GLSL

#include "core/math.glsl"

struct Ray {
    vec3 origin;
    vec3 direction; // any length: distances are in units of it
};

// What the box and triangle tests need of a ray, computed once.
struct RayTransform {
    vec3 inverseDirection; // finite: components below 2^-100 count as 2^-100, so no box test makes 0 * inf
    vec3 lowerOrigin;      // the origin, moved so that lower and upper planes of boxes lie a little further out
    vec3 upperOrigin;
    uint axis;             // 0, 1, 2: the dominant axis of the direction, which becomes z
    vec3 shear;            // x/z, y/z, 1/z of the direction with that axis as z
};

// Rotates components so that `axis` becomes z.
vec3 rotateToAxis(vec3 v, uint axis) { return axis == 0u ? v.yzx : axis == 1u ? v.zxy : v; }

float guardedInverse(float d) {
    const float kTiny = 7.8886091e-31; // 2^-100
    return 1.0 / (abs(d) < kTiny ? kTiny : d);
}

RayTransform transformFor(Ray ray) {
    RayTransform result;
    vec3 d = ray.direction;
    result.inverseDirection = vec3(guardedInverse(d.x), guardedInverse(d.y), guardedInverse(d.z));
    // The triangle test accepts rays that pass a triangle by the rounding of its sheared vertices: half an ulp for each
    // difference, the shear's 2.5 ulp of division, product and difference again, some 8 u of the distances involved,
    // which 1 (the scene) and the origin's coordinates bound. Boxes must not be missed by rays that hit what is inside.
    float padding = 9.5367432e-7 * (1.0 + max(abs(ray.origin.x), max(abs(ray.origin.y), abs(ray.origin.z)))); // 16 u
    result.lowerOrigin = ray.origin + padding;
    result.upperOrigin = ray.origin - padding;
    vec3 m = abs(d);
    result.axis = m.x >= m.y && m.x >= m.z ? 0u : m.y >= m.z ? 1u : 2u;
    vec3 r = rotateToAxis(d, result.axis);
    result.shear = vec3(r.x / r.z, r.y / r.z, 1.0 / r.z);
    return result;
}

// Unit normal and area of a triangle, by its two shorter edges: the long ones of a sliver are nearly parallel. The cross
// product is scaled before it is squared, so that small triangles keep their normals; one without any extent has area 0 and
// the normal `otherwise`.
vec3 triangleNormal(vec3 p0, vec3 p1, vec3 p2, vec3 otherwise, out float area) {
    vec3 a = p1 - p0;
    vec3 b = p2 - p1;
    vec3 c = p0 - p2;
    float aa = dot(a, a);
    float bb = dot(b, b);
    float cc = dot(c, c);
    bool longestA = aa >= bb && aa >= cc;
    bool longestB = !longestA && bb >= cc;
    vec3 scaledNormal = cross(longestA ? b : longestB ? c : a, longestA ? c : longestB ? a : b);
    float size = max(abs(scaledNormal.x), max(abs(scaledNormal.y), abs(scaledNormal.z)));
    vec3 direction = size > 0.0 ? scaledNormal / size : otherwise;
    float directionLength = length(direction);
    area = 0.5 * size * directionLength;
    return direction / directionLength;
}

// Moves a point on a surface, known to within `error` per component, off it to the side of `towards` (a unit normal),
// by just the bound and one rounding (pbrt 6.8.6).
vec3 offsetOrigin(vec3 point, vec3 error, vec3 towards) {
    float distance = dot(abs(towards), error);
    vec3 offset = distance * towards;
    vec3 moved = point + offset;
    return vec3(offset.x != 0.0 ? nextFloat(moved.x, offset.x > 0.0) : moved.x,
                offset.y != 0.0 ? nextFloat(moved.y, offset.y > 0.0) : moved.y,
                offset.z != 0.0 ? nextFloat(moved.z, offset.z > 0.0) : moved.z);
}

#endif
