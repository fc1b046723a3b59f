// Philox4x32-10 (Salmon et al. 2011); twin of host/core/philox.h.
#ifndef ISOLUX_CORE_PHILOX_GLSL
#define ISOLUX_CORE_PHILOX_GLSL

uvec4 philoxRound(uvec4 counter, uvec2 key) {
    uint high0, low0, high1, low1;
    umulExtended(0xD2511F53u, counter.x, high0, low0);
    umulExtended(0xCD9E8D57u, counter.z, high1, low1);
    return uvec4(high1 ^ counter.y ^ key.x, low1, high0 ^ counter.w ^ key.y, low0);
}

// Written out, since a loop would count against the iterations that some drivers allow an invocation.
uvec4 philox4x32(uvec4 counter, uvec2 key) {
    const uvec2 kStep = uvec2(0x9E3779B9u, 0xBB67AE85u);
    counter = philoxRound(counter, key);
    counter = philoxRound(counter, key + kStep);
    counter = philoxRound(counter, key + 2u * kStep);
    counter = philoxRound(counter, key + 3u * kStep);
    counter = philoxRound(counter, key + 4u * kStep);
    counter = philoxRound(counter, key + 5u * kStep);
    counter = philoxRound(counter, key + 6u * kStep);
    counter = philoxRound(counter, key + 7u * kStep);
    counter = philoxRound(counter, key + 8u * kStep);
    return philoxRound(counter, key + 9u * kStep);
}

// In [0, 1 - 2^-24]: never 1, and the same number as on the host.
float unitReal(uint word) { return float(word >> 8) * (1.0 / 16777216.0); }

#endif
