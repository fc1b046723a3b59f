// Walks the quantised four-wide BVH, nearest child first, or every primitive, for a bounded number of steps at a time.
#ifndef ISOLUX_GEOMETRY_TRAVERSE_GLSL
#define ISOLUX_GEOMETRY_TRAVERSE_GLSL

#include "core/scene_access.glsl"
#include "geometry/plane.glsl"
#include "geometry/ray.glsl"
#include "geometry/sphere.glsl"
#include "geometry/triangle.glsl"

layout(constant_id = 2) const uint kStackSize = 64u; // at least WideBvh::stackBound
layout(constant_id = 3) const bool kSpheres = true;
layout(constant_id = 22) const bool kEveryPrimitive = false; // there is no BVH
layout(constant_id = 24) const bool kTraversalCounts = false;
layout(constant_id = 40) const bool kAlphaMask = true;
layout(constant_id = 41) const bool kAlphaBlend = true;
layout(constant_id = 43) const bool kBackFaceCulling = true;
layout(constant_id = 44) const bool kCoincident = true; // triangles at the same spot: some lie in the plane of another

const bool kCutouts = kAlphaMask || kAlphaBlend; // some surfaces are not everywhere there

uint stackItems[kStackSize];    // WideChild bits
float stackEntries[kStackSize]; // distance at which the ray enters the item's box

uvec2 traversalTests = uvec2(0u); // boxes and primitives tested since a kernel last looked

struct Traversal {
    float distance;  // nearest hit so far, or the limit
    uint primitive;  // its primitive, or kNone
    uint id;         // and that primitive's place in scene order: of hits at equal distance the lowest counts; 0 without
    uint stackCount; // entries waiting, or without a BVH primitives; 0: finished
};

// What a ray looks for. For kAnyHit the first hit will do.
const uint kNearestHit = 0u;
const uint kAnyHit = 1u;

struct Query {
    Ray ray;
    uint kind;
    uint alphaKey;    // decides about surfaces that are there by chance
    uint ignored;     // the flat primitive the ray leaves: it cannot be hit again, whatever rounding says
    Plane plane;      // and neither can any other triangle in its plane
    uint alsoIgnored; // the light a shadow ray ends at
};

uint idOf(PrimitiveRecord primitive) { return floatBitsToUint(primitive.p2Id.w) & kIdMask; }

uint idOf(uint primitive) { return primitive == kNone ? 0u : idOf(readPrimitive(primitive)); }

// Whether the surface of a primitive with kAlphaBit is there, at barycentric coordinates of it; the kernel knows.
bool surfaceIsThere(PrimitiveRecord primitive, uint index, vec3 barycentric, uint key);

// Whether a ray meets a primitive's front. A triangle's normal is that of its surface, so that both agree on the side; of a
// sphere the nearer crossing counts, which is on its front for a ray that starts outside.
bool meetsFront(PrimitiveRecord primitive, Ray ray) {
    bool front;
    if (kSpheres && (floatBitsToUint(primitive.p2Id.w) & kSphereBit) != 0u) {
        front = length(ray.origin - primitive.p0Material.xyz) > primitive.p1Light.x;
    } else {
        float area;
        vec3 normal = triangleNormal(primitive.p0Material.xyz, primitive.p1Light.xyz, primitive.p2Id.xyz,
                                     -ray.direction, area);
        front = dot(ray.direction, normal) <= 0.0;
    }
    return front;
}

Traversal beginTraversal(float limit, uint nodeCount, uint primitiveCount) {
    stackItems[0] = 0u;
    stackEntries[0] = 0.0;
    return Traversal(limit, kNone, 0u, kEveryPrimitive ? primitiveCount : min(nodeCount, 1u));
}

vec4 bytesOf(uint word) { return vec4(uvec4(word, word >> 8, word >> 16, word >> 24) & 0xFFu); }

float scaleOf(uint exponents, uint shift) { return uintBitsToFloat(((exponents >> shift) & 0xFFu) << 23); }

