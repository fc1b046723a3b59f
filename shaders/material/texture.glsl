// Reading a texture: wrapping, decoding, filtering (host/scene/README.md, "Textures").
#ifndef ISOLUX_MATERIAL_TEXTURE_GLSL
#define ISOLUX_MATERIAL_TEXTURE_GLSL

#include "core/math.glsl"
#include "core/scene_access.glsl"

// A coordinate brought into one period of its wrap mode, so that its texel's index fits an integer.
float wrapCoordinate(float u, uint wrap) {
    float period = wrap == kWrapMirrored ? 2.0 : 1.0;
    float repeated = u - period * floor(u / period);
    float wrapped = wrap == kWrapClamp ? clamp(u, 0.0, 1.0) : repeated;
    return isFiniteBits(u) ? wrapped : 0.0;
}

// The texel of an index at most one beyond the period.
uint wrapIndex(int i, int size, uint wrap) {
    int period = wrap == kWrapMirrored ? 2 * size : size;
    int inPeriod = i < 0 ? i + period : (i >= period ? i - period : i);
    int mirrored = inPeriod < size ? inPeriod : period - 1 - inPeriod;
    return uint(wrap == kWrapClamp ? clamp(i, 0, size - 1) : mirrored);
}

// The linear value of an encoded one, from a table that the host computed exactly (IEC 61966-2-1).
float decodeSrgb(uint table, uint code) { return uintBitsToFloat(fetchTable(table + (code >> 2))[code & 3u]); }

// `decoding`: first words of the tables of 8-bit and of 16-bit sRGB.
vec4 readTexel(uvec4 image, uvec2 at, bool srgb, uvec2 decoding) {
    uint index = at.y * image.y + at.x;
    bool wide = (image.w & kTexture16Bit) != 0u;
    uvec4 words = fetchTable(image.x + (wide ? index >> 1 : index >> 2));
    uint low = wide ? ((index & 1u) == 0u ? words.x : words.z) : words[index & 3u];
    uint high = (index & 1u) == 0u ? words.y : words.w;
    uvec4 narrowCodes = uvec4(low, low >> 8, low >> 16, low >> 24) & 0xFFu;
    uvec4 wideCodes = uvec4(low & 0xFFFFu, low >> 16, high & 0xFFFFu, high >> 16);
    uvec4 codes = wide ? wideCodes : narrowCodes;
    vec4 value = vec4(codes) / (wide ? 65535.0 : 255.0);
    if (srgb) {
        uint table = wide ? decoding.y : decoding.x;
        value.rgb = vec3(decodeSrgb(table, codes.r), decodeSrgb(table, codes.g), decodeSrgb(table, codes.b));
    }
    return value;
}

vec4 sampleTexture(TextureRecord record, vec2 uv, bool srgb, uvec2 decoding) {
    uvec4 image = record.image;
    uint wrapU = image.w & kTextureWrapMask;
    uint wrapV = (image.w >> kTextureWrapVShift) & kTextureWrapMask;
    ivec2 size = ivec2(image.yz);
    bool linear = (image.w & kTextureLinearBit) != 0u;
    vec2 s = vec2(wrapCoordinate(uv.x, wrapU), wrapCoordinate(uv.y, wrapV)) * vec2(size) - (linear ? 0.5 : 0.0);
    vec2 base = floor(s);
    vec2 f = s - base;
    ivec2 i = ivec2(base);
    // A loop, for drivers that take minutes to compile four copies of what reads a texel.
    uint corners = linear ? 4u : 1u;
    vec4 value = vec4(0.0);
    for (uint corner = 0u; corner < corners; ++corner) {
        ivec2 at = i + ivec2(corner & 1u, corner >> 1);
        vec2 weights = mix(1.0 - f, f, vec2(corner & 1u, corner >> 1));
        uvec2 texel = uvec2(wrapIndex(at.x, size.x, wrapU), wrapIndex(at.y, size.y, wrapV));
        value += (linear ? weights.x * weights.y : 1.0) * readTexel(image, texel, srgb, decoding);
    }
    return value;
}

#endif
