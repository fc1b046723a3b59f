// Ray-triangle tests: the watertight one (Woop, Benthin and Wald 2013) and that of Möller and Trumbore (1997).
#ifndef ISOLUX_GEOMETRY_TRIANGLE_GLSL
#define ISOLUX_GEOMETRY_TRIANGLE_GLSL

#include "geometry/ray.glsl"

layout(constant_id = 23) const bool kMollerTrumbore = false;

struct TriangleHit {
    float distance; // in units of the direction; 0 or less: no hit
    float b0;       // barycentric coordinates of p0 and p1
    float b1;
};

// A vertex seen along the ray: xy sheared so that the ray is the z axis, z scaled to distance. `precise` keeps every
// vertex's value the same in all triangles that share it, whichever place it takes there.
vec3 shearVertex(vec3 p, vec3 origin, RayTransform transform) {
    precise vec3 v = rotateToAxis(p - origin, transform.axis);
    precise float x = v.x - transform.shear.x * v.z;
    precise float y = v.y - transform.shear.y * v.z;
    precise float z = transform.shear.z * v.z;
    return vec3(x, y, z);
}

// The shared edge of two triangles gives exactly opposite values, so a ray cannot slip between them; a value of zero
// counts as inside for both.
TriangleHit intersectWatertight(vec3 p0, vec3 p1, vec3 p2, vec3 origin, RayTransform transform) {
    vec3 a = shearVertex(p0, origin, transform);
    vec3 b = shearVertex(p1, origin, transform);
    vec3 c = shearVertex(p2, origin, transform);
    precise float u = c.x * b.y - c.y * b.x;
    precise float v = a.x * c.y - a.y * c.x;
    precise float w = b.x * a.y - b.y * a.x;
    float determinant = u + v + w;
    bool outside = (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
    TriangleHit hit = TriangleHit(0.0, 0.0, 0.0);
    if (!outside && determinant != 0.0) {
        hit.distance = (u * a.z + v * b.z + w * c.z) / determinant;
        hit.b0 = u / determinant;
        hit.b1 = v / determinant;
    }
    return hit;
}

// Rays may slip between triangles that share an edge: each rounds its own barycentric coordinates. These are given outside
// as well: where a hit is shaded a driver may contract this arithmetic otherwise and find it just outside.
TriangleHit intersectMollerTrumbore(vec3 p0, vec3 p1, vec3 p2, Ray ray) {
    vec3 e1 = p1 - p0;
    vec3 e2 = p2 - p0;
    vec3 s = ray.origin - p0;
    vec3 s1 = cross(ray.direction, e2);
    vec3 s2 = cross(s, e1);
    float determinant = dot(s1, e1);
    TriangleHit hit = TriangleHit(0.0, 0.0, 0.0);
    if (determinant != 0.0) {
        float b1 = dot(s1, s) / determinant;
        float b2 = dot(s2, ray.direction) / determinant;
        bool inside = b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0;
        hit = TriangleHit(inside ? dot(s2, e2) / determinant : 0.0, 1.0 - b1 - b2, b1);
    }
    return hit;
}

TriangleHit intersectTriangle(vec3 p0, vec3 p1, vec3 p2, Ray ray, RayTransform transform) {
    TriangleHit hit;
    if (kMollerTrumbore) {
        hit = intersectMollerTrumbore(p0, p1, p2, ray);
    } else {
        hit = intersectWatertight(p0, p1, p2, ray.origin, transform);
    }
    return hit;
}

#endif
