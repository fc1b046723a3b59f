// What the maps and vertex colours of a material say at a point of a triangle.
#ifndef ISOLUX_MATERIAL_MAPS_GLSL
#define ISOLUX_MATERIAL_MAPS_GLSL

#include "material/texture.glsl"

layout(constant_id = 33) const bool kBaseColorMaps = true;
layout(constant_id = 34) const bool kMetallicRoughnessMaps = true;
layout(constant_id = 35) const bool kNormalMaps = true;
layout(constant_id = 36) const bool kEmissionMaps = true;
layout(constant_id = 37) const bool kTransmissionMaps = true; // and of thickness
layout(constant_id = 38) const bool kSpecularMaps = true;
layout(constant_id = 39) const bool kVertexColors = true;

// Where a map is read: a primitive and barycentric coordinates, and where the scene keeps what is read there.
struct MapPoint {
    uint primitive;
    bool planar; // a sphere has no coordinates
    vec3 barycentric;
    uvec4 textures;   // RenderParameters.textureOffsets
    uvec4 attributes; // RenderParameters.attributeOffsets
    uint primitiveCount;
};

// 1 where there is no map.
vec4 mapValue(uint map, MapPoint at, bool srgb) {
    vec4 value = vec4(1.0);
    if (map != kNone) {
        TextureRecord record = readTexture(at.textures.x, map);
        vec2 uv = vec2(0.0);
        if (at.planar) {
            uint set = record.image.w >> kTextureUvShift;
            UvRecord uvs = readUvs(at.attributes.w + set * at.primitiveCount * kUvWords, at.primitive);
            uv = at.barycentric.x * uvs.uv0Uv1.xy + at.barycentric.y * uvs.uv0Uv1.zw + at.barycentric.z * uvs.uv2.xy;
        }
        vec2 transformed = record.uvFromMesh.xy * uv.x + record.uvFromMesh.zw * uv.y + record.offset.xy;
        value = sampleTexture(record, transformed, srgb, at.textures.yz);
    }
    return value;
}

// Iterations that reading every map of a hit and of a sampled light may take: what the step budget must allow for.
uint mapIterations() {
    uint lookups = 0u;
    if (kBaseColorMaps) lookups += 2u;
    if (kMetallicRoughnessMaps) lookups += 1u;
    if (kNormalMaps) lookups += 1u;
    if (kEmissionMaps) lookups += 2u;
    if (kTransmissionMaps) lookups += 2u;
    if (kSpecularMaps) lookups += 2u;
    return 4u * lookups;
}

// Base colour and alpha at a point: factor, map, vertex colour.
vec4 baseColorAt(MaterialRecord material, MapPoint at) {
    vec4 base = material.baseColorAlpha;
    if (kBaseColorMaps) base *= mapValue(material.maps.x, at, true);
    if (kVertexColors && at.planar) {
        ColorRecord colors = readColors(at.attributes.z, at.primitive);
        // As differences: exact where a triangle has one colour.
        base *= colors.c2 + at.barycentric.x * (colors.c0 - colors.c2) + at.barycentric.y * (colors.c1 - colors.c2);
    }
    return base;
}

// How much of the factor's emission there is.
vec3 emissionMapAt(MaterialRecord material, MapPoint at) {
    return kEmissionMaps ? mapValue(material.maps.w, at, true).rgb : vec3(1.0);
}

// The probability that the surface is there: 0 or 1 for a mask.
float coverageOf(MaterialRecord material, float alpha) {
    uint flags = floatBitsToUint(material.emissionFlags.w);
    float ofMask = (flags & kMaterialMask) != 0u && alpha < material.surface.w ? 0.0 : 1.0;
    return (flags & kMaterialBlend) != 0u ? alpha : ofMask;
}

#endif
