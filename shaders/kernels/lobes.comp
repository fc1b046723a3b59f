// What surfaces sample and evaluate, query by query and without a scene around them: for tests of lobes.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/scene_bindings.glsl"
#include "core/philox.glsl"
#include "material/bsdf.glsl"
#include "shared/lobe_records.h"

layout(set = 0, binding = 13, std430) readonly buffer QueryBuffer { LobeQueryRecord queries[]; };
layout(set = 0, binding = 14, std430) buffer AnswerBuffer { LobeAnswerRecord answers[]; };
layout(push_constant) uniform Parameters { LobeParameters parameters; };

Bsdf bsdfOf(LobeQueryRecord query) {
    uvec4 textures = uvec4(0u, 0u, 0u, parameters.tables.y);
    MapPoint at = MapPoint(0u, false, vec3(0.0), textures, uvec4(0u), 0u);
    MaterialRecord material = readMaterial(parameters.tables.x, floatBitsToUint(query.outgoing.w));
    bool front = (query.random.z & kLobeQueryBack) == 0u;
    return bsdfAt(material, at, baseColorAt(material, at).rgb, query.outgoing.z, front);
}

// The probability that no delta lobe is sampled.
float broadProbability(Bsdf bsdf) {
    float glass = (bsdf.kind & kDeltaGlass) != 0u ? bsdf.glass : 0.0;
    float specular = (bsdf.kind & kDeltaSpecular) != 0u ? (1.0 - bsdf.glass) * bsdf.specular : 0.0;
    return 1.0 - glass - specular;
}

void answer(uint index) {
    LobeQueryRecord query = queries[index];
    Bsdf bsdf = bsdfOf(query);
    vec3 wo = query.outgoing.xyz;
    BsdfSample chosen = BsdfSample(query.incoming.xyz, 0u, false, vec3(0.0));
    if ((query.random.z & kLobeQuerySample) != 0u)
        chosen = sampleBsdf(bsdf, wo, unitReal(query.random.w), vec2(unitReal(query.random.x), unitReal(query.random.y)));
    float pdf = 0.0;
    if (!chosen.delta) chosen.weight = evalBsdf(bsdf, wo, chosen.wi, pdf);
    answers[index].directionPdf = vec4(chosen.wi, pdf);
    answers[index].value = vec4(chosen.weight, 0.0);
    answers[index].probabilities = vec4(bsdf.glass, bsdf.specular, broadProbability(bsdf), 0.0);
    answers[index].compensation = vec4(bsdf.gain, 0.0, 0.0, 0.0);
    answers[index].outcome = uvec4(chosen.lobe, chosen.delta ? 1u : 0u, 0u, 0u);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < parameters.tables.z) answer(index);
}
