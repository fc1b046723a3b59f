// What a path does at a surface: the light samples it takes there, and the direction in which it goes on.
#ifndef ISOLUX_KERNELS_PATH_SHADING_GLSL
#define ISOLUX_KERNELS_PATH_SHADING_GLSL

#include "kernels/path_state.glsl"
#include "light/light.glsl"
#include "material/alpha.glsl"
#include "material/normal_map.glsl"

layout(constant_id = 6) const uint kRoulette = kRouletteThroughput;
layout(constant_id = 15) const uint kLightSampling = kLightSamplingMis;
layout(constant_id = 16) const bool kBalanceHeuristic = false;
layout(constant_id = 18) const bool kAllLights = false;
layout(constant_id = 32) const bool kAbsorption = true;
layout(constant_id = 42) const bool kUnlit = true;

const float kMaxSurvival = 1.0 - 1.0 / 1024.0; // host/scene/render_settings.h
const float kLossless = 1.0 - 1.0 / 2097152.0; // likewise
const uint kCellBlocks = 0x40000000u;  // of environment maps' cells, beside the blocks of light samples
const uint kAlphaBlocks = 0x20000000u; // of alpha's keys, beside the blocks of rays

uvec4 randomBlock(uint block);
void recordEvent(uint event);
bool countsBounce(uint bounces);

MapPoint mapPoint(uint primitive, bool planar, vec3 barycentric) {
    return MapPoint(primitive, planar, barycentric, render.textureOffsets, render.attributeOffsets, render.sceneCounts.y);
}

bool surfaceIsThere(PrimitiveRecord primitive, uint index, vec3 barycentric, uint key) {
    uint id = floatBitsToUint(primitive.p2Id.w);
    MaterialRecord material = readMaterial(render.tableOffsets.x, floatBitsToUint(primitive.p0Material.w));
    return isThere(material, mapPoint(index, (id & kSphereBit) == 0u, barycentric), id & kIdMask, key);
}

// The frame about a shading normal in which lobes are evaluated.
struct ShadingFrame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

ShadingFrame frameOf(vec3 shading) {
    ShadingFrame frame;
    frame.normal = shading;
    frameAbout(shading, frame.tangent, frame.bitangent);
    return frame;
}

vec3 toFrame(ShadingFrame frame, vec3 v) { return vec3(dot(v, frame.tangent), dot(v, frame.bitangent), dot(v, frame.normal)); }

vec3 fromFrame(ShadingFrame frame, vec3 v) { return v.x * frame.tangent + v.y * frame.bitangent + v.z * frame.normal; }

// wo in its frame; where it lies below the shading normal, its mirror image.
vec3 outgoingInFrame(ShadingFrame frame, vec3 outgoing) {
    vec3 wo = toFrame(frame, outgoing);
    return vec3(wo.xy, abs(wo.z));
}

EnvironmentMap environmentMap() {
    return EnvironmentMap(render.environmentMap.x, render.environmentMap.y, render.sampling.z,
                          ivec2(render.environmentMap.zw), render.environmentLimits.y);
}

// What is left of light after a way through a solid.
vec3 transmittance(uint medium, float way) {
    vec3 left = vec3(1.0);
    if (kAbsorption && medium != kNone) {
        vec3 absorption = tableWord(render.tableOffsets.x + medium * kMaterialWords + 5u).xyz;
        left = exp(-absorption * way);
    }
    return left;
}

// The light that sample `index` of a shading point goes to.
uint lightOfSample(uint index, uvec4 random) {
    uint areaSamples = render.lightSamples.y * render.lightSamples.z;
    uint light;
    if (kAllLights) {
        light = index < areaSamples ? index / render.lightSamples.y
                                    : render.lightSamples.z + min(index - areaSamples, render.lightSamples.w);
    } else {
        light = chooseLight(render.tableOffsets.z, render.depthLights.z, random.x, random.y);
    }
    if (light >= render.depthLights.w) film.faults.z += 1u;
    return min(light, render.depthLights.w - 1u);
}

// The random block of a light sample; the path has scattered already.
uint blockOfLightSample(uint index) {
    uint bounce = path.depth - 1u;
    return index == 0u ? 1u + 2u * bounce : 0x80000000u | ((bounce * render.lightSamples.x + index) & 0x7FFFFFFFu);
}

