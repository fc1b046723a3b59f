// What a lane of the path kernel works on: the kernel's buffers, the path in registers, and how it is kept between dispatches.
#ifndef ISOLUX_KERNELS_PATH_STATE_GLSL
#define ISOLUX_KERNELS_PATH_STATE_GLSL

#include "kernels/scene_bindings.glsl"
#include "geometry/traverse.glsl"
#include "material/bsdf.glsl"
#include "shared/path_records.h"

layout(constant_id = 17) const bool kLightLoop = false; // several light samples a shading point

layout(set = 0, binding = 8, std140) readonly buffer RenderBuffer { RenderParameters render; };
layout(set = 0, binding = 9, std430) buffer PathBuffer { PathRecord paths[]; };
layout(set = 0, binding = 10, std430) buffer FilmBuffer { FilmRecord films[]; };
layout(set = 0, binding = 11, std430) buffer StackBuffer { uvec2 stacks[]; };
layout(set = 0, binding = 12, std430) buffer CompletionBuffer { CompletionRecord completion; };
layout(set = 0, binding = 15, std430) buffer AovBuffer { AovRecord aovs[]; };
layout(set = 0, binding = 16, std430) readonly buffer PixelBuffer { uint pixels[]; };
layout(set = 0, binding = 17, std430) writeonly buffer SampleBuffer { SampleRecord samples[]; };
layout(push_constant) uniform Parameters { DispatchParameters parameters; };

// A point whose lights are being sampled.
struct ShadingPoint {
    vec3 facing;
    vec3 shading;
    vec3 reflected;  // the path's throughput there times the diffuse lobe's f
    vec3 outgoing;   // to where the path came from
    vec3 throughput; // the path's
    Bsdf bsdf;
};

// A path in registers: PathRecord by names.
struct Path {
    uint phase;
    uint sampleIndex; // within the batch
    uint depth;
    uint ending; // kGoesOn, kEnds, kEndsByRoulette: what follows the pending shadow ray; above, the lobe that scattered
    Ray ray;     // the next ray to the nearest hit; its origin is the shadow ray's too
    uint leaves; // flat primitive it starts from, or kNone
    float pdf;   // of its direction, in solid angle
    vec3 throughput;
    vec3 radiance;
    uint signature;
    vec3 shadowDirection;
    uint shadowPrimitive;
    vec3 shadowRadiance;
    uint lightsLeft; // light samples still to be taken at the point below
    ShadingPoint point;
    float radianceScale; // what refractions have divided the throughput by
    uint medium;         // material of the solid that the ray is in, or kNone
    uint mediumBeyond;   // of what lies behind the surface of a shading point
    vec3 beyond;         // where rays start that go there
    bool shadowBeyond;   // the shadow ray is one of them
    uint primitive;      // that the shading point is on
    Traversal traversal;
};

uvec2 pixel;
FilmRecord film;
Path path;

void loadPoint(PathRecord record) {
    path.point.facing = record.pointFacing.xyz;
    path.point.shading = record.pointShading.xyz;
    path.point.reflected = record.pointReflected.xyz;
    if (!kLambertianOnly) {
        path.point.outgoing = record.pointOutgoing.xyz;
        path.point.throughput = record.pointThroughput.xyz;
        vec3 f90 = vec3(record.pointShading.w, record.pointReflected.w, uintBitsToFloat(record.pointMedia.y));
        path.point.bsdf = Bsdf(vec3(0.0), record.pointF0.xyz, f90, record.pointTint.xyz, record.pointOutgoing.w,
                               record.pointThroughput.w, record.pointF0.w, record.pointFacing.w, record.pointTint.w,
                               record.pointMedia.x);
    }
}

void storePoint(uint lane) {
    ShadingPoint point = path.point;
    paths[lane].pointFacing = vec4(point.facing, point.bsdf.alpha);
    paths[lane].pointShading = vec4(point.shading, point.bsdf.f90.x);
    paths[lane].pointReflected = vec4(point.reflected, point.bsdf.f90.y);
    if (!kLambertianOnly) {
        paths[lane].pointOutgoing = vec4(point.outgoing, point.bsdf.specular);
        paths[lane].pointThroughput = vec4(point.throughput, point.bsdf.glass);
        paths[lane].pointF0 = vec4(point.bsdf.f0, point.bsdf.gain);
        paths[lane].pointTint = vec4(point.bsdf.tint, point.bsdf.eta);
        paths[lane].pointMedia.xy = uvec2(point.bsdf.kind, floatBitsToUint(point.bsdf.f90.z));
    }
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
    path.traversal = Traversal(record.directionDistance.w, record.progress.z, idOf(record.progress.z), record.progress.w);
    path.lightsLeft = record.bounce.w;
    path.radianceScale = record.throughput.w;
    path.medium = floatBitsToUint(record.radiance.w);
    if (kGlass) {
        path.mediumBeyond = record.pointMedia.z;
        path.beyond = record.pointBeyond.xyz;
        path.shadowBeyond = record.ignored.z != 0u;
        path.primitive = record.ignored.w;
    }
    if (kLightLoop) loadPoint(record);
    uint entries = kEveryPrimitive ? 0u : path.traversal.stackCount;
    for (uint i = 0u; i < entries; ++i) {
        uvec2 entry = stacks[lane * kStackSize + i];
        stackItems[i] = entry.x;
        stackEntries[i] = uintBitsToFloat(entry.y);
    }
}

void storePath(uint lane) {
    paths[lane].originPdf = vec4(path.ray.origin, path.pdf);
    paths[lane].directionDistance = vec4(path.ray.direction, path.traversal.distance);
    paths[lane].throughput = vec4(path.throughput, path.radianceScale);
    paths[lane].radiance = vec4(path.radiance, uintBitsToFloat(path.medium));
    paths[lane].shadowDirection = vec4(path.shadowDirection, 0.0);
    paths[lane].shadowRadiance = vec4(path.shadowRadiance, 0.0);
    paths[lane].progress = uvec4(path.phase, path.sampleIndex, path.traversal.primitive, path.traversal.stackCount);
    paths[lane].bounce = uvec4(path.depth, path.ending, path.signature, path.lightsLeft);
    paths[lane].ignored = uvec4(path.leaves, path.shadowPrimitive, kGlass && path.shadowBeyond ? 1u : 0u,
                                kGlass ? path.primitive : 0u);
    if (kGlass) {
        paths[lane].pointMedia.z = path.mediumBeyond;
        paths[lane].pointBeyond = vec4(path.beyond, 0.0);
    }
    if (kLightLoop) storePoint(lane);
    uint entries = kEveryPrimitive || path.phase == kPhaseDone ? 0u : path.traversal.stackCount;
    for (uint i = 0u; i < entries; ++i)
        stacks[lane * kStackSize + i] = uvec2(stackItems[i], floatBitsToUint(stackEntries[i]));
}

#endif
