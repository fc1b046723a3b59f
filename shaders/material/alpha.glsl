// Surfaces that are not everywhere there: cut out by a mask, or there by chance (host/scene/README.md, "Alpha").
#ifndef ISOLUX_MATERIAL_ALPHA_GLSL
#define ISOLUX_MATERIAL_ALPHA_GLSL

#include "core/philox.glsl"
#include "geometry/traverse.glsl"
#include "material/maps.glsl"

// "lowbias32" (Wellons 2018).
uint alphaHash(uint h) {
    h ^= h >> 16;
    h *= 0x7FEB352Du;
    h ^= h >> 15;
    h *= 0x846CA68Bu;
    return h ^ (h >> 16);
}

// Whether a ray meets the surface there. One number a ray and primitive, in whatever order primitives are met.
bool isThere(MaterialRecord material, MapPoint at, uint id, uint key) {
    float coverage = coverageOf(material, baseColorAt(material, at).a);
    return kAlphaBlend ? unitReal(alphaHash(key ^ (id * 0x9E3779B9u))) < coverage : coverage > 0.0;
}

#endif
