// GGX microfacets in a frame about the shading normal: distribution, masking, visible normals. alpha per axis of the
// tangent plane, so that anisotropy is a matter of the frame alone.
#ifndef ISOLUX_MATERIAL_GGX_GLSL
#define ISOLUX_MATERIAL_GGX_GLSL

#include "core/math.glsl"

// The density of microfacet normals; no cosine is squared and divided by, which loses every digit at small alpha.
float ggxDistribution(vec3 h, vec2 alpha) {
    vec2 stretched = h.xy / alpha;
    float t = dot(stretched, stretched) + h.z * h.z;
    return kInvPi / (alpha.x * alpha.y * t * t);
}

// sqrt(alpha^2 sin^2 + cos^2): Smith's masking is G1 = 2 cos/(cos + this) (Heitz 2014).
float ggxStretch(vec3 w, vec2 alpha) {
    vec2 flattened = alpha * w.xy;
    return sqrt(dot(flattened, flattened) + w.z * w.z);
}

// Density of reflected directions: of visible normals D G1 max(wo.h, 0)/cos, over 4 wo.h.
float ggxReflectionPdf(float distribution, vec3 wo, float stretchOut) { return 0.5 * distribution / (wo.z + stretchOut); }

// G2 / G1(wo), height-correlated: what is left of a sampled direction.
float ggxShadowing(float cosineOut, float stretchOut, float cosineIn, float stretchIn) {
    return cosineIn * (cosineOut + stretchOut) / (cosineOut * stretchIn + cosineIn * stretchOut);
}

// A normal visible from wo (Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps").
vec3 ggxVisibleNormal(vec3 wo, vec2 alpha, vec2 u) {
    vec3 w = normalize(vec3(alpha * wo.xy, wo.z));
    float z = (1.0 - u.y) * (1.0 + w.z) - w.z;
    vec2 around = sqrt(max(1.0 - z * z, 0.0)) * cosSinTurn(u.x);
    vec3 h = vec3(around + w.xy, z + w.z);
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-30)));
}

#endif
