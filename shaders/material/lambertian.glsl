// The Lambertian lobe, two-sided. wi points away from the surface; eval never includes the cosine (host/scene/README.md).
#ifndef ISOLUX_MATERIAL_LAMBERTIAN_GLSL
#define ISOLUX_MATERIAL_LAMBERTIAN_GLSL

#include "core/math.glsl"

// Cosine to the shading normal, 0 where wi does not leave on the facing side.
float lambertianCosine(vec3 facing, vec3 shading, vec3 wi) {
    return dot(wi, facing) > 0.0 ? max(dot(wi, shading), 0.0) : 0.0;
}

vec3 lambertianEval(vec3 baseColor) { return baseColor * kInvPi; }

// Solid-angle density of cosine-weighted sampling.
float lambertianPdf(float cosine) { return cosine * kInvPi; }

// Cosine-weighted direction about the shading normal; cosine is exact for grazing directions too.
vec3 lambertianSample(vec3 shading, vec2 u, out float cosine) {
    float radius;
    vec2 disk = concentricDisk(u, radius);
    cosine = heightOverDisk(radius);
    vec3 tangent, bitangent;
    frameAbout(shading, tangent, bitangent);
    return disk.x * tangent + disk.y * bitangent + cosine * shading;
}

// Uniform direction in the hemisphere about the shading normal, of density 1 / (2 pi): what a surface knows nothing of.
vec3 uniformHemisphereSample(vec3 shading, vec2 u, out float cosine) {
    cosine = u.x;
    vec2 around = sqrt((1.0 - u.x) * (1.0 + u.x)) * cosSinTurn(u.y);
    vec3 tangent, bitangent;
    frameAbout(shading, tangent, bitangent);
    return around.x * tangent + around.y * bitangent + cosine * shading;
}

#endif
