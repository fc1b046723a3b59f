// The plane of the triangle that a ray leaves: no triangle in it can be met again.
#ifndef ISOLUX_GEOMETRY_PLANE_GLSL
#define ISOLUX_GEOMETRY_PLANE_GLSL

#include "core/scene_access.glsl"
#include "geometry/ray.glsl"

struct Plane {
    vec3 normal;
    float offset; // normal . p of its points
    float slack;  // how far off it the corners of a triangle that lies in it may be; negative: none lies in it
};

// The same bits for the same corner, whichever triangle it is asked for.
float heightOver(Plane plane, vec3 corner) {
    precise float height = plane.normal.x * corner.x + plane.normal.y * corner.y + plane.normal.z * corner.z - plane.offset;
    return abs(height);
}

float greatestHeight(Plane plane, vec3 p0, vec3 p1, vec3 p2) {
    return max(heightOver(plane, p0), max(heightOver(plane, p1), heightOver(plane, p2)));
}

bool liesIn(Plane plane, vec3 p0, vec3 p1, vec3 p2) { return greatestHeight(plane, p0, p1, p2) <= plane.slack; }

// The slack: what the triangle's own corners are off, as its normal is rounded too, so that a triangle with the same
// corners lies in it for certain; and the rounding of both triangles' corners, of the two products of three terms and of
// their difference: 1 + 1 + 3 + 3 + 1 u of the corners' own size along the normal. For a plane y = 0 all of it is 0.
Plane planeOf(uint primitive) {
    Plane plane = Plane(vec3(0.0), 0.0, -1.0);
    if (primitive != kNone) {
        PrimitiveRecord record = readPrimitive(primitive);
        vec3 p0 = record.p0Material.xyz;
        vec3 p1 = record.p1Light.xyz;
        vec3 p2 = record.p2Id.xyz;
        float area;
        plane.normal = triangleNormal(p0, p1, p2, vec3(0.0, 0.0, 1.0), area);
        plane.offset = dot(plane.normal, p0);
        vec3 largest = max(abs(p0), max(abs(p1), abs(p2)));
        plane.slack = greatestHeight(plane, p0, p1, p2) + errorBound(9.0) * dot(abs(plane.normal), largest);
    }
    return plane;
}

#endif
