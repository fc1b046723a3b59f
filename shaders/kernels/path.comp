// Path tracing with next-event estimation, multiple importance sampling and Russian roulette. A lane works through one
// pixel's batch of samples; a dispatch gives it a budget of steps, and what is unfinished is stored and resumed.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/scene_bindings.glsl"
#include "core/philox.glsl"
#include "film/accumulate.glsl"
#include "geometry/surface.glsl"
#include "geometry/traverse.glsl"
#include "light/light.glsl"
#include "material/lambertian.glsl"
#include "shared/path_records.h"

layout(constant_id = 6) const bool kRoulette = true;
layout(constant_id = 7) const bool kPathSignatures = false;
layout(constant_id = 12) const bool kAovs = false;

layout(set = 0, binding = 8, std140) uniform RenderBuffer { RenderParameters render; };
layout(set = 0, binding = 9, std430) buffer PathBuffer { PathRecord paths[]; };
layout(set = 0, binding = 10, std430) buffer FilmBuffer { FilmRecord films[]; };
layout(set = 0, binding = 11, std430) buffer StackBuffer { uvec2 stacks[]; };
layout(set = 0, binding = 12, std430) buffer CompletionBuffer { CompletionRecord completion; };
layout(set = 0, binding = 15, std430) buffer AovBuffer { AovRecord aovs[]; };
layout(push_constant) uniform Parameters { DispatchParameters parameters; };

const float kMaxSurvival = 1.0 - 1.0 / 1024.0; // host/scene/render_settings.h

// A path in registers: PathRecord by names.
struct Path {
    uint phase;
    uint sampleIndex; // within the batch
    uint depth;
    uint ending; // kGoesOn, kEnds, kEndsByRoulette: what follows the pending shadow ray
    Ray ray;     // the next ray to the nearest hit; its origin is the shadow ray's too
    uint leaves; // flat primitive it starts from, or kNone
    float pdf;   // of its direction, in solid angle
    vec3 throughput;
    vec3 radiance;
    uint signature;
    vec3 shadowDirection;
    uint shadowPrimitive;
    vec3 shadowRadiance;
    Traversal traversal;
};

uvec2 pixel;
FilmRecord film;
Path path;

// The pixel of a lane: workgroups take 8 x 8 blocks of the tile, so that neighbouring lanes see similar paths.
uvec2 pixelOfLane(uint lane) {
    uint blocksPerRow = (parameters.tile.z + 7u) / 8u;
    uint block = lane / 64u;
    uint within = lane % 64u;
    return uvec2((block % blocksPerRow) * 8u + within % 8u, (block / blocksPerRow) * 8u + within / 8u);
}

uvec4 randomBlock(uint block) {
    return philox4x32(uvec4(pixel, parameters.batch.x + path.sampleIndex, block), render.imageSeed.zw);
}

void recordEvent(uint event) {
    if (kPathSignatures) path.signature = (path.signature ^ event) * kSignatureFactor;
}

void beginNearest() {
    path.phase = kPhaseNearest;
    path.traversal = beginTraversal(kFarthest, render.sceneCounts.x);
}

void beginSample() {
    uvec4 random = randomBlock(0u);
    // 2 (pixel + u) / size - 1, with the whole numbers apart: the sum keeps more of u's bits, all near the centre.
    vec2 whole = vec2(2 * ivec2(pixel) + 1 - ivec2(render.imageSeed.xy));
    vec2 within = 2.0 * vec2(unitReal(random.x), unitReal(random.y)) - 1.0;
    vec2 position = (whole + within) / vec2(render.imageSeed.xy);
    vec3 across = position.x * render.cameraRight.xyz - position.y * render.cameraUp.xyz;
    bool orthographic = render.cameraPosition.w != 0.0;
    path.ray.direction = orthographic ? render.cameraForward.xyz : normalize(across + render.cameraForward.xyz);
    path.ray.origin = render.cameraPosition.xyz + (orthographic ? across : vec3(0.0));
    path.leaves = kNone;
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
    film.counts.z += path.signature;
    ++path.sampleIndex;
    if (path.sampleIndex == parameters.batch.y) {
        path.phase = kPhaseDone;
    } else {
        beginSample();
    }
}

