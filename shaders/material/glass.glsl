// The glass lobes of rough surfaces: reflection and transmission at microfacets, of solids and of thin walls
// (host/scene/README.md, "Surfaces"). Directions are in a frame about the shading normal with wo.z >= 0.
#ifndef ISOLUX_MATERIAL_GLASS_GLSL
#define ISOLUX_MATERIAL_GLASS_GLSL

#include "material/fresnel.glsl"
#include "material/ggx.glsl"

layout(constant_id = 31) const bool kSolids = true;

// The direction beyond the interface about the normal h, of which wo lies on the outer side.
vec3 refracted(vec3 wo, vec3 h, float eta) {
    float cosine = dot(wo, h);
    return (cosine / eta - refractedCosine(cosine, eta)) * h - wo / eta;
}

// f |cos| of what goes through, white, compensation and tint apart, and its density (Walter et al. 2007, eqs. 17 and 21, with
// radiance scaled by 1 / eta^2); wi.z < 0.
float solidTransmission(vec3 wo, vec3 wi, float alpha, float eta, out float pdf) {
    vec3 h = normalize(wo + eta * wi);
    h = h.z < 0.0 ? -h : h;
    float outer = dot(wo, h);
    float inner = dot(wi, h);
    bool crosses = outer > 0.0 && inner < 0.0;
    vec2 alphas = vec2(alpha);
    float stretchOut = ggxStretch(wo, alphas);
    float sum = outer + eta * inner;
    float jacobian = eta * eta * abs(inner) / (sum * sum);
    float visible = 2.0 * ggxDistribution(h, alphas) * outer / (wo.z + stretchOut);
    float through = 1.0 - dielectricFresnel(outer, eta);
    pdf = crosses ? through * visible * jacobian : 0.0;
    float shadowing = ggxShadowing(wo.z, stretchOut, -wi.z, ggxStretch(wi, alphas));
    return pdf * shadowing / (eta * eta);
}

// f |cos| of reflection by the share of the microfacets' Fresnel term that `through` chooses, and its density; wi.z > 0. A thin
// wall transmits like this, mirrored.
float interfaceReflection(vec3 wo, vec3 wi, float alpha, float eta, bool through, out float pdf) {
    vec3 h = normalize(wo + wi);
    vec2 alphas = vec2(alpha);
    float stretchOut = ggxStretch(wo, alphas);
    float fresnel = dielectricFresnel(max(dot(wo, h), 0.0), eta);
    pdf = (through ? 1.0 - fresnel : fresnel) * ggxReflectionPdf(ggxDistribution(h, alphas), wo, stretchOut);
    return pdf * ggxShadowing(wo.z, stretchOut, wi.z, ggxStretch(wi, alphas));
}

#endif