void sortPair(inout float ta, inout uint a, inout float tb, inout uint b) {
    if (ta < tb) {
        float t = ta;
        ta = tb;
        tb = t;
        uint item = a;
        a = b;
        b = item;
    }
}

void pushChild(float entry, uint child, inout uint count, inout uint overflows) {
    if (entry != kFarthest) {
        if (count < kStackSize) {
            stackItems[count] = child;
            stackEntries[count] = entry;
            ++count;
        } else {
            ++overflows;
        }
    }
}

// Entry distances of a node's four boxes; kFarthest for those missed, empty, or beyond `limit`. Planes are taken
// relative to the origin before they are scaled, so the relative error stays at 3.5 ulp a side (half for the
// subtraction, 2.5 for the division the API allows, half for the product) and 2^-19 covers both (Ize 2013).
vec4 childEntries(uvec4 words0, uvec4 lower, uvec4 upper, uvec4 children, RayTransform transform, float limit) {
    vec3 base = uintBitsToFloat(words0.xyz);
    vec3 scale = vec3(scaleOf(words0.w, 0u), scaleOf(words0.w, 8u), scaleOf(words0.w, 16u));
    vec3 inverse = transform.inverseDirection;
    precise vec4 x0 = (base.x + bytesOf(lower.x) * scale.x - transform.lowerOrigin.x) * inverse.x;
    precise vec4 y0 = (base.y + bytesOf(lower.y) * scale.y - transform.lowerOrigin.y) * inverse.y;
    precise vec4 z0 = (base.z + bytesOf(lower.z) * scale.z - transform.lowerOrigin.z) * inverse.z;
    precise vec4 x1 = (base.x + bytesOf(lower.w) * scale.x - transform.upperOrigin.x) * inverse.x;
    precise vec4 y1 = (base.y + bytesOf(upper.x) * scale.y - transform.upperOrigin.y) * inverse.y;
    precise vec4 z1 = (base.z + bytesOf(upper.y) * scale.z - transform.upperOrigin.z) * inverse.z;
    vec4 entry = max(max(min(x0, x1), min(y0, y1)), max(min(z0, z1), vec4(0.0)));
    vec4 exit = min(min(max(x0, x1), max(y0, y1)), max(z0, z1)) * 1.0000019;
    bvec4 hit = bvec4(uvec4(lessThanEqual(entry, exit)) & uvec4(lessThanEqual(entry, vec4(limit))) &
                      uvec4(notEqual(children, uvec4(kEmptyChild))));
    return mix(vec4(kFarthest), entry, hit);
}

void visitNode(uint node, Query query, RayTransform transform, inout Traversal state, inout uint overflows) {
    uint word = node * kNodeWords;
    uvec4 children = fetchNode(word + 3u);
    if (kTraversalCounts) {
        bvec4 used = notEqual(children, uvec4(kEmptyChild));
        traversalTests.x += uint(used.x) + uint(used.y) + uint(used.z) + uint(used.w);
    }
    vec4 entries = childEntries(fetchNode(word), fetchNode(word + 1u), fetchNode(word + 2u), children, transform,
                                state.distance);
    // Farthest first on the stack; a sorting network of five comparisons.
    sortPair(entries.x, children.x, entries.y, children.y);
    sortPair(entries.z, children.z, entries.w, children.w);
    sortPair(entries.x, children.x, entries.z, children.z);
    sortPair(entries.y, children.y, entries.w, children.w);
    sortPair(entries.y, children.y, entries.z, children.z);
    pushChild(entries.x, children.x, state.stackCount, overflows);
    pushChild(entries.y, children.y, state.stackCount, overflows);
    pushChild(entries.z, children.z, state.stackCount, overflows);
    pushChild(entries.w, children.w, state.stackCount, overflows);
}

