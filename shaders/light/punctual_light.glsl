// Lights without extent: point, spot, directional (KHR_lights_punctual).
#ifndef ISOLUX_LIGHT_PUNCTUAL_LIGHT_GLSL
#define ISOLUX_LIGHT_PUNCTUAL_LIGHT_GLSL

#include "core/math.glsl"
#include "light/light_sample.glsl"

// The share of a spot's intensity in a direction: the square of a ramp in the cosine between the cones. By 1 - cosine,
// half the squared distance of two unit vectors, since the cosines of narrow cones are all 1 in single precision.
float spotAttenuation(LightRecord light, vec3 fromLight) {
    vec3 apart = fromLight - light.p1Samples.xyz;
    float t = clamp((light.p2Area.x - 0.5 * dot(apart, apart)) * light.p2Area.y, 0.0, 1.0);
    return t * t;
}

LightSample samplePunctualLight(LightRecord light, vec3 from) {
    uint kind = floatBitsToUint(light.emissionKind.w);
    vec3 toLight = light.p0Primitive.xyz - from;
    float distanceSquared = dot(toLight, toLight);
    bool directional = kind == kLightDirectional;
    // A surface in which the light lies does not block it: the ray ends short by the rounding of both points and of the
    // distance to such a surface, for incidences down to a few degrees.
    float slack = errorBound(64.0) * (maxComponent(abs(light.p0Primitive.xyz)) + maxComponent(abs(from)));
    float shortened = max(1.0 - slack * inversesqrt(distanceSquared), 1e-30);
    LightSample result;
    result.way = directional ? -light.p1Samples.xyz : toLight;
    result.limit = directional ? kFarthest : shortened;
    result.direction = directional ? -light.p1Samples.xyz : toLight * inversesqrt(distanceSquared);
    float share = kind == kLightSpot ? spotAttenuation(light, -result.direction) : 1.0;
    result.emission = light.emissionKind.xyz * (directional ? 1.0 : share / distanceSquared);
    result.pdf = share > 0.0 && (directional || distanceSquared > 0.0) ? light.p1Samples.w : 0.0;
    result.delta = true;
    result.primitive = kNone;
    result.mapped = false;
    return result;
}

#endif
