// Path tracing: light sampling, scattering, Russian roulette. A lane works through one pixel's batch of samples; a dispatch
// gives it a budget of steps, and what is unfinished is stored and resumed.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/path_shading.glsl"
#include "core/sample_sequence.glsl"
#include "film/accumulate.glsl"
#include "geometry/camera.glsl"

layout(constant_id = 7) const bool kPathSignatures = false;
layout(constant_id = 12) const bool kAovs = false;
layout(constant_id = 13) const uint kSampler = kSamplerIndependent;
layout(constant_id = 14) const uint kIntegrator = kIntegratorPath;
layout(constant_id = 19) const bool kBounceRange = false;
layout(constant_id = 25) const bool kKeepSamples = false;

SampleIndex sampleIndex() {
    return SampleIndex(render.imageSeed.zw, pixel, parameters.batch.x + path.sampleIndex, render.sampling.y);
}

uvec4 randomBlock(uint block) {
    SampleIndex index = sampleIndex();
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
    path.point = ShadingPoint(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), lambertianBsdf(vec3(0.0)));
    path.radianceScale = 1.0;
    path.medium = kNone;
    path.mediumBeyond = kNone;
    path.beyond = vec3(0.0);
    path.shadowBeyond = false;
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

void addEmission(Surface surface, MaterialRecord material, MapPoint at) {
    vec3 emission = material.emissionFlags.xyz;
    bool emits = surface.front || (floatBitsToUint(material.emissionFlags.w) & kMaterialTwoSided) != 0u;
    if (emission != vec3(0.0) && emits && countsBounce(path.depth)) {
        if (kEmissionMaps) emission *= emissionMapAt(material, at);
        float weight = 1.0;
        if (kAreaLights && kLights != kLightsNone && path.pdf > 0.0 && surface.light != kNone) {
            LightRecord light = readLight(render.tableOffsets.y, surface.light);
            float cosine = abs(dot(path.ray.direction, surface.facing));
            weight = scatteringWeight(path.pdf, areaLightPdf(light, path.ray.origin, path.traversal.distance, cosine));
        }
        path.radiance += path.throughput * emission * weight;
    }
}

// What a ray that meets nothing sees.
void addEnvironment() {
    if (kEnvironment && path.ray.direction.y > render.environmentLimits.x) {
        vec3 radiance = render.environment.xyz;
        float ofLight = render.environment.w;
        if (kEnvironmentMap && render.environmentMap.z > 0u) {
            EnvironmentMap map = environmentMap();
            vec2 coordinates = mapCoordinates(map, path.ray.direction);
            radiance *= mapRadiance(map, coordinates);
            ofLight *= mapPdf(map, coordinates);
        }
        bool onlyWay = path.pdf == 0.0 || render.environment.w == 0.0;
        float weight = onlyWay ? 1.0 : scatteringWeight(path.pdf, ofLight);
        if (countsBounce(path.depth)) path.radiance += path.throughput * radiance * weight;
        if (path.depth == 0u && maxComponent(radiance) > 0.0) film.mean.w += 1.0;
    }
}

// How far a point lies before the camera along its axis.
float depthOf(vec3 point) {
    return render.cameraForward.w + dot(point - render.cameraPosition.xyz, render.cameraForward.xyz);
}

