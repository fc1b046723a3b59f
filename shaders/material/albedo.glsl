// Directional albedos of microfacet lobes, from tables (host/scene/README.md, "Albedo tables").
#ifndef ISOLUX_MATERIAL_ALBEDO_GLSL
#define ISOLUX_MATERIAL_ALBEDO_GLSL

#include "core/scene_access.glsl"

const uint kFresnelTable = kReflectionAngles * kReflectionRoughnesses; // words after the first table
const uint kGlassTable = kFresnelTable + kFresnelTableAngles * kReflectionRoughnesses;

// Bilinear at (x, y) in [0, 1]^2 of a table of `nodes`.
float lookUp(uint table, uvec2 nodes, vec2 at) {
    vec2 s = clamp(at, 0.0, 1.0) * vec2(nodes - 1u);
    vec2 base = min(floor(s), vec2(nodes - 2u));
    vec2 f = s - base;
    vec4 corners = tableWord(table + uint(base.y) * nodes.x + uint(base.x));
    return mix(mix(corners.x, corners.y, f.x), mix(corners.z, corners.w, f.x), f.y);
}

// Where alpha and the cosine lie in the tables: the albedos vary with their ratio where both are small.
vec2 albedoCoordinates(float cosine, float alpha) {
    float m = sqrt(cosine);
    float y = sqrt(alpha);
    return vec2(m * (1.0 + y) / (m + y), y);
}

float reflectionAlbedo(uint tables, float cosine, float alpha) {
    return lookUp(tables, uvec2(kReflectionAngles, kReflectionRoughnesses), albedoCoordinates(cosine, alpha));
}

// The average of (1 - wo.h)^5 over what the lobe reflects.
float fresnelAlbedo(uint tables, float cosine, float alpha) {
    return lookUp(tables + kFresnelTable, uvec2(kFresnelTableAngles, kReflectionRoughnesses), vec2(sqrt(cosine), sqrt(alpha)));
}

// Rough glass, reflection and transmission together; inside: wo lies in the denser medium.
float glassAlbedo(uint tables, float cosine, float alpha, float ior, bool inside) {
    uvec2 nodes = uvec2(kGlassTableAngles, kGlassTableRoughnesses);
    uint slice = nodes.x * nodes.y;
    float s = sqrt((ior - 1.0) / (ior + 1.0)) * float(kGlassTableIndices - 1u);
    float base = min(floor(s), float(kGlassTableIndices - 2u));
    uint table = tables + kGlassTable + (uint(base) + (inside ? kGlassTableIndices : 0u)) * slice;
    vec2 at = albedoCoordinates(cosine, alpha);
    return mix(lookUp(table, nodes, at), lookUp(table + slice, nodes, at), s - base);
}

#endif
