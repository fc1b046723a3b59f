// Choosing a light and sampling it; kinds that the scene has not are left out.
#ifndef ISOLUX_LIGHT_LIGHT_GLSL
#define ISOLUX_LIGHT_LIGHT_GLSL

#include "light/area_light.glsl"
#include "light/environment.glsl"
#include "light/environment_map.glsl"
#include "light/punctual_light.glsl"
#include "shared/interface.h"

layout(constant_id = 4) const uint kLights = kLightsMany;
layout(constant_id = 9) const bool kAreaLights = true;
layout(constant_id = 10) const bool kPunctualLights = true;
layout(constant_id = 11) const bool kEnvironment = true;
layout(constant_id = 26) const bool kEnvironmentMap = true; // instead of a constant one

uint chooseLight(uint binOffset, uint bits, uint binWord, uint aliasWord) {
    uint light = 0u;
    if (kLights == kLightsMany) {
        uint bin = bits == 0u ? 0u : binWord >> (32u - bits);
        uvec2 entry = fetchTable(binOffset + bin).xy;
        light = aliasWord < entry.x ? bin : entry.y;
    }
    return light;
}

LightSample sampleLight(LightRecord light, vec3 from, vec2 u) {
    uint kind = floatBitsToUint(light.emissionKind.w) & kLightKindMask;
    LightSample result;
    result.pdf = 0.0;
    if (kAreaLights && kind <= kLightSphere) {
        result = sampleAreaLight(light, from, u);
    } else if (kPunctualLights && kind <= kLightDirectional) {
        result = samplePunctualLight(light, from);
    } else if (kEnvironment) {
        result = sampleEnvironment(light, u);
    }
    return result;
}

#endif
