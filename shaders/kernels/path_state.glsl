// What a lane of the path kernel works on: the kernel's buffers, the path in registers, and how it is kept between dispatches.
#ifndef ISOLUX_KERNELS_PATH_STATE_GLSL
#define ISOLUX_KERNELS_PATH_STATE_GLSL

#include "kernels/scene_bindings.glsl"
#include "geometry/traverse.glsl"
#include "shared/path_records.h"

layout(constant_id = 17) const bool kLightLoop = false; // several light samples a shading point

layout(set = 0, binding = 8, std140) uniform RenderBuffer { RenderParameters render; };
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
    vec3 reflected; // the path's throughput there times the reflectance
};

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
    uint lightsLeft; // light samples still to be taken at the point below
    ShadingPoint point;
    Traversal traversal;
};

uvec2 pixel;
FilmRecord film;
Path path;

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
    path.lightsLeft = record.bounce.w;
    if (kLightLoop)
        path.point = ShadingPoint(record.pointFacing.xyz, record.pointShading.xyz, record.pointReflected.xyz);
    uint entries = kEveryPrimitive ? 0u : path.traversal.stackCount;
    for (uint i = 0u; i < entries; ++i) {
        uvec2 entry = stacks[lane * kStackSize + i];
        stackItems[i] = entry.x;
        stackEntries[i] = uintBitsToFloat(entry.y);
    }
}

void storePath(uint lane) {
    paths[lane] = PathRecord(vec4(path.ray.origin, path.pdf), vec4(path.ray.direction, path.traversal.distance),
                             vec4(path.throughput, 0.0), vec4(path.radiance, 0.0), vec4(path.shadowDirection, 0.0),
                             vec4(path.shadowRadiance, 0.0), vec4(path.point.facing, 0.0),
                             vec4(path.point.shading, 0.0), vec4(path.point.reflected, 0.0),
                             uvec4(path.phase, path.sampleIndex, path.traversal.primitive, path.traversal.stackCount),
                             uvec4(path.depth, path.ending, path.signature, path.lightsLeft),
                             uvec4(path.leaves, path.shadowPrimitive, 0u, 0u));
    uint entries = kEveryPrimitive || path.phase == kPhaseDone ? 0u : path.traversal.stackCount;
    for (uint i = 0u; i < entries; ++i)
        stacks[lane * kStackSize + i] = uvec2(stackItems[i], floatBitsToUint(stackEntries[i]));
}

#endif