void addEmission(Surface surface, MaterialRecord material, float distance) {
    vec3 emission = material.emission.xyz;
    if (emission != vec3(0.0) && (surface.front || material.emission.w != 0.0)) {
        float weight = 1.0;
        if (kAreaLights && kLights != kLightsNone && path.depth > 0u && surface.light != kNone) {
            LightRecord light = readLight(render.tableOffsets.y, surface.light);
            float cosine = abs(dot(path.ray.direction, surface.facing));
            weight = powerHeuristic(path.pdf, areaLightPdf(light, path.ray.origin, distance, cosine));
        }
        path.radiance += path.throughput * emission * weight;
    }
}

// What a ray that meets nothing sees.
void addEnvironment() {
    if (kEnvironment && path.ray.direction.y > render.environmentLimits.x) {
        bool onlyWay = path.depth == 0u || render.environment.w == 0.0;
        float weight = onlyWay ? 1.0 : powerHeuristic(path.pdf, render.environment.w);
        path.radiance += path.throughput * render.environment.xyz * weight;
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

// Samples a light and leaves a pending shadow ray in the path if it could contribute. Its limit; 0 without one.
float sampleDirect(Surface surface, vec3 origin, vec3 baseColor) {
    uvec4 random = randomBlock(1u + 2u * path.depth);
    uint chosen = chooseLight(render.tableOffsets.z, render.depthLights.z, random.x, random.y);
    if (chosen >= render.depthLights.w) film.faults.z += 1u;
    uint index = min(chosen, render.depthLights.w - 1u);
    LightSample light = sampleLight(readLight(render.tableOffsets.y, index), origin,
                                    vec2(unitReal(random.z), unitReal(random.w)));
    bool lights = light.pdf > 0.0 && maxComponent(baseColor) > 0.0;
    float cosine = lights ? lambertianCosine(surface.facing, surface.shading, light.direction) : 0.0;
    if (cosine > 0.0) {
        float weight = light.delta ? 1.0 : powerHeuristic(light.pdf, lambertianPdf(cosine));
        path.shadowRadiance = path.throughput * lambertianEval(baseColor) * light.emission * (cosine / light.pdf * weight);
        path.shadowDirection = light.way;
        path.shadowPrimitive = light.primitive;
    } else {
        recordEvent(kSignatureNoRay);
    }
    return cosine > 0.0 ? light.limit : 0.0;
}

// Whether roulette lets the path live; it then stands for those that were ended.
bool survivesRoulette(uint word) {
    float survival = min(maxComponent(path.throughput), kMaxSurvival);
    bool survives = unitReal(word) < survival;
    if (survives) path.throughput /= survival;
    return survives;
}

// Chooses the next direction, unless the path ends here.
uint scatter(Surface surface, vec3 baseColor) {
    uvec4 random = randomBlock(2u + 2u * path.depth);
    float cosine;
    path.ray.direction = lambertianSample(surface.shading, vec2(unitReal(random.x), unitReal(random.y)), cosine);
    path.pdf = lambertianPdf(cosine);
    path.throughput *= baseColor;
    ++path.depth;
    uint ending = kGoesOn;
    if (dot(path.ray.direction, surface.facing) <= 0.0 || maxComponent(path.throughput) <= 0.0) {
        ending = kEnds;
    } else if (kRoulette && path.depth >= render.depthLights.y && !survivesRoulette(random.z)) {
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

void shadeHit(RayTransform transform) {
    Surface surface = surfaceAt(path.traversal.primitive, path.ray, transform, path.traversal.distance, kSpheres);
    recordEvent(surface.id);
    if (surface.material >= render.sceneCounts.z) film.faults.z += 1u;
    MaterialRecord material = readMaterial(render.tableOffsets.x, min(surface.material, render.sceneCounts.z - 1u));
    if (path.depth == 0u) {
        film.mean.w += 1.0;
        if (kAovs) recordFirstHit(surface, material.baseColor.xyz);
    }
    addEmission(surface, material, path.traversal.distance);
    if (path.depth >= render.depthLights.x) {
        path.phase = kPhaseEnded;
    } else {
        vec3 origin = offsetOrigin(surface.position, surface.error, surface.facing);
        bool lit = kLights != kLightsNone && render.depthLights.w > 0u;
        float shadowLimit = lit ? sampleDirect(surface, origin, material.baseColor.xyz) : 0.0;
        path.ending = scatter(surface, material.baseColor.xyz);
        path.ray.origin = origin;
        path.leaves = surface.planar ? path.traversal.primitive : kNone;
        if (shadowLimit > 0.0) {
            path.phase = kPhaseShadow;
            path.traversal = beginTraversal(shadowLimit, render.sceneCounts.x);
        } else {
            goOnOrEnd();
        }
    }
}

void finishShadow() {
    bool reached = path.traversal.primitive == kNone;
    recordEvent(reached ? kSignatureReached : kSignatureOccluded);
    if (reached) path.radiance += path.shadowRadiance;
    goOnOrEnd();
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

// One bounce, or as much of it as the budget allows. Functions on this way leave at their ends only: Mesa turns an early
// return into a loop of one iteration, which would count against its limit.
void advance(inout uint budget) {
    RayTransform transform;
    if (traceRays(budget, transform)) {
        if (path.traversal.primitive == kNone) {
            recordEvent(kNone);
            addEnvironment();
            path.phase = kPhaseEnded;
        } else {
            shadeHit(transform);
        }
    }
    if (path.phase == kPhaseEnded) endSample();
}

void loadPath(uint lane) {
    PathRecord record = paths[lane];
    path.phase = record.progress.x;
    path.sampleIndex = record.progress.y;
    path.depth = record.bounce.x;
    path.ending = record.bounce.y;
    path.signature = record.bounce.z;
    path.ray = Ray(record.originPdf.xyz, record.directionDistance.xyz);
    path.leaves = record.ignored.x;
    path.pdf = record.originPdf.w;
    path.throughput = record.throughput.xyz;
    path.radiance = record.radiance.xyz;
    path.shadowDirection = record.shadowDirection.xyz;
    path.shadowPrimitive = record.ignored.y;
    path.shadowRadiance = record.shadowRadiance.xyz;
    path.traversal = Traversal(record.directionDistance.w, record.progress.z, record.progress.w);
    for (uint i = 0u; i < path.traversal.stackCount; ++i) {
        uvec2 entry = stacks[lane * kStackSize + i];
        stackItems[i] = entry.x;
        stackEntries[i] = uintBitsToFloat(entry.y);
    }
}

void storePath(uint lane) {
    paths[lane] = PathRecord(vec4(path.ray.origin, path.pdf), vec4(path.ray.direction, path.traversal.distance),
                             vec4(path.throughput, 0.0), vec4(path.radiance, 0.0), vec4(path.shadowDirection, 0.0),
                             vec4(path.shadowRadiance, 0.0),
                             uvec4(path.phase, path.sampleIndex, path.traversal.primitive, path.traversal.stackCount),
                             uvec4(path.depth, path.ending, path.signature, 0u),
                             uvec4(path.leaves, path.shadowPrimitive, 0u, 0u));
    uint entries = path.phase == kPhaseDone ? 0u : path.traversal.stackCount;
    for (uint i = 0u; i < entries; ++i)
        stacks[lane * kStackSize + i] = uvec2(stackItems[i], floatBitsToUint(stackEntries[i]));
}

void startOrResume(uint lane) {
    if (parameters.batch.w != 0u) {
        film = FilmRecord(vec4(0.0), vec4(0.0), uvec4(0u), uvec4(0u));
        if (kAovs) clearAovs();
        path.sampleIndex = 0u;
        beginSample();
    } else {
        loadPath(lane);
        film = films[lane];
    }
}

void main() {
    uint lane = gl_GlobalInvocationID.x;
    uvec2 inTile = pixelOfLane(lane);
    pixel = parameters.tile.xy + inTile;
    bool works = all(lessThan(inTile, parameters.tile.zw)) &&
                 (parameters.batch.w != 0u || paths[lane].progress.x != kPhaseDone);
    if (works) {
        startOrResume(lane);
        uint budget = parameters.batch.z;
        while (budget > 0u && path.phase != kPhaseDone) {
            --budget;
            advance(budget);
        }
        storePath(lane);
        films[lane] = film;
        if (path.phase == kPhaseDone) atomicAdd(completion.finishedLanes.x, 1u);
    }
}