// The sample's part of the AOVs, which are in the buffer alone: a camera ray meets a surface once a sample.
void recordFirstHit(Surface surface, vec3 albedo) {
    uint lane = gl_GlobalInvocationID.x;
    float depth = depthOf(surface.position);
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

void goOnOrEnd() {
    uint ending = path.ending & kEndingMask;
    uint lobe = path.ending >> kLobeShift;
    if (!kLambertianOnly && lobe != 0u && ending != kEnds) recordEvent(lobe);
    if (ending == kGoesOn) {
        if (kGlass && (path.ending & kCrossesBit) != 0u) {
            path.ray.origin = path.beyond;
            path.medium = path.mediumBeyond;
        }
        beginNearest();
    } else {
        if (ending == kEndsByRoulette) recordEvent(kSignatureRoulette);
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
        path.radiance = vec3(depthOf(surface.position));
    if (kIntegrator == kIntegratorAmbient) {
        uvec4 random = randomBlock(2u);
        float cosine;
        path.shadowDirection = lambertianSample(surface.shading, vec2(unitReal(random.x), unitReal(random.y)), cosine);
        path.shadowRadiance = vec3(1.0);
        path.shadowPrimitive = kNone;
        path.ending = kEnds;
        if (kGlass) path.shadowBeyond = false;
        if (dot(path.shadowDirection, surface.facing) > 0.0) {
            path.phase = kPhaseShadow;
            beginTraversalTo(render.methods.w);
        } else {
            recordEvent(kSignatureNoRay);
        }
    }
}

// Prepares the light samples at a surface, and the ray that leaves it.
void shadeBounce(Surface surface, Bsdf bsdf, out ShadingPoint point) {
    point.facing = surface.facing;
    point.shading = surface.shading;
    point.reflected = path.throughput * lambertianEval(bsdf.diffuse);
    point.outgoing = -path.ray.direction;
    point.throughput = path.throughput;
    point.bsdf = bsdf;
    path.ending = scatter(surface, bsdf);
    bool lit = kLights != kLightsNone && render.depthLights.w > 0u && countsBounce(path.depth);
    if (!kLambertianOnly) lit = lit && scattersBroadly(bsdf);
    if (lit) {
        path.phase = kPhaseLights;
        path.lightsLeft = kLightLoop ? render.lightSamples.x : 1u;
    } else {
        goOnOrEnd();
    }
}

// The hit point's two sides: where rays start, and the solids they are in.
void leaveSurface(Surface surface, Bsdf bsdf) {
    path.leaves = surface.planar ? path.traversal.primitive : kNone;
    path.ray.origin = offsetOrigin(surface.position, surface.error, surface.facing);
    if (kGlass) {
        path.beyond = offsetOrigin(surface.position, surface.error, -surface.facing);
        path.primitive = path.traversal.primitive;
        bool solid = kSolids && (bsdf.kind & kSolid) != 0u;
        path.mediumBeyond = !solid ? path.medium : (surface.front ? surface.material : kNone);
    }
}

// What solids absorb on the way to a hit.
void absorb(Surface surface, Bsdf bsdf) {
    if ((bsdf.kind & (kSolid | kInside)) == (kSolid | kInside)) path.medium = surface.material;
    if (path.medium != kNone) path.throughput *= transmittance(path.medium, path.traversal.distance);
}

void shadeHit(RayTransform transform, inout ShadingPoint point) {
    Surface surface = surfaceAt(path.traversal.primitive, path.ray, transform, path.traversal.distance,
                                render.attributeOffsets.x, kSpheres);
    recordEvent(surface.id);
    if (surface.material >= render.sceneCounts.z) film.faults.z += 1u;
    surface.material = min(surface.material, render.sceneCounts.z - 1u);
    MaterialRecord material = readMaterial(render.tableOffsets.x, surface.material);
    MapPoint at = mapPoint(path.traversal.primitive, surface.planar, surface.barycentric);
    if (kNormalMaps && surface.planar && material.maps.z != kNone)
        surface.shading = mappedNormal(surface, material, at);
    vec3 base = baseColorAt(material, at).rgb;
    if (path.depth == 0u) {
        film.mean.w += 1.0;
        if (kAovs) recordFirstHit(surface, base);
    }
    float cosine = abs(dot(path.ray.direction, surface.shading));
    Bsdf bsdf = bsdfAt(material, at, base, cosine, surface.front);
    bool ends = false;
    if (kIntegrator == kIntegratorPath) {
        if (kSolids && kAbsorption) absorb(surface, bsdf);
        addEmission(surface, material, at);
        ends = path.depth >= render.depthLights.x;
        if (kUnlit && (floatBitsToUint(material.emissionFlags.w) & kMaterialUnlit) != 0u) {
            if (countsBounce(path.depth)) path.radiance += path.throughput * base * render.environmentLimits.z;
            ends = true;
        }
    }
    if (ends) {
        path.phase = kPhaseEnded;
    } else {
        leaveSurface(surface, bsdf);
        if (kIntegrator == kIntegratorPath) {
            shadeBounce(surface, bsdf, point);
        } else {
            shadeFirstHit(surface, base);
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

// The key of alpha for the ray that is followed now.
uint alphaKey(bool shadow) {
    uint index = kLightLoop ? render.lightSamples.x - path.lightsLeft - 1u : 0u;
    uint ofShadow = kIntegrator == kIntegratorAmbient ? 1u : blockOfLightSample(index);
    uint block = shadow ? ofShadow : 2u * path.depth;
    return independentBlock(sampleIndex(), kAlphaBlocks ^ block).x;
}

// The pending shadow ray and then the ray to the nearest hit, or as much of them as the budget allows. Whether that hit, or
// that there is none, is found. A loop with little in it: drivers without branches run all of its body for every ray.
bool traceRays(inout uint budget, out RayTransform transform) {
    bool found = false;
    while (!found && path.phase <= kPhaseShadow && budget > 0u) {
        --budget;
        bool shadow = path.phase == kPhaseShadow;
        Query query;
        vec3 origin = kGlass && shadow && path.shadowBeyond ? path.beyond : path.ray.origin;
        query.ray = Ray(origin, shadow ? path.shadowDirection : path.ray.direction);
        query.kind = shadow ? kAnyHit : kNearestHit;
        query.alphaKey = kAlphaBlend ? alphaKey(shadow) : 0u;
        query.ignored = path.leaves;
        query.plane = planeOf(kCoincident ? path.leaves : kNone);
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
    budget -= min(budget, mapIterations());
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
