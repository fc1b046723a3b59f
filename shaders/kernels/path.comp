// Path tracing: light sampling, scattering, Russian roulette. A lane works through one pixel's batch of samples; a dispatch
// gives it a budget of steps, and what is unfinished is stored and resumed.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/path_state.glsl"
#include "core/sample_sequence.glsl"
#include "film/accumulate.glsl"
#include "geometry/camera.glsl"
#include "geometry/surface.glsl"
#include "light/light.glsl"
#include "material/lambertian.glsl"

layout(constant_id = 6) const uint kRoulette = kRouletteThroughput;
layout(constant_id = 7) const bool kPathSignatures = false;
layout(constant_id = 12) const bool kAovs = false;
layout(constant_id = 13) const uint kSampler = kSamplerIndependent;
layout(constant_id = 14) const uint kIntegrator = kIntegratorPath;
layout(constant_id = 15) const uint kLightSampling = kLightSamplingMis;
layout(constant_id = 16) const bool kBalanceHeuristic = false;
layout(constant_id = 18) const bool kAllLights = false;
layout(constant_id = 19) const bool kBounceRange = false;
layout(constant_id = 25) const bool kKeepSamples = false;

const float kMaxSurvival = 1.0 - 1.0 / 1024.0; // host/scene/render_settings.h

uvec4 randomBlock(uint block) {
    SampleIndex index = SampleIndex(render.imageSeed.zw, pixel, parameters.batch.x + path.sampleIndex, render.sampling.y);
    uvec4 words;
    if (kSampler == kSamplerSobol) {
        words = sobolBlock(index, block);
    } else if (kSampler == kSamplerSobolBlueNoise) {
        words = sobolBlueNoiseBlock(index, block);
    } else if (kSampler == kSamplerStratified) {
        words = stratifiedBlock(index, block);
    } else {
        words = independentBlock(index, block);
    }
    return words;
}

void recordEvent(uint event) {
    if (kPathSignatures) path.signature = (path.signature ^ event) * kSignatureFactor;
}

void beginTraversalTo(float limit) {
    path.traversal = beginTraversal(limit, render.sceneCounts.x, render.sceneCounts.y);
}

void beginNearest() {
    path.phase = kPhaseNearest;
    beginTraversalTo(kFarthest);
}

void beginSample() {
    path.ray = cameraRay(render, pixel, randomBlock(0u));
    path.leaves = kNone;
    path.lightsLeft = 0u;
    path.point = ShadingPoint(vec3(0.0), vec3(0.0), vec3(0.0));
    path.depth = 0u;
    path.pdf = 0.0;
    path.throughput = vec3(1.0);
    path.radiance = vec3(0.0);
    path.signature = kSignatureStart;
    path.ending = kGoesOn;
    beginNearest();
}

void endSample() {
    accumulateSample(film, path.radiance);
    if (kKeepSamples) samples[gl_GlobalInvocationID.x].radiance[path.sampleIndex] = vec4(path.radiance, 0.0);
    film.counts.z += path.signature;
    ++path.sampleIndex;
    if (path.sampleIndex == parameters.batch.y) {
        path.phase = kPhaseDone;
    } else {
        beginSample();
    }
}

// Whether light of so many bounces counts.
bool countsBounce(uint bounces) { return !kBounceRange || bounces >= render.sampling.x; }

// The weight of light that scattering has found with the density `pdf` where light sampling has the density `ofLight`.
float scatteringWeight(float pdf, float ofLight) {
    return kLightSampling == kLightSamplingLight ? 0.0 : misWeight(pdf, ofLight, kBalanceHeuristic);
}

void addEmission(Surface surface, MaterialRecord material, float distance) {
    vec3 emission = material.emission.xyz;
    if (emission != vec3(0.0) && (surface.front || material.emission.w != 0.0) && countsBounce(path.depth)) {
        float weight = 1.0;
        if (kAreaLights && kLights != kLightsNone && path.depth > 0u && surface.light != kNone) {
            LightRecord light = readLight(render.tableOffsets.y, surface.light);
            float cosine = abs(dot(path.ray.direction, surface.facing));
            weight = scatteringWeight(path.pdf, areaLightPdf(light, path.ray.origin, distance, cosine));
        }
        path.radiance += path.throughput * emission * weight;
    }
}

// What a ray that meets nothing sees.
void addEnvironment() {
    if (kEnvironment && path.ray.direction.y > render.environmentLimits.x) {
        bool onlyWay = path.depth == 0u || render.environment.w == 0.0;
        float weight = onlyWay ? 1.0 : scatteringWeight(path.pdf, render.environment.w);
        if (countsBounce(path.depth)) path.radiance += path.throughput * render.environment.xyz * weight;
        if (path.depth == 0u) film.mean.w += 1.0;
    }
}