// Where a ray enters the box of a triangle, kFarthest if it misses that: never earlier than the boxes of the nodes above it,
// and never where it misses one of those, as their planes lie further out and the arithmetic is the same.
float entryOf(vec3 p0, vec3 p1, vec3 p2, RayTransform transform) {
    precise vec3 lower = (min(p0, min(p1, p2)) - transform.lowerOrigin) * transform.inverseDirection;
    precise vec3 upper = (max(p0, max(p1, p2)) - transform.upperOrigin) * transform.inverseDirection;
    vec3 near = min(lower, upper);
    vec3 far = max(lower, upper);
    float entry = max(maxComponent(near), 0.0);
    return entry <= min(far.x, min(far.y, far.z)) * 1.0000019 ? entry : kFarthest;
}

// The nearest hit counts, and of several at one distance that of the lowest id, in whatever order they are met.
bool comesBefore(float distance, uint id, Traversal state) {
    return distance > 0.0 && (distance < state.distance || (distance == state.distance && id < state.id));
}

void testPrimitive(uint index, Query query, RayTransform transform, inout Traversal state) {
    PrimitiveRecord primitive = readPrimitive(index);
    if (kTraversalCounts) ++traversalTests.y;
    float distance;
    vec3 barycentric = vec3(0.0);
    bool ignored = index == query.ignored || index == query.alsoIgnored;
    if (kSpheres && (floatBitsToUint(primitive.p2Id.w) & kSphereBit) != 0u) {
        distance = intersectSphere(primitive.p0Material.xyz, primitive.p1Light.x, query.ray.origin, query.ray.direction);
    } else {
        vec3 p0 = primitive.p0Material.xyz;
        vec3 p1 = primitive.p1Light.xyz;
        vec3 p2 = primitive.p2Id.xyz;
        TriangleHit hit = intersectTriangle(p0, p1, p2, query.ray, transform);
        distance = hit.distance;
        barycentric = vec3(hit.b0, hit.b1, 1.0 - hit.b0 - hit.b1);
        // Of a ray in the triangle's plane rounding alone decides where they meet; before the box it would depend on the order
        // in which boxes are visited.
        if (comesBefore(distance, idOf(primitive), state)) distance = max(distance, entryOf(p0, p1, p2, transform));
        if (kCoincident) ignored = ignored || liesIn(query.plane, p0, p1, p2);
    }
    bool nearer = !ignored && comesBefore(distance, idOf(primitive), state);
    if (kBackFaceCulling && nearer && (floatBitsToUint(primitive.p2Id.w) & kCulledBackBit) != 0u)
        nearer = meetsFront(primitive, query.ray);
    if (kCutouts && nearer && (floatBitsToUint(primitive.p2Id.w) & kAlphaBit) != 0u)
        nearer = surfaceIsThere(primitive, index, barycentric, query.alphaKey);
    if (nearer) {
        state.distance = distance;
        state.primitive = index;
        state.id = idOf(primitive);
    }
}

void visitLeaf(uint item, Query query, RayTransform transform, inout Traversal state, inout uint budget) {
    uint first = item & kLeafFirstMask;
    uint count = ((item & ~kLeafBit) >> kLeafCountShift) + 1u;
    for (uint i = 0u; i < count; ++i) testPrimitive(first + i, query, transform, state);
    // Where surfaces may be cut out, each test may read a texture, whose loop counts too.
    budget -= min(budget, kCutouts ? 5u * count : count);
    if (query.kind == kAnyHit && state.primitive != kNone) state.stackCount = 0u;
}

// Goes on until the walk is finished (stackCount 0) or `budget` steps (node visits and primitive tests) are used up.
void traverse(Query query, RayTransform transform, inout Traversal state, inout uint budget, inout uint overflows) {
    while (state.stackCount > 0u && budget > 0u) {
        --budget;
        --state.stackCount;
        if (kEveryPrimitive) {
            if (kCutouts) budget -= min(budget, 4u);
            testPrimitive(state.stackCount, query, transform, state);
            if (query.kind == kAnyHit && state.primitive != kNone) state.stackCount = 0u;
        } else if (stackEntries[state.stackCount] <= state.distance) {
            uint item = stackItems[state.stackCount];
            if ((item & kLeafBit) == 0u) {
                visitNode(item, query, transform, state, overflows);
            } else {
                visitLeaf(item, query, transform, state, budget);
            }
        }
    }
}

#endif
