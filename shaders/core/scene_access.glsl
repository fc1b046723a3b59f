// How any function reads scene data: one 16-byte word at a time, through functions the kernel's bindings define.
#ifndef ISOLUX_CORE_SCENE_ACCESS_GLSL
#define ISOLUX_CORE_SCENE_ACCESS_GLSL

#include "shared/scene_records.h"

uvec4 fetchNode(uint word);
uvec4 fetchPrimitive(uint word);
uvec4 fetchNormal(uint word);
uvec4 fetchTable(uint word);

PrimitiveRecord readPrimitive(uint index) {
    uint word = index * kPrimitiveWords;
    return PrimitiveRecord(uintBitsToFloat(fetchPrimitive(word)), uintBitsToFloat(fetchPrimitive(word + 1u)),
                           uintBitsToFloat(fetchPrimitive(word + 2u)));
}

NormalRecord readNormals(uint primitive) {
    uint word = primitive * kNormalWords;
    return NormalRecord(uintBitsToFloat(fetchNormal(word)), uintBitsToFloat(fetchNormal(word + 1u)),
                        uintBitsToFloat(fetchNormal(word + 2u)));
}

MaterialRecord readMaterial(uint tableOffset, uint index) {
    uint word = tableOffset + index * kMaterialWords;
    return MaterialRecord(uintBitsToFloat(fetchTable(word)), uintBitsToFloat(fetchTable(word + 1u)));
}

LightRecord readLight(uint tableOffset, uint index) {
    uint word = tableOffset + index * kLightWords;
    return LightRecord(uintBitsToFloat(fetchTable(word)), uintBitsToFloat(fetchTable(word + 1u)),
                       uintBitsToFloat(fetchTable(word + 2u)), uintBitsToFloat(fetchTable(word + 3u)));
}

#endif