// The sample's part of the AOVs, which are in the buffer alone: a camera ray meets a surface once a sample.
void recordFirstHit(Surface surface, vec3 albedo) {
    uint lane = gl_GlobalInvocationID.x;
    float depth = dot(surface.position - render.cameraPosition.xyz, render.cameraForward.xyz);
    aovs[lane].albedoDepth += vec4(albedo, depth);
    aovs[lane].normal += vec4(surface.shading, 0.0);
    aovs[lane].primitiveId[path.sampleIndex / 4u][path.sampleIndex % 4u] = surface.id;
}

void clearAovs() {
    uint lane = gl_GlobalInvocationID.x;
    aovs[lane].albedoDepth = vec4(0.0);
    aovs[lane].normal = vec4(0.0);
    aovs[lane].primitiveId = uvec4[4](uvec4(kNone), uvec4(kNone), uvec4(kNone), uvec4(kNone));
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

// Samples a light and leaves a pending shadow ray in the path if it could contribute. Its limit; 0 without one.
float sampleDirect(ShadingPoint point, uint index) {
    uvec4 random = randomBlock(blockOfLightSample(index));
    LightSample light = sampleLight(readLight(render.tableOffsets.y, lightOfSample(index, random)), path.ray.origin,
                                    vec2(unitReal(random.z), unitReal(random.w)));
    bool lights = light.pdf > 0.0 && maxComponent(point.reflected) > 0.0;
    float cosine = lights ? lambertianCosine(point.facing, point.shading, light.direction) : 0.0;
    if (cosine > 0.0) {
        bool onlyWay = light.delta || kLightSampling == kLightSamplingLight;
        float weight = onlyWay ? 1.0 : misWeight(light.pdf, lambertianPdf(cosine), kBalanceHeuristic);
        path.shadowRadiance = point.reflected * light.emission * (cosine / light.pdf * weight);
        path.shadowDirection = light.way;
        path.shadowPrimitive = light.primitive;
    } else {
        recordEvent(kSignatureNoRay);
    }
    return cosine > 0.0 ? light.limit : 0.0;
}

// Whether roulette lets the path live; it then stands for those that were ended.
bool survivesRoulette(uint word) {
    float survival = kRoulette == kRouletteConstant ? render.methods.z : min(maxComponent(path.throughput), kMaxSurvival);
    bool survives = unitReal(word) < survival;
    if (survives) path.throughput /= survival;
    return survives;
}

// Chooses the next direction, unless the path ends here.
uint scatter(Surface surface, vec3 baseColor) {
    uvec4 random = randomBlock(2u + 2u * path.depth);
    vec2 u = vec2(unitReal(random.x), unitReal(random.y));
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
    ++path.depth;
    uint ending = kGoesOn;
    if (dot(path.ray.direction, surface.facing) <= 0.0 || maxComponent(path.throughput) <= 0.0) {
        ending = kEnds;
    } else if (kRoulette != kRouletteOff && path.depth >= render.depthLights.y && !survivesRoulette(random.z)) {
        ending = kEndsByRoulette;
    }
    return ending;
}

void goOnOrEnd() {
    if (path.ending == kGoesOn) {
        beginNearest();
    } else {
        if (path.ending == kEndsByRoulette) recordEvent(kSignatureRoulette);
        path.phase = kPhaseEnded;
    }
}

// What integrators that look at the first hit alone answer; ambient occlusion asks one more ray.
void shadeFirstHit(Surface surface, vec3 albedo) {
    path.phase = kPhaseEnded;
    // A unit normal's components may be rounded beyond 1, and a negative sample counts as a fault.
    if (kIntegrator == kIntegratorNormals) path.radiance = max(0.5 * surface.shading + 0.5, 0.0);
    if (kIntegrator == kIntegratorAlbedo) path.radiance = albedo;
    if (kIntegrator == kIntegratorDepth)
        path.radiance = vec3(dot(surface.position - render.cameraPosition.xyz, render.cameraForward.xyz));
    if (kIntegrator == kIntegratorAmbient) {
        uvec4 random = randomBlock(2u);
        float cosine;
        path.shadowDirection = lambertianSample(surface.shading, vec2(unitReal(random.x), unitReal(random.y)), cosine);
        path.shadowRadiance = vec3(1.0);
        path.shadowPrimitive = kNone;
        path.ending = kEnds;
        if (dot(path.shadowDirection, surface.facing) > 0.0) {
            path.phase = kPhaseShadow;
            beginTraversalTo(render.methods.w);
        } else {
            recordEvent(kSignatureNoRay);
        }
    }
}

// Prepares the light samples at a surface, and the ray that leaves it.
void shadeBounce(Surface surface, vec3 baseColor, out ShadingPoint point) {
    point = ShadingPoint(surface.facing, surface.shading, path.throughput * lambertianEval(baseColor));
    path.ending = scatter(surface, baseColor);
    bool lit = kLights != kLightsNone && render.depthLights.w > 0u && countsBounce(path.depth);
    if (lit) {
        path.phase = kPhaseLights;
        path.lightsLeft = kLightLoop ? render.lightSamples.x : 1u;
    } else {
        goOnOrEnd();
    }
}

void shadeHit(RayTransform transform, inout ShadingPoint point) {
    Surface surface = surfaceAt(path.traversal.primitive, path.ray, transform, path.traversal.distance, kSpheres);
    recordEvent(surface.id);
    if (surface.material >= render.sceneCounts.z) film.faults.z += 1u;
    MaterialRecord material = readMaterial(render.tableOffsets.x, min(surface.material, render.sceneCounts.z - 1u));
    if (path.depth == 0u) {
        film.mean.w += 1.0;
        if (kAovs) recordFirstHit(surface, material.baseColor.xyz);
    }
    if (kIntegrator == kIntegratorPath) addEmission(surface, material, path.traversal.distance);
    if (kIntegrator == kIntegratorPath && path.depth >= render.depthLights.x) {
        path.phase = kPhaseEnded;
    } else {
        path.leaves = surface.planar ? path.traversal.primitive : kNone;
        path.ray.origin = offsetOrigin(surface.position, surface.error, surface.facing);
        if (kIntegrator == kIntegratorPath) {
            shadeBounce(surface, material.baseColor.xyz, point);
        } else {
            shadeFirstHit(surface, material.baseColor.xyz);
        }
    }
}

// What follows a light sample whose shadow ray, if it needed one, is answered.
void finishLightSample() {
    if (kLightLoop && path.lightsLeft > 0u) {
        path.phase = kPhaseLights;
    } else {
        goOnOrEnd();
    }
}

void takeLightSample(ShadingPoint point) {
    uint index = kLightLoop ? render.lightSamples.x - path.lightsLeft : 0u;
    --path.lightsLeft;
    float limit = sampleDirect(point, index);
    if (limit > 0.0) {
        path.phase = kPhaseShadow;
        beginTraversalTo(limit);
    } else {
        finishLightSample();
    }
}

void finishShadow() {
    bool reached = path.traversal.primitive == kNone;
    recordEvent(reached ? kSignatureReached : kSignatureOccluded);
    if (reached) path.radiance += path.shadowRadiance;
    finishLightSample();
}

// The pending shadow ray and then the ray to the nearest hit, or as much of them as the budget allows. Whether that hit, or
// that there is none, is found. A loop with little in it: drivers without branches run all of its body for every ray.
bool traceRays(inout uint budget, out RayTransform transform) {
    bool found = false;
    while (!found && path.phase <= kPhaseShadow && budget > 0u) {
        --budget;
        bool shadow = path.phase == kPhaseShadow;
        Query query;
        query.ray = Ray(path.ray.origin, shadow ? path.shadowDirection : path.ray.direction);
        query.kind = shadow ? kAnyHit : kNearestHit;
        query.ignored = path.leaves;
        query.alsoIgnored = shadow ? path.shadowPrimitive : kNone;
        transform = transformFor(query.ray);
        traverse(query, transform, path.traversal, budget, film.faults.y);
        if (path.traversal.stackCount == 0u) {
            film.counts.y += 1u;
            found = !shadow;
            if (shadow) finishShadow();
        }
    }
    return found;
}

// One bounce, or one light sample, or as much of it as the budget allows. Functions on this way leave at their ends only:
// Mesa turns an early return into a loop of one iteration, which would count against its limit.
void advance(inout uint budget) {
    RayTransform transform;
    ShadingPoint point; // lives on in the path only if there is another sample to take
    if (kLightLoop) point = path.point;
    if (traceRays(budget, transform)) {
        if (path.traversal.primitive == kNone) {
            recordEvent(kNone);
            addEnvironment();
            path.phase = kPhaseEnded;
        } else {
            shadeHit(transform, point);
        }
    }
    if (kLightLoop) path.point = point;
    if (path.phase == kPhaseLights) takeLightSample(point);
    if (path.phase == kPhaseEnded) endSample();
}

void startOrResume(uint lane) {
    if (parameters.batch.w != 0u) {
        film = FilmRecord(vec4(0.0), vec4(0.0), uvec4(0u), uvec4(0u), uvec4(0u));
        if (kAovs) clearAovs();
        path.sampleIndex = 0u;
        beginSample();
    } else {
        loadPath(lane);
        film = films[lane];
    }
}

// In 64 bits: without a BVH a batch of long paths tests more primitives than 32 can count.
void addTests() {
    uvec2 carry;
    film.tests.xy = uaddCarry(film.tests.xy, traversalTests, carry);
    film.tests.zw += carry;
}

void main() {
    uint lane = gl_GlobalInvocationID.x;
    bool works = lane < parameters.lanes.x && (parameters.batch.w != 0u || paths[lane].progress.x != kPhaseDone);
    if (works) {
        pixel = uvec2(pixels[lane] & 0xFFFFu, pixels[lane] >> 16);
        startOrResume(lane);
        uint budget = parameters.batch.z;
        while (budget > 0u && path.phase != kPhaseDone) {
            --budget;
            advance(budget);
        }
        storePath(lane);
        if (kTraversalCounts) addTests();
        films[lane] = film;
        if (path.phase == kPhaseDone) atomicAdd(completion.finishedLanes.x, 1u);
    }
}
