// What light sampling answers, whatever the kind of light.
#ifndef ISOLUX_LIGHT_LIGHT_SAMPLE_GLSL
#define ISOLUX_LIGHT_LIGHT_SAMPLE_GLSL

#include "core/scene_access.glsl"

struct LightSample {
    vec3 way;       // the shadow ray: to a point just off the light, or the direction of a light at infinity
    float limit;    // hits at this multiple of `way` or further do not count
    vec3 direction; // unit, towards the light
    float pdf;      // solid angle, times the samples expected of the light; of delta lights those alone. 0: nothing arrives
    vec3 emission;  // radiance; of delta lights what a surface that faces them receives
    bool delta;     // scattering can never find it
    bool mapped;    // emission is to be multiplied by what the material's maps say at the place below
    vec2 place;     // first two barycentric coordinates on a triangle
    uint primitive; // a convex emitter cannot hide the point of it that is seen, so the shadow ray ignores it; or kNone
};

#endif
