// The intersection kernel's input and output: one record a ray.
#ifndef ISOLUX_SHARED_RAY_RECORDS_H
#define ISOLUX_SHARED_RAY_RECORDS_H

#include "shared/types.h"

ISOLUX_SHARED_BEGIN

struct RayRecord {
    vec4 originDistance; // w: hits at this distance or further do not count
    vec4 direction;      // of any length: distances are in units of it; w unused
};
ISOLUX_CHECK_SIZE(RayRecord, 32);

struct HitRecord {
    vec4 distance;   // x: distance, undefined without a hit; y, z, w unused
    uvec4 primitive; // x: primitive index or kNone; y: 1 once the traversal is finished; z, w unused
};
ISOLUX_CHECK_SIZE(HitRecord, 32);

// A dispatch of the intersection kernel: rays [x, y), primitives [z, w) in brute-force mode.
struct IntersectParameters {
    uvec4 range;
};
ISOLUX_CHECK_SIZE(IntersectParameters, 16);

ISOLUX_SHARED_END

#endif
