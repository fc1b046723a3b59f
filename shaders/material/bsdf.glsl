// How a surface scatters: which lobes it has at a point, what they carry, and choosing a direction among them. wo and wi point
// away from the surface, in a frame about the shading normal with wo.z >= 0; values include the cosine |wi.z|
// (host/scene/README.md, "Surfaces").
#ifndef ISOLUX_MATERIAL_BSDF_GLSL
#define ISOLUX_MATERIAL_BSDF_GLSL

#include "material/albedo.glsl"
#include "material/glass.glsl"
#include "material/lambertian.glsl"
#include "material/maps.glsl"
#include "shared/path_records.h"

layout(constant_id = 27) const bool kSpecular = true;
layout(constant_id = 28) const bool kRoughSpecular = true;
layout(constant_id = 29) const bool kGlass = true;
layout(constant_id = 30) const bool kRoughGlass = true;

const bool kLambertianOnly = !kSpecular && !kGlass;
const float kSmallestAlpha = 1e-5; // below, a lobe is a delta lobe; as host/scene/scene.h says

// Bits of Bsdf.kind.
const uint kLambertian = 1u;     // the diffuse lobe alone
const uint kDeltaSpecular = 2u;
const uint kDeltaGlass = 4u;
const uint kSolid = 8u;          // glass bounds a solid
const uint kInside = 16u;        // wo lies in it

struct Bsdf {
    vec3 diffuse;   // albedo of the diffuse lobe, times its share 1 - glass
    vec3 f0;        // of the specular lobe at normal incidence, its compensation multiplied in
    vec3 f90;       // and at grazing
    vec3 tint;      // of what glass transmits
    float specular; // probability of choosing the specular lobe, given that it is not glass
    float glass;    // share of glass, and the probability of choosing it
    float gain;     // compensation of rough glass
    float alpha;
    float eta;      // index beyond / index on the side of wo
    uint kind;
};

Bsdf lambertianBsdf(vec3 baseColor) {
    return Bsdf(baseColor, vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 1.0, 1.0, 1.0, kLambertian);
}

// What the opaque part of a surface is made of: metal beside a dielectric, which lies over the diffuse base.
struct Layers {
    vec3 base;
    float metal; // share
    vec3 coatF0; // of the dielectric
    float coatF90;
};

// Compensation included.
vec3 specularFresnel(Bsdf bsdf, float cosine) { return bsdf.f0 + (bsdf.f90 - bsdf.f0) * schlickWeight(cosine); }

// The largest channel of what a specular lobe reflects: `albedo` for F = 1, `schlick` its mean of (1 - wo.h)^5.
float mostReflected(vec3 f0, vec3 f90, float albedo, float schlick) {
    return min(maxComponent((f0 + (f90 - f0) * schlick) * albedo), 1.0);
}

// What the specular lobe does at the cosine of wo: its Fresnel term, the diffuse base it leaves, the choice between the two.
void layerSpecular(inout Bsdf bsdf, Layers layers, float cosine, uint albedoTables) {
    float albedo = 1.0;
    float schlick = schlickWeight(cosine);
    if (kRoughSpecular && (bsdf.kind & kDeltaSpecular) == 0u) {
        albedo = reflectionAlbedo(albedoTables, cosine, bsdf.alpha);
        schlick = fresnelAlbedo(albedoTables, cosine, bsdf.alpha);
    }
    // What each share loses between microfacets is given back by its own F0 (Turquin 2019).
    float boost = 1.0 / albedo - 1.0;
    vec3 ofCoat = 1.0 + layers.coatF0 * boost;
    vec3 ofMetal = 1.0 + layers.base * boost;
    vec3 coatF0 = ofCoat * layers.coatF0;
    vec3 coatF90 = ofCoat * layers.coatF90;
    bsdf.f0 = mix(coatF0, ofMetal * layers.base, layers.metal);
    bsdf.f90 = mix(coatF90, ofMetal, layers.metal);
    float reflected = mostReflected(bsdf.f0, bsdf.f90, albedo, schlick);
    vec3 left = layers.base * ((1.0 - layers.metal) * (1.0 - mostReflected(coatF0, coatF90, albedo, schlick)));
    float diffuse = maxComponent(left);
    bsdf.specular = reflected > 0.0 ? reflected / (reflected + diffuse) : 0.0;
    bsdf.diffuse = left * (1.0 - bsdf.glass);
}

