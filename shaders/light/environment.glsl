// The environment: constant radiance from all directions, or from those of the upper half.
#ifndef ISOLUX_LIGHT_ENVIRONMENT_GLSL
#define ISOLUX_LIGHT_ENVIRONMENT_GLSL

#include "core/math.glsl"
#include "light/light_sample.glsl"

// Uniform over the directions that emit: 1 - y is uniform, and kept, since y itself would round it away near the pole.
LightSample sampleEnvironment(LightRecord light, vec2 u) {
    float range = light.p2Area.x;
    float oneMinusY = u.x * range;
    vec2 around = sqrt(oneMinusY * (2.0 - oneMinusY)) * cosSinTurn(u.y);
    LightSample result;
    result.direction = vec3(around.x, 1.0 - oneMinusY, around.y);
    result.way = result.direction;
    result.limit = kFarthest;
    result.pdf = light.p1Samples.w / (2.0 * kPi * range);
    result.emission = light.emissionKind.xyz;
    result.delta = false;
    result.primitive = kNone;
    result.mapped = false;
    return result;
}

#endif
