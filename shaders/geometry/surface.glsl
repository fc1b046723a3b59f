// From a hit to all that shading needs to know about the surface there.
#ifndef ISOLUX_GEOMETRY_SURFACE_GLSL
#define ISOLUX_GEOMETRY_SURFACE_GLSL

#include "core/scene_access.glsl"
#include "geometry/ray.glsl"
#include "geometry/triangle.glsl"

layout(constant_id = 5) const bool kSmoothNormals = true;

struct Surface {
    vec3 position;
    vec3 error;  // bound on the position's error per component
    vec3 facing; // unit geometric normal on the side the ray came from
    vec3 shading; // unit shading normal, on the same side
    bool front;  // the ray came from the front side
    uint material;
    uint light; // or kNone
    uint id;
    bool planar; // a triangle: a ray that leaves it cannot meet it again
    vec3 barycentric; // on a triangle
};

// Barycentric coordinates at least twice the point's error away from the edges: nearer, it may lie beyond the neighbour that
// meets the triangle there, and rays would leave a closed room. Never further than 2^-16 of the way to a corner, so that
// slivers and small triangles, whose neighbours mostly lie in one plane with them, are left as they are.
vec3 insideEdges(vec3 barycentric, vec3 p0, vec3 p1, vec3 p2, float area, float error) {
    vec3 opposite = vec3(length(p2 - p1), length(p0 - p2), length(p1 - p0)); // 2 area / height over it
    vec3 least = min(opposite * (error / max(area, 1e-30)), 1.5258789e-5);
    vec3 moved = max(barycentric, least);
    return all(greaterThanEqual(barycentric, least)) ? barycentric : moved / (moved.x + moved.y + moved.z);
}

// Point, error bound and normals of a triangle hit. Barycentric coordinates are found anew for the one triangle.
void triangleSurface(PrimitiveRecord primitive, uint index, Ray ray, RayTransform transform, uint normalSection,
                     inout Surface surface) {
    vec3 p0 = primitive.p0Material.xyz;
    vec3 p1 = primitive.p1Light.xyz;
    vec3 p2 = primitive.p2Id.xyz;
    TriangleHit hit = intersectTriangle(p0, p1, p2, ray, transform);
    vec3 b = vec3(hit.b0, hit.b1, 1.0 - hit.b0 - hit.b1);
    surface.error = errorBound(7.0) * (abs(b.x * p0) + abs(b.y * p1) + abs(b.z * p2)); // pbrt 6.8.4
    float area;
    vec3 normal = triangleNormal(p0, p1, p2, -ray.direction, area);
    b = insideEdges(b, p0, p1, p2, area, maxComponent(surface.error));
    surface.position = b.x * p0 + b.y * p1 + b.z * p2;
    surface.front = dot(ray.direction, normal) <= 0.0;
    surface.facing = surface.front ? normal : -normal;
    surface.shading = surface.facing;
    surface.barycentric = b;
    if (kSmoothNormals) {
        NormalRecord normals = readNormals(normalSection, index);
        vec3 smoothNormal = b.x * normals.n0.xyz + b.y * normals.n1.xyz + b.z * normals.n2.xyz;
        float size = length(smoothNormal);
        if (size > 0.0) {
            smoothNormal /= size;
            surface.shading = dot(smoothNormal, surface.facing) < 0.0 ? -smoothNormal : smoothNormal;
        }
    }
}

void sphereSurface(PrimitiveRecord primitive, Ray ray, float distance, inout Surface surface) {
    vec3 center = primitive.p0Material.xyz;
    float radius = primitive.p1Light.x;
    // The point along the ray carries the ray's error; put back on the sphere it carries the sphere's (pbrt 6.8.4).
    vec3 normal = normalize(ray.origin + distance * ray.direction - center);
    surface.position = center + radius * normal;
    surface.error = errorBound(6.0) * (abs(radius * normal) + abs(center));
    surface.front = dot(ray.direction, normal) <= 0.0;
    surface.facing = surface.front ? normal : -normal;
    surface.shading = surface.facing;
    surface.barycentric = vec3(0.0);
}

Surface surfaceAt(uint index, Ray ray, RayTransform transform, float distance, uint normalSection, bool spheres) {
    PrimitiveRecord primitive = readPrimitive(index);
    Surface surface;
    surface.material = floatBitsToUint(primitive.p0Material.w);
    surface.light = floatBitsToUint(primitive.p1Light.w);
    uint id = floatBitsToUint(primitive.p2Id.w);
    surface.id = id & kIdMask;
    surface.planar = !(spheres && (id & kSphereBit) != 0u);
    if (surface.planar) {
        triangleSurface(primitive, index, ray, transform, normalSection, surface);
    } else {
        sphereSurface(primitive, ray, distance, surface);
    }
    return surface;
}

#endif
