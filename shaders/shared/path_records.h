// What a path keeps between dispatches, what it leaves on the film, and the parameters of a render and of a dispatch.
#ifndef ISOLUX_SHARED_PATH_RECORDS_H
#define ISOLUX_SHARED_PATH_RECORDS_H

#include "shared/types.h"

ISOLUX_SHARED_BEGIN

// One lane's path: all that is needed to go on where the last dispatch stopped, also in the middle of a traversal.
struct PathRecord {
    vec4 originPdf;         // origin of the next ray; w: pdf of its direction (solid angle)
    vec4 directionDistance; // its direction; w: nearest distance found so far by an unfinished traversal
    vec4 throughput;        // w: product of the relative indices of refraction squared, which radiance was divided by
    vec4 radiance;          // w: material of the solid the path is in, or kNone, as bits
    vec4 shadowDirection;   // from the origin to the light's point, or towards a light at infinity; w unused
    vec4 shadowRadiance;    // what arrives if nothing is in between; w unused
    vec4 pointFacing;       // the point whose lights are being sampled, if there are several samples: ShadingPoint
    vec4 pointShading;
    vec4 pointReflected;
    vec4 pointOutgoing;
    vec4 pointThroughput;
    vec4 pointF0;
    vec4 pointTint;
    vec4 pointBeyond;
    uvec4 pointMedia;
    uvec4 progress; // phase, sample within the batch, nearest primitive found so far, entries on the stack
    uvec4 bounce;   // bounces so far, ending and lobe, path signature, light samples still to be taken
    uvec4 ignored;  // flat primitive the ray leaves, light the shadow ray ends at (kNone: neither); whether the
                    // shadow ray starts on the far side, primitive of the shading point
};
ISOLUX_CHECK_SIZE(PathRecord, 288);

// Statistics of one batch of samples of one pixel.
struct FilmRecord {
    vec4 mean;             // rgb; w: samples whose camera ray met a surface or saw the environment
    vec4 squaredDeviation; // rgb, luminance
    uvec4 counts;          // samples, rays, sum of path signatures, samples that were NaN or infinite
    uvec4 faults;          // negative samples, stack overflows, invalid indices; w unused
    uvec4 tests;           // boxes and primitives that rays were tested against, if counted; z, w: upper words
};
ISOLUX_CHECK_SIZE(FilmRecord, 80);

ISOLUX_CONSTANT uint kBatchSamples = 16u; // at most

// What the camera rays of a batch met first. Sums over the samples that met a surface.
struct AovRecord {
    vec4 albedoDepth;     // w: depth along the camera's axis, in device space
    vec4 normal;          // w unused
    uvec4 primitiveId[4]; // of each sample, or kNone
};
ISOLUX_CHECK_SIZE(AovRecord, 96);

// The radiance of each sample of a batch, where the host needs them one by one.
struct SampleRecord {
    vec4 radiance[kBatchSamples]; // w unused
};
ISOLUX_CHECK_SIZE(SampleRecord, 256);

// Constant over a render.
struct RenderParameters {
    vec4 cameraPosition; // device space: where the axis meets the plane that rays start on; w: 1 for an orthographic
                         // camera, else 0
    vec4 cameraRight;    // to the image's right edge: for a perspective camera at unit distance
    vec4 cameraUp;       // to its top edge
    vec4 cameraForward;  // unit; w: how far that plane lies before the camera
    vec4 lensRight;      // unit, as cameraRight and cameraUp are not
    vec4 lensUp;
    vec4 environment;       // radiance; w: pdf of light sampling in its directions, 0 if that never chooses it
    vec4 environmentLimits; // x: it emits from directions with y above this alone; y: rotation of the map in turns,
                            // z: device radiance over that of the world
    uvec4 environmentMap;   // first word of its texels and of the bins of its cells, width, height
    uvec4 imageSeed;        // width, height, seed low, seed high
    vec4 methods;      // radius of the lens, 1/focus distance, roulette's constant survival, reach of ambient occluders
    uvec4 depthLights; // last bounce, roulette start, bits of the alias table, number of lights
    uvec4
        lightSamples; // samples a shading point; with kSpecAllLights: of each area light, area lights, punctual lights
    uvec4 tableOffsets;     // first word of materials, lights, light bins, filter quantiles in the tables buffer
    uvec4 textureOffsets;   // of texture records, of the decoding of 8-bit and of 16-bit sRGB, of albedo tables
    uvec4 attributeOffsets; // of normals, tangents, colours, texture coordinates in the attributes buffer
    uvec4 sceneCounts;      // nodes, primitives, materials; w unused
    uvec4 sampling; // x: first bounce that counts, y: cell bits of the sampler, z: bits of the environment's cells; w
                    // unused
};
ISOLUX_CHECK_SIZE(RenderParameters, 288);

// Changes with every dispatch.
struct DispatchParameters {
    uvec4 batch; // first sample, samples, step budget, 1 if the paths are to be started afresh
    uvec4 lanes; // x: pixels in the list; others unused
};
ISOLUX_CHECK_SIZE(DispatchParameters, 32);

// How many lanes have finished their batch; the host compares it with the number of lanes.
struct CompletionRecord {
    uvec4 finishedLanes; // x; others unused
};
ISOLUX_CHECK_SIZE(CompletionRecord, 16);

// PathRecord.progress.x
ISOLUX_CONSTANT uint kPhaseNearest = 0u; // the next ray looks for the nearest hit
ISOLUX_CONSTANT uint kPhaseShadow = 1u;  // the next ray asks whether the light is seen
ISOLUX_CONSTANT uint kPhaseLights = 2u;  // a light is to be sampled
ISOLUX_CONSTANT uint kPhaseEnded = 3u;   // the sample is complete; never stored
ISOLUX_CONSTANT uint kPhaseDone = 4u;    // all samples of the batch are on the film

// PathRecord.bounce.y: what follows the pending shadow ray
ISOLUX_CONSTANT uint kGoesOn = 0u;
ISOLUX_CONSTANT uint kEnds = 1u;
ISOLUX_CONSTANT uint kEndsByRoulette = 2u;
ISOLUX_CONSTANT uint kEndingMask = 3u;
ISOLUX_CONSTANT uint kCrossesBit = 4u; // the next ray leaves on the far side of the surface
ISOLUX_CONSTANT uint kLobeShift = 3u;  // above it: kLobe..., or 0 on a Lambertian surface

ISOLUX_CONSTANT uint kSignatureStart = 2166136261u;
ISOLUX_CONSTANT uint kSignatureFactor = 16777619u;
ISOLUX_CONSTANT uint kSignatureOccluded = 0u;
ISOLUX_CONSTANT uint kSignatureReached = 1u;
ISOLUX_CONSTANT uint kSignatureNoRay = 2u;
ISOLUX_CONSTANT uint kSignatureRoulette = 3u;

// Which lobe scattered; a word of the signature too.
ISOLUX_CONSTANT uint kLobeDiffuse = 4u;
ISOLUX_CONSTANT uint kLobeSpecular = 5u;
ISOLUX_CONSTANT uint kLobeGlassReflects = 6u;
ISOLUX_CONSTANT uint kLobeGlassTransmits = 7u;

ISOLUX_SHARED_END

#endif
