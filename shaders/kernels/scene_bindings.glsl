// The scene's buffers, bound as texel and as storage buffers; one constant chooses which are read. Lavapipe gathers
// from texel buffers much faster; drivers with small texel-buffer limits use the others.
#ifndef ISOLUX_KERNELS_SCENE_BINDINGS_GLSL
#define ISOLUX_KERNELS_SCENE_BINDINGS_GLSL

#include "core/scene_access.glsl"
#include "shared/interface.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const bool kTexelBuffers = true;

layout(set = 0, binding = 0, std430) readonly buffer NodeBuffer { uvec4 nodeWords[]; };
layout(set = 0, binding = 1, std430) readonly buffer PrimitiveBuffer { uvec4 primitiveWords[]; };
layout(set = 0, binding = 2, std430) readonly buffer AttributeBuffer { uvec4 attributeWords[]; };
layout(set = 0, binding = 3, std430) readonly buffer TableBuffer { uvec4 tableWords[]; };
layout(set = 0, binding = 4) uniform usamplerBuffer nodeTexels;
layout(set = 0, binding = 5) uniform usamplerBuffer primitiveTexels;
layout(set = 0, binding = 6) uniform usamplerBuffer attributeTexels;
layout(set = 0, binding = 7) uniform usamplerBuffer tableTexels;

uvec4 fetchNode(uint word) { return kTexelBuffers ? texelFetch(nodeTexels, int(word)) : nodeWords[word]; }
uvec4 fetchPrimitive(uint word) { return kTexelBuffers ? texelFetch(primitiveTexels, int(word)) : primitiveWords[word]; }
uvec4 fetchAttribute(uint word) { return kTexelBuffers ? texelFetch(attributeTexels, int(word)) : attributeWords[word]; }
uvec4 fetchTable(uint word) { return kTexelBuffers ? texelFetch(tableTexels, int(word)) : tableWords[word]; }

#endif
