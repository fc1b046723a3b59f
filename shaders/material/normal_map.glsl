// Bending the shading normal by a normal map (host/scene/README.md, "Textures").
#ifndef ISOLUX_MATERIAL_NORMAL_MAP_GLSL
#define ISOLUX_MATERIAL_NORMAL_MAP_GLSL

#include "geometry/surface.glsl"
#include "material/maps.glsl"

// The shading normal, on the side of wo. The map is relative to the interpolated normal on the front side.
vec3 mappedNormal(Surface surface, MaterialRecord material, MapPoint at) {
    vec3 normal = surface.front ? surface.shading : -surface.shading;
    vec3 front = surface.front ? surface.facing : -surface.facing;
    TangentRecord tangents = readTangents(at.attributes.y, at.primitive);
    vec3 interpolated = at.barycentric.x * tangents.t0.xyz + at.barycentric.y * tangents.t1.xyz + at.barycentric.z * tangents.t2.xyz;
    vec3 tangent = interpolated - dot(interpolated, normal) * normal;
    float size = length(tangent);
    vec3 result = normal;
    if (size > 0.0) {
        tangent /= size;
        vec3 bitangent = tangents.t0.w * cross(normal, tangent);
        vec3 n = 2.0 * mapValue(material.maps.z, at, false).rgb - 1.0;
        n.xy *= material.glass.z;
        vec3 bent = n.x * tangent + n.y * bitangent + n.z * normal;
        float bentSize = length(bent);
        if (bentSize > 0.0 && dot(bent, front) > 0.0) result = bent / bentSize;
    }
    return surface.front ? result : -result;
}

#endif
