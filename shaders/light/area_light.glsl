// Area lights: sampling a point or direction on one, and the density of doing so.
#ifndef ISOLUX_LIGHT_AREA_LIGHT_GLSL
#define ISOLUX_LIGHT_AREA_LIGHT_GLSL

#include "core/math.glsl"
#include "geometry/ray.glsl"
#include "light/light_sample.glsl"

bool emitsTwoSided(LightRecord light) { return (floatBitsToUint(light.emissionKind.w) & kLightTwoSidedBit) != 0u; }

// Density in solid angle of a uniform point on a triangle; `samples` are expected of the light.
float trianglePdf(float samples, float area, float distanceSquared, float cosine) {
    return samples * distanceSquared / (area * cosine);
}

// 1 - cos of the half angle under which a sphere is seen, without cancellation (sin^2 = radius^2 / distance^2).
float sphereOneMinusCosine(float sineSquared) { return sineSquared / (1.0 + sqrt(max(1.0 - sineSquared, 0.0))); }

LightSample sampleTriangle(LightRecord light, vec3 from, vec2 u) {
    vec3 p0 = light.p0Primitive.xyz;
    vec3 p1 = light.p1Samples.xyz;
    vec3 p2 = light.p2Area.xyz;
    // Heitz 2019, "A low-distortion map between triangle and square".
    float b0 = u.y > u.x ? 0.5 * u.x : u.x - 0.5 * u.y;
    float b1 = u.y > u.x ? u.y - 0.5 * u.x : 0.5 * u.y;
    float b2 = 1.0 - b0 - b1;
    vec3 point = b0 * p0 + b1 * p1 + b2 * p2;
    vec3 error = errorBound(7.0) * (abs(b0 * p0) + abs(b1 * p1) + abs(b2 * p2));
    vec3 toLight = point - from;
    float area;
    vec3 normal = triangleNormal(p0, p1, p2, toLight, area);
    float distanceSquared = dot(toLight, toLight);
    LightSample result;
    result.direction = toLight * inversesqrt(distanceSquared);
    float cosine = -dot(result.direction, normal); // positive: seen from the front
    bool emits = cosine > 0.0 || (cosine < 0.0 && emitsTwoSided(light));
    // An area that float cannot hold belongs to a triangle that no ray can hit either.
    result.pdf = emits && light.p2Area.w > 0.0 ? trianglePdf(light.p1Samples.w, light.p2Area.w, distanceSquared, abs(cosine)) : 0.0;
    result.way = offsetOrigin(point, error, cosine > 0.0 ? normal : -normal) - from;
    result.place = vec2(b0, b1);
    return result;
}

// A point of the whole sphere, for shading points inside or on it.
LightSample sampleSphereFromInside(LightRecord light, vec3 from, vec2 u) {
    float radius = light.p1Samples.x;
    float z = 1.0 - 2.0 * u.x;
    vec3 normal = vec3(2.0 * sqrt(u.x * (1.0 - u.x)) * cosSinTurn(u.y), z);
    vec3 point = light.p0Primitive.xyz + radius * normal;
    vec3 toLight = point - from;
    float distanceSquared = dot(toLight, toLight);
    LightSample result;
    result.direction = toLight * inversesqrt(distanceSquared);
    float cosine = dot(result.direction, normal); // positive: the inner face is seen
    bool emits = cosine < 0.0 || emitsTwoSided(light);
    result.pdf = emits && cosine != 0.0
                     ? light.p1Samples.w * distanceSquared / (4.0 * kPi * radius * radius * abs(cosine)) : 0.0;
    vec3 error = errorBound(6.0) * (abs(radius * normal) + abs(light.p0Primitive.xyz));
    result.way = offsetOrigin(point, error, cosine > 0.0 ? -normal : normal) - from;
    return result;
}

// A direction in the cone under which the sphere is seen from outside.
LightSample sampleSphereFromOutside(LightRecord light, vec3 from, vec2 u, float sineSquared) {
    float radius = light.p1Samples.x;
    vec3 toCenter = light.p0Primitive.xyz - from;
    float distanceToCenter = length(toCenter);
    float cap = sphereOneMinusCosine(sineSquared);
    float oneMinusCosine = u.x * cap;
    float sineSampled = sqrt(oneMinusCosine * (2.0 - oneMinusCosine));
    vec3 axis = toCenter / distanceToCenter;
    vec3 tangent, bitangent;
    frameAbout(axis, tangent, bitangent);
    vec2 around = sineSampled * cosSinTurn(u.y);
    LightSample result;
    result.direction = normalize(around.x * tangent + around.y * bitangent + (1.0 - oneMinusCosine) * axis);
    result.pdf = light.p1Samples.w / (2.0 * kPi * cap);
    // Where the direction meets the sphere: nearer than the closest approach by the half chord.
    float halfChord = sqrt(max(radius * radius - distanceToCenter * distanceToCenter * sineSampled * sineSampled, 0.0));
    vec3 onRay = from + (distanceToCenter * (1.0 - oneMinusCosine) - halfChord) * result.direction;
    vec3 normal = normalize(onRay - light.p0Primitive.xyz);
    vec3 error = errorBound(6.0) * (abs(radius * normal) + abs(light.p0Primitive.xyz));
    result.way = offsetOrigin(light.p0Primitive.xyz + radius * normal, error, normal) - from;
    return result;
}

// sin^2 of the half angle of a sphere light seen from a point; 1 or more from inside.
float sphereSineSquared(LightRecord light, vec3 from) {
    vec3 toCenter = light.p0Primitive.xyz - from;
    return light.p1Samples.x * light.p1Samples.x / dot(toCenter, toCenter);
}

LightSample sampleAreaLight(LightRecord light, vec3 from, vec2 u) {
    LightSample result;
    if ((floatBitsToUint(light.emissionKind.w) & kLightKindMask) == kLightTriangle) {
        result = sampleTriangle(light, from, u);
    } else {
        float sineSquared = sphereSineSquared(light, from);
        if (sineSquared < 1.0) {
            result = sampleSphereFromOutside(light, from, u, sineSquared);
        } else {
            result = sampleSphereFromInside(light, from, u);
        }
    }
    result.limit = 1.0;
    result.emission = light.emissionKind.xyz;
    result.mapped = (floatBitsToUint(light.emissionKind.w) & (kLightMappedBit | kLightCoverageBit)) != 0u;
    result.primitive = floatBitsToUint(light.p0Primitive.w);
    result.delta = false;
    return result;
}

// The density with which sampleAreaLight would have chosen the point of a light that a ray from `from` has hit.
float areaLightPdf(LightRecord light, vec3 from, float distance, float cosine) {
    float sineSquared = sphereSineSquared(light, from);
    float radius = light.p1Samples.x;
    float fromOutside = light.p1Samples.w / (2.0 * kPi * sphereOneMinusCosine(sineSquared));
    float fromInside = light.p1Samples.w * distance * distance / (4.0 * kPi * radius * radius * cosine);
    float ofSphere = sineSquared < 1.0 ? fromOutside : fromInside;
    bool triangle = (floatBitsToUint(light.emissionKind.w) & kLightKindMask) == kLightTriangle;
    return triangle ? trianglePdf(light.p1Samples.w, light.p2Area.w, distance * distance, cosine) : ofSphere;
}

#endif
