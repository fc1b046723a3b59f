// Read-only scene data, as 16-byte words that a kernel fetches one by one (from a texel or a storage buffer).
#ifndef ISOLUX_SHARED_SCENE_RECORDS_H
#define ISOLUX_SHARED_SCENE_RECORDS_H

#include "shared/types.h"

ISOLUX_SHARED_BEGIN

// Four-wide BVH node, boxes quantised to 8 bits (host/accel/wide_bvh.h).
struct NodeRecord {
    vec4 originExponents; // xyz origin; w: three biased exponents, 8 bits each, as bits
    uvec4 lower;          // x, y, z: lower bounds of four children, a byte each; w: upper bounds in x
    uvec4 upper;          // x, y: upper bounds in y and z; z, w unused
    uvec4 children;       // WideChild bits
};
ISOLUX_CHECK_SIZE(NodeRecord, 64);

// A triangle or a sphere. id has kSphereBit for spheres; its other bits are the primitive id of host/scene.
// Sphere: p0 = centre, p1.x = radius.
struct PrimitiveRecord {
    vec4 p0Material; // w: material index, as bits
    vec4 p1Light;    // w: light index or kNone, as bits
    vec4 p2Id;       // w: id, as bits
};
ISOLUX_CHECK_SIZE(PrimitiveRecord, 48);

// Vertex normals of a triangle; zero where the mesh is flat.
struct NormalRecord {
    vec4 n0;
    vec4 n1;
    vec4 n2;
};
ISOLUX_CHECK_SIZE(NormalRecord, 48);

struct MaterialRecord {
    vec4 baseColor; // w unused
    vec4 emission;  // w: 1 if the back face emits too
};
ISOLUX_CHECK_SIZE(MaterialRecord, 32);

// One light, complete, so that sampling it touches nothing else. What the words hold besides:
//   triangle      its corners and area
//   sphere        p0 = centre, p1.x = radius
//   point, spot   p0 = position, p1 = direction, p2.x = 1 - cosOuter, p2.y = 1 / (cosInner - cosOuter)
//   directional   p1 = direction in which the light travels
//   environment   p2.x = 1 - y of the lowest direction that emits
struct LightRecord {
    vec4 p0Primitive;  // w: index of its PrimitiveRecord or kNone, as bits
    vec4 p1Samples;    // w: expected number of samples of this light at a shading point
    vec4 p2Area;       // w: area of a triangle
    vec4 emissionKind; // device radiance, or what a punctual light sends; w: one of kLight..., as bits
};
ISOLUX_CHECK_SIZE(LightRecord, 64);

// One bin of the alias table (host/scene/alias_table.h).
struct LightBinRecord {
    uvec4 thresholdAlias; // x: threshold, y: alias; z, w unused
};
ISOLUX_CHECK_SIZE(LightBinRecord, 16);

// Two cells of a pixel filter's table (host/scene/pixel_filter.h).
struct FilterCellsRecord {
    vec4 offsets; // from x to y in the first, from z to w in the second
};
ISOLUX_CHECK_SIZE(FilterCellsRecord, 16);

ISOLUX_CONSTANT uint kNone = 0xFFFFFFFFu;
ISOLUX_CONSTANT uint kSphereBit = 0x80000000u;

ISOLUX_CONSTANT uint kLightTriangle = 0u;
ISOLUX_CONSTANT uint kLightSphere = 1u;
ISOLUX_CONSTANT uint kLightPoint = 2u;
ISOLUX_CONSTANT uint kLightSpot = 3u;
ISOLUX_CONSTANT uint kLightDirectional = 4u;
ISOLUX_CONSTANT uint kLightEnvironment = 5u;
ISOLUX_CONSTANT uint kLightKindMask = 0xFFu;
ISOLUX_CONSTANT uint kLightTwoSidedBit = 0x100u; // the back face emits too

// Words (of 16 bytes) a record.
ISOLUX_CONSTANT uint kNodeWords = 4u;
ISOLUX_CONSTANT uint kPrimitiveWords = 3u;
ISOLUX_CONSTANT uint kNormalWords = 3u;
ISOLUX_CONSTANT uint kMaterialWords = 2u;
ISOLUX_CONSTANT uint kLightWords = 4u;
ISOLUX_CONSTANT uint kFilterCells = 256u;

// A child slot of a node: host/accel/wide_bvh.h, WideChild.
ISOLUX_CONSTANT uint kEmptyChild = 0xFFFFFFFFu;
ISOLUX_CONSTANT uint kLeafBit = 0x80000000u;
ISOLUX_CONSTANT uint kLeafCountShift = 28u;
ISOLUX_CONSTANT uint kLeafFirstMask = 0x0FFFFFFFu;

ISOLUX_SHARED_END

#endif
