// The random words of a sample, by sampler; twin of host/core/sample_sequence.h, word for word.
#ifndef ISOLUX_CORE_SAMPLE_SEQUENCE_GLSL
#define ISOLUX_CORE_SAMPLE_SEQUENCE_GLSL

#include "core/philox.glsl"

// What a sampler must know of the render and of the sample.
struct SampleIndex {
    uvec2 seed;
    uvec2 pixel;
    uint index; // absolute
    uint cellBits;
};

const uint kReplicateMask = 15u;
const uint kReplicateBits = 4u;
const uint kMaxCellBits = 16u;

// Keys of scrambles: apart from the words of any sample.
uvec4 keyBlock(uvec2 seed, uvec2 pixel, uint counter, uint block) {
    return philox4x32(uvec4(pixel, counter, block), uvec2(seed.x, seed.y ^ 0x5EED5E71u));
}

// Laine and Karras 2011, with the constants of Vegdahl 2021: a bit of the result depends on the key and the bits below it.
uint laineKarrasHash(uint x, uint key) {
    x ^= x * 0x3D20ADEAu;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return x;
}

uint nestedScramble(uint x, uint key) { return bitfieldReverse(laineKarrasHash(bitfieldReverse(x), key)); }

// The second dimension of Sobol's sequence, bits reversed.
uint pascalTransform(uint index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0F0F0F0Fu;
    index ^= (index >> 8) & 0x00FF00FFu;
    return index ^ (index >> 16);
}

uvec2 sobolPair(uint index, uint shuffle, uvec2 scrambles) {
    uint shuffled = nestedScramble(index, shuffle);
    return uvec2(bitfieldReverse(laineKarrasHash(shuffled, scrambles.x)),
                 bitfieldReverse(laineKarrasHash(pascalTransform(shuffled), scrambles.y)));
}

uvec4 sobolWords(uint index, uvec4 shuffles, uvec4 scrambles) {
    return uvec4(sobolPair(index, shuffles.x, scrambles.xy), sobolPair(index, shuffles.y, scrambles.zw));
}

// Bits of x and y interleaved, x lowest; both below 2^16.
uint mortonIndex(uvec2 p) {
    p = (p | (p << 8)) & 0x00FF00FFu;
    p = (p | (p << 4)) & 0x0F0F0F0Fu;
    p = (p | (p << 2)) & 0x33333333u;
    p = (p | (p << 1)) & 0x55555555u;
    return p.x | (p.y << 1);
}

uvec4 independentBlock(SampleIndex s, uint block) { return philox4x32(uvec4(s.pixel, s.index, block), s.seed); }

uvec2 stratifiedPair(uint within, uint bits, uvec2 keys, uvec2 jitter) {
    uint columnBits = (bits + 1u) / 2u;
    uint rowBits = bits - columnBits;
    // Shifts by 32 are undefined: with no bits there is one cell.
    uint shuffled = nestedScramble(within, keys.x);
    uint cell = bits == 0u ? 0u : bitfieldReverse(laineKarrasHash(shuffled, keys.y)) >> ((32u - bits) & 31u);
    uint column = cell & ((1u << columnBits) - 1u);
    uint row = cell >> columnBits;
    return uvec2(columnBits == 0u ? jitter.x : (column << ((32u - columnBits) & 31u)) | (jitter.x >> columnBits),
                 rowBits == 0u ? jitter.y : (row << ((32u - rowBits) & 31u)) | (jitter.y >> rowBits));
}

uvec4 stratifiedBlock(SampleIndex s, uint block) {
    uint bits = min(s.cellBits, kMaxCellBits);
    uint within = s.index >> kReplicateBits;
    uvec4 jitter = independentBlock(s, block);
    uvec4 keys = keyBlock(s.seed, s.pixel, (s.index & kReplicateMask) + ((within >> bits) << kReplicateBits), block);
    return uvec4(stratifiedPair(within, bits, keys.xz, jitter.xy), stratifiedPair(within, bits, keys.yw, jitter.zw));
}

uvec4 sobolBlock(SampleIndex s, uint block) {
    uint replicate = s.index & kReplicateMask;
    return sobolWords(s.index >> kReplicateBits, keyBlock(s.seed, s.pixel, replicate, block),
                      keyBlock(s.seed, s.pixel, replicate + 0x80000000u, block));
}

uvec4 sobolBlueNoiseBlock(SampleIndex s, uint block) {
    const uvec2 kAllPixels = uvec2(0xFFFFFFFFu);
    uint replicate = s.index & kReplicateMask;
    uint place = (mortonIndex(s.pixel) << s.cellBits) | (s.index >> kReplicateBits);
    return sobolWords(place, keyBlock(s.seed, kAllPixels, replicate, block),
                      keyBlock(s.seed, kAllPixels, replicate + 0x80000000u, block));
}

#endif
