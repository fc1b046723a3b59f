// Binding numbers and specialisation constants: the contract between pipelines and kernels.
#ifndef ISOLUX_SHARED_INTERFACE_H
#define ISOLUX_SHARED_INTERFACE_H

#include "shared/types.h"

ISOLUX_SHARED_BEGIN

// Scene data is bound twice, as texel and as storage buffers; kSpecTexelBuffers says which are read.
ISOLUX_CONSTANT uint kBindNodes = 0u;
ISOLUX_CONSTANT uint kBindPrimitives = 1u;
ISOLUX_CONSTANT uint kBindNormals = 2u;
ISOLUX_CONSTANT uint kBindTables = 3u;
ISOLUX_CONSTANT uint kBindTexelOffset = 4u; // texel version: the same number plus this
ISOLUX_CONSTANT uint kBindRender = 8u;
ISOLUX_CONSTANT uint kBindPaths = 9u;
ISOLUX_CONSTANT uint kBindFilm = 10u;
ISOLUX_CONSTANT uint kBindStack = 11u;
ISOLUX_CONSTANT uint kBindCompletion = 12u;
ISOLUX_CONSTANT uint kBindRays = 13u; // intersection kernel: rays in, hits out
ISOLUX_CONSTANT uint kBindHits = 14u;
ISOLUX_CONSTANT uint kBindAovs = 15u;

ISOLUX_CONSTANT uint kSpecWorkgroupSize = 0u;
ISOLUX_CONSTANT uint kSpecTexelBuffers = 1u;
ISOLUX_CONSTANT uint kSpecStackSize = 2u;
ISOLUX_CONSTANT uint kSpecSpheres = 3u;
ISOLUX_CONSTANT uint kSpecLights = 4u; // one of kLights...
ISOLUX_CONSTANT uint kSpecSmoothNormals = 5u;
ISOLUX_CONSTANT uint kSpecRoulette = 6u;
ISOLUX_CONSTANT uint kSpecPathSignatures = 7u;
ISOLUX_CONSTANT uint kSpecBruteForce = 8u; // intersection kernel only
ISOLUX_CONSTANT uint kSpecAreaLights = 9u;
ISOLUX_CONSTANT uint kSpecPunctualLights = 10u;
ISOLUX_CONSTANT uint kSpecEnvironment = 11u;
ISOLUX_CONSTANT uint kSpecAovs = 12u;

ISOLUX_CONSTANT uint kLightsNone = 0u;
ISOLUX_CONSTANT uint kLightsOne = 1u;
ISOLUX_CONSTANT uint kLightsMany = 2u;

ISOLUX_SHARED_END

#endif