// What the material of a light says at the place that was sampled.
vec3 emissionShare(LightSample light) {
    PrimitiveRecord primitive = readPrimitive(light.primitive);
    MaterialRecord material = readMaterial(render.tableOffsets.x, floatBitsToUint(primitive.p0Material.w));
    bool planar = (floatBitsToUint(primitive.p2Id.w) & kSphereBit) == 0u;
    MapPoint at = mapPoint(light.primitive, planar, vec3(light.place, 1.0 - light.place.x - light.place.y));
    float coverage = kCutouts ? coverageOf(material, baseColorAt(material, at).a) : 1.0;
    return emissionMapAt(material, at) * coverage;
}

// Where a light is sampled from: the near side, but a sphere that emits sees itself through itself alone.
vec3 samplingOrigin(ShadingPoint point, LightRecord light) {
    bool ownSphere = kGlass && kSpheres && transmitsBroadly(point.bsdf) && (point.bsdf.kind & kInside) == 0u &&
                     (floatBitsToUint(light.emissionKind.w) & kLightKindMask) == kLightSphere &&
                     floatBitsToUint(light.p0Primitive.w) == path.primitive;
    return ownSphere ? path.beyond : path.ray.origin;
}

LightSample chooseAndSample(ShadingPoint point, uint index, out vec3 from) {
    uint block = blockOfLightSample(index);
    uvec4 random = randomBlock(block);
    LightRecord record = readLight(render.tableOffsets.y, lightOfSample(index, random));
    from = samplingOrigin(point, record);
    LightSample light;
    if (kEnvironmentMap && render.environmentMap.z > 0u && (floatBitsToUint(record.emissionKind.w) & kLightKindMask) == kLightEnvironment) {
        light = sampleEnvironmentMap(environmentMap(), record.emissionKind.xyz, record.p1Samples.w,
                                     randomBlock(block ^ kCellBlocks));
    } else {
        light = sampleLight(record, from, vec2(unitReal(random.z), unitReal(random.w)));
    }
    if ((kEmissionMaps || kCutouts) && light.pdf > 0.0 && light.mapped) light.emission *= emissionShare(light);
    return light;
}

// Samples a light and leaves a pending shadow ray in the path if it could contribute. Its limit; 0 without one.
float sampleDirect(ShadingPoint point, uint index) {
    vec3 from;
    LightSample light = chooseAndSample(point, index, from);
    bool lights = light.pdf > 0.0 && maxComponent(light.emission) > 0.0;
    bool lambertian = isLambertian(point.bsdf);
    lights = lights && (!lambertian || maxComponent(point.reflected) > 0.0);
    float cosine = lights ? lambertianCosine(point.facing, point.shading, light.direction) : 0.0;
    float pdf = lambertianPdf(cosine);
    vec3 glossy = vec3(0.0);
    bool beyond = false;
    if (!lambertian) {
        beyond = lights && transmitsBroadly(point.bsdf) && dot(light.direction, point.facing) < 0.0 &&
                 dot(light.direction, point.shading) < 0.0;
        pdf = diffusePdf(point.bsdf, cosine);
        if (cosine > 0.0 || beyond) {
            ShadingFrame frame = frameOf(point.shading);
            vec3 wi = toFrame(frame, light.direction);
            glossy = evalGlossy(point.bsdf, outgoingInFrame(frame, point.outgoing), wi, pdf) * point.throughput;
        }
        lights = maxComponent(glossy) > 0.0 || (cosine > 0.0 && maxComponent(point.reflected) > 0.0);
    } else {
        lights = cosine > 0.0;
    }
    float limit = 0.0;
    if (lights) {
        bool onlyWay = light.delta || kLightSampling == kLightSamplingLight;
        float weight = onlyWay ? 1.0 : misWeight(light.pdf, pdf, kBalanceHeuristic);
        path.shadowRadiance = point.reflected * light.emission * (cosine / light.pdf * weight);
        if (!lambertian) path.shadowRadiance += glossy * light.emission * (weight / light.pdf);
        path.shadowDirection = light.way;
        path.shadowPrimitive = light.primitive;
        limit = light.limit;
        bool finite = light.limit < kFarthest;
        if (kGlass) {
            path.shadowBeyond = beyond;
            if (beyond && finite) path.shadowDirection += from - path.beyond;
        }
        if (kAbsorption && finite)
            path.shadowRadiance *= transmittance(beyond ? path.mediumBeyond : path.medium, length(path.shadowDirection));
    } else {
        recordEvent(kSignatureNoRay);
    }
    return limit;
}

// What the path still carries, without the scaling of radiance at refractions.
float carriedLight() {
    float carried = maxComponent(path.throughput);
    if (kSolids) carried *= path.radianceScale;
    return carried;
}

