// Read-only scene data, as 16-byte words that a kernel fetches one by one (from a texel or a storage buffer).
#ifndef ISOLUX_SHARED_SCENE_RECORDS_H
#define ISOLUX_SHARED_SCENE_RECORDS_H

#include "shared/types.h"

ISOLUX_SHARED_BEGIN

// Four-wide BVH node, boxes quantised to 8 bits (host/accel/wide_bvh.h).
struct NodeRecord {
    vec4 originExponents; // xyz origin; w: three biased exponents, 8 bits each, as bits
    uvec4 lower;          // x, y, z: lower bounds of four children, a byte each; w: upper bounds in x
    uvec4 upper;          // x, y: upper bounds in y and z; z, w unused
    uvec4 children;       // WideChild bits
};
ISOLUX_CHECK_SIZE(NodeRecord, 64);

// A triangle or a sphere. id has kSphereBit for spheres, kAlphaBit where the surface is not everywhere there and
// kCulledBackBit where it has no back; its other bits are the primitive id of host/scene. Sphere: p0 = centre, p1.x =
// radius.
struct PrimitiveRecord {
    vec4 p0Material; // w: material index, as bits
    vec4 p1Light;    // w: light index or kNone, as bits
    vec4 p2Id;       // w: id, as bits
};
ISOLUX_CHECK_SIZE(PrimitiveRecord, 48);

// Attributes of a triangle's three vertices, each kind in a section of its own, if the scene needs it.
struct NormalRecord { // zero where the mesh is flat
    vec4 n0;
    vec4 n1;
    vec4 n2;
};
ISOLUX_CHECK_SIZE(NormalRecord, 48);

struct TangentRecord { // world space, of any length; w of the first: sign of the bitangent
    vec4 t0;
    vec4 t1;
    vec4 t2;
};
ISOLUX_CHECK_SIZE(TangentRecord, 48);

struct ColorRecord { // linear, alpha in w
    vec4 c0;
    vec4 c1;
    vec4 c2;
};
ISOLUX_CHECK_SIZE(ColorRecord, 48);

struct UvRecord { // one set of texture coordinates
    vec4 uv0Uv1;
    vec4 uv2; // z, w unused
};
ISOLUX_CHECK_SIZE(UvRecord, 32);

struct MaterialRecord {
    vec4 baseColorAlpha;
    vec4 emissionFlags; // w: kMaterial... bits, as bits
    vec4 surface;       // metallic, roughness, index of refraction, alpha cutoff
    vec4 specular;      // rgb: colour; w: factor
    vec4 glass;         // transmission, thickness, scale of the normal map; w unused
    vec4 absorption;    // rgb: per unit of device space; w unused
    uvec4 maps;         // texture records of base colour, metallic-roughness, normal, emission; or kNone
    uvec4 moreMaps;     // of transmission, thickness, specular, specular colour
};
ISOLUX_CHECK_SIZE(MaterialRecord, 128);

// A texture as a material uses it.
struct TextureRecord {
    uvec4 image;     // first word of its texels, width, height, kTexture... bits
    vec4 uvFromMesh; // a matrix by columns
    vec4 offset;     // x, y; z, w unused
};
ISOLUX_CHECK_SIZE(TextureRecord, 48);

// One light, complete, so that sampling it touches nothing else. What the words hold besides:
//   triangle      its corners and area
//   sphere        p0 = centre, p1.x = radius
//   point, spot   p0 = position, p1 = direction, p2.x = 1 - cosOuter, p2.y = 1 / (cosInner - cosOuter)
//   directional   p1 = direction in which the light travels
//   environment   p2.x = 1 - y of the lowest direction that emits, if it is constant
struct LightRecord {
    vec4 p0Primitive;  // w: index of its PrimitiveRecord or kNone, as bits
    vec4 p1Samples;    // w: expected number of samples of this light at a shading point
    vec4 p2Area;       // w: area of a triangle
    vec4 emissionKind; // device radiance, or what a punctual light sends; w: one of kLight..., as bits
};
ISOLUX_CHECK_SIZE(LightRecord, 64);

// One bin of an alias table (host/scene/alias_table.h): of lights, or of an environment map's cells.
struct LightBinRecord {
    uvec4 thresholdAlias; // x: threshold, y: alias; z, w unused
};
ISOLUX_CHECK_SIZE(LightBinRecord, 16);