void prepareGlass(inout Bsdf bsdf, float ior, float cosine, uint albedoTables) {
    bool inside = (bsdf.kind & kInside) != 0u;
    bool solid = kSolids && (bsdf.kind & kSolid) != 0u;
    bsdf.eta = solid && inside ? 1.0 / ior : ior;
    bool smoothSurface = bsdf.alpha < kSmallestAlpha || (solid && bsdf.alpha * abs(ior - 1.0) < kSmallestAlpha);
    if (!kRoughGlass || smoothSurface) {
        bsdf.kind |= kDeltaGlass;
    } else {
        bsdf.gain = 1.0 / (solid ? glassAlbedo(albedoTables, cosine, bsdf.alpha, ior, inside)
                                 : reflectionAlbedo(albedoTables, cosine, bsdf.alpha));
    }
}

// The lobes at a point; `cosine`: of wo to the shading normal, not negative.
Bsdf bsdfAt(MaterialRecord material, MapPoint at, vec3 base, float cosine, bool front) {
    Bsdf bsdf = lambertianBsdf(base);
    if (!kLambertianOnly) {
        float metallic = material.surface.x;
        float roughness = material.surface.y;
        if (kMetallicRoughnessMaps) {
            vec4 value = mapValue(material.maps.y, at, false);
            metallic *= value.b;
            roughness *= value.g;
        }
        bsdf.alpha = roughness * roughness;
        float ior = material.surface.z;
        if (kGlass) {
            float thickness = material.glass.y;
            bsdf.glass = (1.0 - metallic) * material.glass.x;
            if (kTransmissionMaps) {
                bsdf.glass *= mapValue(material.moreMaps.x, at, false).r;
                thickness *= mapValue(material.moreMaps.y, at, false).g;
            }
            if (bsdf.glass > 0.0) {
                bsdf.tint = base;
                bsdf.kind = (kSolids && thickness > 0.0 ? kSolid : 0u) | (front ? 0u : kInside);
            }
        }
        if (kSpecular && bsdf.glass < 1.0) {
            float metal = min(metallic / (1.0 - bsdf.glass), 1.0); // rounding may leave more
            float factor = material.specular.w;
            vec3 color = material.specular.rgb;
            if (kSpecularMaps) {
                factor *= mapValue(material.moreMaps.z, at, false).a;
                color *= mapValue(material.moreMaps.w, at, true).rgb;
            }
            float ratio = (ior - 1.0) / (ior + 1.0);
            Layers layers = Layers(base, metal, factor * min(ratio * ratio * color, 1.0), factor);
            if (metal > 0.0 || factor > 0.0) {
                bsdf.kind &= ~kLambertian;
                if (!kRoughSpecular || bsdf.alpha < kSmallestAlpha) bsdf.kind |= kDeltaSpecular;
                layerSpecular(bsdf, layers, cosine, at.textures.w);
            }
        }
        if ((bsdf.kind & kLambertian) == 0u && bsdf.specular == 0.0) bsdf.diffuse = base * (1.0 - bsdf.glass);
        if (kGlass && bsdf.glass > 0.0) prepareGlass(bsdf, ior, cosine, at.textures.w);
    }
    return bsdf;
}

bool isLambertian(Bsdf bsdf) { return kLambertianOnly || (bsdf.kind & kLambertian) != 0u; }

// Whether any lobe scatters to more than single directions.
bool scattersBroadly(Bsdf bsdf) {
    bool diffuse = bsdf.glass < 1.0 && bsdf.specular < 1.0;
    bool specular = bsdf.glass < 1.0 && bsdf.specular > 0.0 && (bsdf.kind & kDeltaSpecular) == 0u;
    bool glass = bsdf.glass > 0.0 && (bsdf.kind & kDeltaGlass) == 0u;
    return diffuse || specular || glass;
}

bool transmitsBroadly(Bsdf bsdf) { return kRoughGlass && bsdf.glass > 0.0 && (bsdf.kind & kDeltaGlass) == 0u; }

// f cos of the specular lobe with its share, and its density times the probability of choosing it; wi.z > 0.
vec3 evalSpecular(Bsdf bsdf, vec3 wo, vec3 wi, inout float pdf) {
    vec2 alphas = vec2(bsdf.alpha);
    vec3 h = normalize(wo + wi);
    float stretchOut = ggxStretch(wo, alphas);
    float density = ggxReflectionPdf(ggxDistribution(h, alphas), wo, stretchOut);
    pdf += (1.0 - bsdf.glass) * bsdf.specular * density;
    vec3 fresnel = specularFresnel(bsdf, dot(wo, h));
    return fresnel * ((1.0 - bsdf.glass) * density * ggxShadowing(wo.z, stretchOut, wi.z, ggxStretch(wi, alphas)));
}

