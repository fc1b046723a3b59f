// How any function reads scene data: one 16-byte word at a time, through functions the kernel's bindings define.
#ifndef ISOLUX_CORE_SCENE_ACCESS_GLSL
#define ISOLUX_CORE_SCENE_ACCESS_GLSL

#include "shared/scene_records.h"

uvec4 fetchNode(uint word);
uvec4 fetchPrimitive(uint word);
uvec4 fetchAttribute(uint word);
uvec4 fetchTable(uint word);

PrimitiveRecord readPrimitive(uint index) {
    uint word = index * kPrimitiveWords;
    return PrimitiveRecord(uintBitsToFloat(fetchPrimitive(word)), uintBitsToFloat(fetchPrimitive(word + 1u)),
                           uintBitsToFloat(fetchPrimitive(word + 2u)));
}

vec4 attributeWord(uint word) { return uintBitsToFloat(fetchAttribute(word)); }

// Attributes lie in sections, one record a primitive; `section` is the first word of one.
NormalRecord readNormals(uint section, uint primitive) {
    uint word = section + primitive * kNormalWords;
    return NormalRecord(attributeWord(word), attributeWord(word + 1u), attributeWord(word + 2u));
}

TangentRecord readTangents(uint section, uint primitive) {
    uint word = section + primitive * kTangentWords;
    return TangentRecord(attributeWord(word), attributeWord(word + 1u), attributeWord(word + 2u));
}

ColorRecord readColors(uint section, uint primitive) {
    uint word = section + primitive * kColorWords;
    return ColorRecord(attributeWord(word), attributeWord(word + 1u), attributeWord(word + 2u));
}

UvRecord readUvs(uint section, uint primitive) {
    uint word = section + primitive * kUvWords;
    return UvRecord(attributeWord(word), attributeWord(word + 1u));
}

vec4 tableWord(uint word) { return uintBitsToFloat(fetchTable(word)); }

MaterialRecord readMaterial(uint tableOffset, uint index) {
    uint word = tableOffset + index * kMaterialWords;
    return MaterialRecord(tableWord(word), tableWord(word + 1u), tableWord(word + 2u), tableWord(word + 3u),
                          tableWord(word + 4u), tableWord(word + 5u), fetchTable(word + 6u), fetchTable(word + 7u));
}

TextureRecord readTexture(uint tableOffset, uint index) {
    uint word = tableOffset + index * kTextureWords;
    return TextureRecord(fetchTable(word), tableWord(word + 1u), tableWord(word + 2u));
}

LightRecord readLight(uint tableOffset, uint index) {
    uint word = tableOffset + index * kLightWords;
    return LightRecord(uintBitsToFloat(fetchTable(word)), uintBitsToFloat(fetchTable(word + 1u)),
                       uintBitsToFloat(fetchTable(word + 2u)), uintBitsToFloat(fetchTable(word + 3u)));
}

#endif