// Two cells of a pixel filter's table (host/scene/pixel_filter.h).
struct FilterCellsRecord {
    vec4 offsets; // from x to y in the first, from z to w in the second
};
ISOLUX_CHECK_SIZE(FilterCellsRecord, 16);

ISOLUX_CONSTANT uint kNone = 0xFFFFFFFFu;
ISOLUX_CONSTANT uint kSphereBit = 0x80000000u;
ISOLUX_CONSTANT uint kAlphaBit = 0x40000000u;
ISOLUX_CONSTANT uint kCulledBackBit = 0x20000000u;
ISOLUX_CONSTANT uint kIdMask = 0x1FFFFFFFu;

ISOLUX_CONSTANT uint kLightTriangle = 0u;
ISOLUX_CONSTANT uint kLightSphere = 1u;
ISOLUX_CONSTANT uint kLightPoint = 2u;
ISOLUX_CONSTANT uint kLightSpot = 3u;
ISOLUX_CONSTANT uint kLightDirectional = 4u;
ISOLUX_CONSTANT uint kLightEnvironment = 5u;
ISOLUX_CONSTANT uint kLightKindMask = 0xFFu;
ISOLUX_CONSTANT uint kLightTwoSidedBit = 0x100u; // the back face emits too
ISOLUX_CONSTANT uint kLightMappedBit = 0x200u;   // emission has a map
ISOLUX_CONSTANT uint kLightCoverageBit = 0x400u; // the surface is not everywhere there

ISOLUX_CONSTANT uint kMaterialTwoSided = 1u; // the back face emits too
ISOLUX_CONSTANT uint kMaterialMask = 2u;
ISOLUX_CONSTANT uint kMaterialBlend = 4u;
ISOLUX_CONSTANT uint kMaterialUnlit = 8u;

ISOLUX_CONSTANT uint kTextureWrapMask = 3u;   // of u; host/scene's TextureWrap
ISOLUX_CONSTANT uint kTextureWrapVShift = 2u; // of v
ISOLUX_CONSTANT uint kTextureLinearBit = 16u; // bilinear
ISOLUX_CONSTANT uint kTexture16Bit = 32u;     // two words a texel, else one
ISOLUX_CONSTANT uint kTextureUvShift = 8u;    // which section of texture coordinates
ISOLUX_CONSTANT uint kWrapRepeat = 0u;
ISOLUX_CONSTANT uint kWrapMirrored = 1u;
ISOLUX_CONSTANT uint kWrapClamp = 2u;

// Albedo tables (host/scene/albedo_tables.h), a word for each node: its value, the next angle's, and both of the next
// roughness.
ISOLUX_CONSTANT uint kReflectionAngles = 32u;
ISOLUX_CONSTANT uint kReflectionRoughnesses = 32u;
ISOLUX_CONSTANT uint kFresnelTableAngles = 32u;
ISOLUX_CONSTANT uint kGlassTableAngles = 40u;
ISOLUX_CONSTANT uint kGlassTableRoughnesses = 24u;
ISOLUX_CONSTANT uint kGlassTableIndices = 48u;

// Words (of 16 bytes) a record.
ISOLUX_CONSTANT uint kNodeWords = 4u;
ISOLUX_CONSTANT uint kPrimitiveWords = 3u;
ISOLUX_CONSTANT uint kNormalWords = 3u;
ISOLUX_CONSTANT uint kTangentWords = 3u;
ISOLUX_CONSTANT uint kColorWords = 3u;
ISOLUX_CONSTANT uint kUvWords = 2u;
ISOLUX_CONSTANT uint kMaterialWords = 8u;
ISOLUX_CONSTANT uint kTextureWords = 3u;
ISOLUX_CONSTANT uint kLightWords = 4u;
ISOLUX_CONSTANT uint kFilterCells = 256u;

// A child slot of a node: host/accel/wide_bvh.h, WideChild.
ISOLUX_CONSTANT uint kEmptyChild = 0xFFFFFFFFu;
ISOLUX_CONSTANT uint kLeafBit = 0x80000000u;
ISOLUX_CONSTANT uint kLeafCountShift = 28u;
ISOLUX_CONSTANT uint kLeafFirstMask = 0x0FFFFFFFu;

ISOLUX_SHARED_END

#endif