// Whether roulette lets the path live, which carried `before` until it was scattered; it then stands for those that were ended.
bool survivesRoulette(uint word, float before) {
    float carried = carriedLight();
    float share = carried / before;
    float most = share <= kLossless ? max(share, kMaxSurvival) : kMaxSurvival;
    float survival = kRoulette == kRouletteConstant ? render.methods.z : min(carried, most);
    bool survives = unitReal(word) < survival;
    if (survives) path.throughput /= survival;
    return survives;
}

// The next direction off a Lambertian surface. Whether it leaves on the right side.
bool scatterDiffusely(Surface surface, vec3 baseColor, vec2 u) {
    float cosine;
    if (kLightSampling == kLightSamplingHemisphere) {
        path.ray.direction = uniformHemisphereSample(surface.shading, u, cosine);
        path.pdf = 0.5 * kInvPi;
        path.throughput *= baseColor * (2.0 * cosine);
    } else {
        path.ray.direction = lambertianSample(surface.shading, u, cosine);
        path.pdf = lambertianPdf(cosine);
        path.throughput *= baseColor;
    }
    return dot(path.ray.direction, surface.facing) > 0.0;
}

// Uniform over the hemisphere of wo, or over all directions if some of them lie beyond; with its density.
vec3 uniformDirection(Bsdf bsdf, vec2 u, out float pdf) {
    bool everywhere = transmitsBroadly(bsdf);
    float z = everywhere ? 1.0 - 2.0 * u.x : u.x;
    vec2 around = sqrt((1.0 - z) * (1.0 + z)) * cosSinTurn(u.y);
    float deltaSpecular = (bsdf.kind & kDeltaSpecular) != 0u ? (1.0 - bsdf.glass) * bsdf.specular : 0.0;
    float deltaGlass = (bsdf.kind & kDeltaGlass) != 0u ? bsdf.glass : 0.0;
    pdf = (everywhere ? 0.25 : 0.5) * kInvPi * (1.0 - deltaSpecular - deltaGlass);
    return vec3(around, z);
}

// The next direction off any other surface, its lobe and side in `outcome`. Whether it leaves on the side it should.
bool scatterByLobe(Surface surface, Bsdf bsdf, float choice, vec2 u, out uint outcome) {
    ShadingFrame frame = frameOf(surface.shading);
    vec3 wo = outgoingInFrame(frame, -path.ray.direction);
    BsdfSample chosen = sampleBsdf(bsdf, wo, choice, u);
    float uniformPdf = 0.0;
    if (kLightSampling == kLightSamplingHemisphere && !chosen.delta) {
        chosen.wi = uniformDirection(bsdf, u, uniformPdf);
        if (chosen.lobe >= kLobeGlassReflects)
            chosen.lobe = chosen.wi.z < 0.0 ? kLobeGlassTransmits : kLobeGlassReflects;
    }
    path.pdf = 0.0;
    if (!chosen.delta) {
        vec3 value = evalBsdf(bsdf, wo, chosen.wi, path.pdf);
        if (kLightSampling == kLightSamplingHemisphere) path.pdf = uniformPdf;
        chosen.weight = path.pdf > 0.0 ? value / path.pdf : vec3(0.0);
    }
    path.throughput *= chosen.weight;
    bool crosses = chosen.wi.z < 0.0;
    if (kSolids && crosses && (bsdf.kind & kSolid) != 0u) path.radianceScale *= bsdf.eta * bsdf.eta;
    path.ray.direction = fromFrame(frame, chosen.wi);
    outcome = (chosen.lobe << kLobeShift) | (crosses ? kCrossesBit : 0u);
    float side = dot(path.ray.direction, surface.facing);
    return chosen.wi != vec3(0.0) && (crosses ? side < 0.0 : side > 0.0);
}

// Chooses the next direction, unless the path ends here. The ending, and above it the lobe.
uint scatter(Surface surface, Bsdf bsdf) {
    uvec4 random = randomBlock(2u + 2u * path.depth);
    vec2 u = vec2(unitReal(random.x), unitReal(random.y));
    uint outcome = 0u;
    float before = carriedLight();
    bool leaves;
    if (isLambertian(bsdf)) {
        leaves = scatterDiffusely(surface, bsdf.diffuse, u);
    } else {
        leaves = scatterByLobe(surface, bsdf, unitReal(random.w), u, outcome);
    }
    ++path.depth;
    uint ending = kGoesOn;
    if (!leaves || maxComponent(path.throughput) <= 0.0) {
        ending = kEnds;
    } else if (kRoulette != kRouletteOff && path.depth >= render.depthLights.y && !survivesRoulette(random.z, before)) {
        ending = kEndsByRoulette;
    }
    return ending | outcome;
}

#endif
