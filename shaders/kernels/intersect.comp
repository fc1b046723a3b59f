// Nearest hits of a list of rays, by the BVH or by testing every primitive: for tests and benchmarks of traversal.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/scene_bindings.glsl"
#include "geometry/traverse.glsl"
#include "shared/ray_records.h"

layout(constant_id = 8) const bool kBruteForce = false;

layout(set = 0, binding = 13, std430) readonly buffer RayBuffer { RayRecord rays[]; };
layout(set = 0, binding = 14, std430) buffer HitBuffer { HitRecord hits[]; };
layout(push_constant) uniform Parameters { IntersectParameters parameters; };

// Intersections alone are asked for: every surface is there.
bool surfaceIsThere(PrimitiveRecord primitive, uint index, vec3 barycentric, uint key) { return true; }

void trace(uint index) {
    RayRecord record = rays[index];
    Query query = Query(Ray(record.originDistance.xyz, record.direction.xyz), kNearestHit, 0u, kNone, planeOf(kNone), kNone);
    RayTransform transform = transformFor(query.ray);
    Traversal state = beginTraversal(record.originDistance.w, 1u, 0u);
    uint overflows = 0u;
    if (kBruteForce) {
        // In chunks of primitives: what earlier chunks found is in the buffer.
        if (parameters.range.z > 0u) {
            state.distance = hits[index].distance.x;
            state.primitive = hits[index].primitive.x;
            state.id = idOf(state.primitive);
        }
        for (uint i = parameters.range.z; i < parameters.range.w; ++i) testPrimitive(i, query, transform, state);
        state.stackCount = 0u;
    } else {
        uint budget = 7000u;
        traverse(query, transform, state, budget, overflows);
    }
    hits[index].distance = vec4(state.distance, 0.0, 0.0, 0.0);
    hits[index].primitive = uvec4(state.primitive, state.stackCount == 0u && overflows == 0u ? 1u : 0u, 0u, 0u);
}

void main() {
    uint index = parameters.range.x + gl_GlobalInvocationID.x;
    if (index < parameters.range.y) trace(index);
}