// f |cos| of the glass lobes with their share, and their density times the probability of choosing them.
vec3 evalGlass(Bsdf bsdf, vec3 wo, vec3 wi, inout float pdf) {
    float density;
    float value;
    vec3 tint = vec3(1.0);
    if (wi.z > 0.0) {
        value = interfaceReflection(wo, wi, bsdf.alpha, bsdf.eta, false, density);
    } else {
        tint = bsdf.tint;
        if (kSolids && (bsdf.kind & kSolid) != 0u) {
            value = solidTransmission(wo, wi, bsdf.alpha, bsdf.eta, density);
        } else {
            value = interfaceReflection(wo, vec3(wi.xy, -wi.z), bsdf.alpha, bsdf.eta, true, density);
        }
    }
    pdf += bsdf.glass * density;
    return tint * (bsdf.glass * bsdf.gain * value);
}

// f |cos| of all lobes but delta lobes and, into `diffuse` and not added, of the diffuse one without the cosine's share: the
// caller multiplies that by the cosine. `pdf`: the density of `sampleBsdf`.
vec3 evalGlossy(Bsdf bsdf, vec3 wo, vec3 wi, inout float pdf) {
    vec3 value = vec3(0.0);
    if (kRoughSpecular && wi.z > 0.0 && bsdf.specular > 0.0 && (bsdf.kind & kDeltaSpecular) == 0u)
        value += evalSpecular(bsdf, wo, wi, pdf);
    if (transmitsBroadly(bsdf) && wi.z != 0.0) value += evalGlass(bsdf, wo, wi, pdf);
    return value;
}

// Density of the diffuse lobe, times the probability of choosing it.
float diffusePdf(Bsdf bsdf, float cosine) {
    return (1.0 - bsdf.glass) * (1.0 - bsdf.specular) * lambertianPdf(max(cosine, 0.0));
}

// f |cos| of all lobes but delta lobes.
vec3 evalBsdf(Bsdf bsdf, vec3 wo, vec3 wi, out float pdf) {
    pdf = diffusePdf(bsdf, wi.z);
    vec3 glossy = evalGlossy(bsdf, wo, wi, pdf);
    return glossy + bsdf.diffuse * (kInvPi * max(wi.z, 0.0));
}

// A direction, and with `delta` what it carries already over the probability of choosing it.
struct BsdfSample {
    vec3 wi;
    uint lobe;   // kLobe...
    bool delta;
    vec3 weight; // of a delta lobe
};

BsdfSample sampleGlass(Bsdf bsdf, vec3 wo, float choice, vec2 u) {
    BsdfSample result;
    result.delta = !kRoughGlass || (bsdf.kind & kDeltaGlass) != 0u;
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (!result.delta) h = ggxVisibleNormal(wo, vec2(bsdf.alpha), u);
    float cosine = dot(wo, h);
    bool solid = kSolids && (bsdf.kind & kSolid) != 0u;
    vec3 mirrored = 2.0 * cosine * h - wo;
    result.weight = vec3(1.0);
    if (choice < dielectricFresnel(cosine, bsdf.eta)) {
        result.lobe = kLobeGlassReflects;
        result.wi = mirrored;
        if (mirrored.z <= 0.0) result.wi = vec3(0.0); // below the surface: carries nothing
    } else {
        result.lobe = kLobeGlassTransmits;
        result.wi = solid ? refracted(wo, h, bsdf.eta) : vec3(mirrored.xy, -mirrored.z);
        if (result.delta && !solid) result.wi = -wo;
        if (result.wi.z >= 0.0) result.wi = vec3(0.0);
        result.weight = bsdf.tint / (solid ? bsdf.eta * bsdf.eta : 1.0);
    }
    return result;
}

BsdfSample sampleSpecular(Bsdf bsdf, vec3 wo, vec2 u) {
    BsdfSample result;
    result.lobe = kLobeSpecular;
    result.delta = !kRoughSpecular || (bsdf.kind & kDeltaSpecular) != 0u;
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (!result.delta) h = ggxVisibleNormal(wo, vec2(bsdf.alpha), u);
    result.wi = 2.0 * dot(wo, h) * h - wo;
    if (result.wi.z <= 0.0) result.wi = vec3(0.0);
    result.weight = specularFresnel(bsdf, wo.z) / bsdf.specular;
    return result;
}

// A direction of the lobe that `choice` chooses. wi = 0: it went to the wrong side of the surface.
BsdfSample sampleBsdf(Bsdf bsdf, vec3 wo, float choice, vec2 u) {
    BsdfSample result;
    if (kGlass && choice < bsdf.glass) {
        result = sampleGlass(bsdf, wo, choice / bsdf.glass, u);
    } else if (kSpecular && (choice - bsdf.glass) / (1.0 - bsdf.glass) < bsdf.specular) {
        result = sampleSpecular(bsdf, wo, u);
    } else {
        float radius;
        vec2 disk = concentricDisk(u, radius);
        result.wi = vec3(disk, heightOverDisk(radius));
        result.lobe = kLobeDiffuse;
        result.delta = false;
        result.weight = vec3(0.0);
    }
    return result;
}

#endif
