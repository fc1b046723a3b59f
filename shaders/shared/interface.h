// Binding numbers and specialisation constants: the contract between pipelines and kernels.
#ifndef ISOLUX_SHARED_INTERFACE_H
#define ISOLUX_SHARED_INTERFACE_H

#include "shared/types.h"

ISOLUX_SHARED_BEGIN

// Scene data is bound twice, as texel and as storage buffers; kSpecTexelBuffers says which are read.
ISOLUX_CONSTANT uint kBindNodes = 0u;
ISOLUX_CONSTANT uint kBindPrimitives = 1u;
ISOLUX_CONSTANT uint kBindAttributes = 2u;
ISOLUX_CONSTANT uint kBindTables = 3u;
ISOLUX_CONSTANT uint kBindTexelOffset = 4u; // texel version: the same number plus this
ISOLUX_CONSTANT uint kBindRender = 8u;
ISOLUX_CONSTANT uint kBindPaths = 9u;
ISOLUX_CONSTANT uint kBindFilm = 10u;
ISOLUX_CONSTANT uint kBindStack = 11u;
ISOLUX_CONSTANT uint kBindCompletion = 12u;
ISOLUX_CONSTANT uint kBindRays = 13u; // intersection kernel: rays in, hits out (the lobe kernel: queries, answers)
ISOLUX_CONSTANT uint kBindHits = 14u;
ISOLUX_CONSTANT uint kBindAovs = 15u;
ISOLUX_CONSTANT uint kBindPixels = 16u;
ISOLUX_CONSTANT uint kBindSamples = 17u;

ISOLUX_CONSTANT uint kSpecWorkgroupSize = 0u;
ISOLUX_CONSTANT uint kSpecTexelBuffers = 1u;
ISOLUX_CONSTANT uint kSpecStackSize = 2u;
ISOLUX_CONSTANT uint kSpecSpheres = 3u;
ISOLUX_CONSTANT uint kSpecLights = 4u; // one of kLights...
ISOLUX_CONSTANT uint kSpecSmoothNormals = 5u;
ISOLUX_CONSTANT uint kSpecRoulette = 6u; // one of kRoulette...
ISOLUX_CONSTANT uint kSpecPathSignatures = 7u;
ISOLUX_CONSTANT uint kSpecBruteForce = 8u; // intersection kernel only
ISOLUX_CONSTANT uint kSpecAreaLights = 9u;
ISOLUX_CONSTANT uint kSpecPunctualLights = 10u;
ISOLUX_CONSTANT uint kSpecEnvironment = 11u;
ISOLUX_CONSTANT uint kSpecAovs = 12u;
ISOLUX_CONSTANT uint kSpecSampler = 13u;       // one of kSampler...
ISOLUX_CONSTANT uint kSpecIntegrator = 14u;    // one of kIntegrator...
ISOLUX_CONSTANT uint kSpecLightSampling = 15u; // one of kLightSampling...
ISOLUX_CONSTANT uint kSpecBalanceHeuristic = 16u;
ISOLUX_CONSTANT uint kSpecLightLoop = 17u;   // more than one light sample a shading point
ISOLUX_CONSTANT uint kSpecAllLights = 18u;   // each light is sampled
ISOLUX_CONSTANT uint kSpecBounceRange = 19u; // bounces before a first one do not count
ISOLUX_CONSTANT uint kSpecThinLens = 20u;
ISOLUX_CONSTANT uint kSpecPixelFilter = 21u;    // other than the box
ISOLUX_CONSTANT uint kSpecEveryPrimitive = 22u; // no BVH
ISOLUX_CONSTANT uint kSpecMollerTrumbore = 23u;
ISOLUX_CONSTANT uint kSpecTraversalCounts = 24u;
ISOLUX_CONSTANT uint kSpecKeepSamples = 25u; // each sample's radiance goes to kBindSamples
ISOLUX_CONSTANT uint kSpecEnvironmentMap = 26u;
ISOLUX_CONSTANT uint kSpecSpecular = 27u;
ISOLUX_CONSTANT uint kSpecRoughSpecular = 28u;
ISOLUX_CONSTANT uint kSpecGlass = 29u;
ISOLUX_CONSTANT uint kSpecRoughGlass = 30u;
ISOLUX_CONSTANT uint kSpecSolids = 31u;
ISOLUX_CONSTANT uint kSpecAbsorption = 32u;
ISOLUX_CONSTANT uint kSpecBaseColorMaps = 33u;
ISOLUX_CONSTANT uint kSpecMetallicRoughnessMaps = 34u;
ISOLUX_CONSTANT uint kSpecNormalMaps = 35u;
ISOLUX_CONSTANT uint kSpecEmissionMaps = 36u;
ISOLUX_CONSTANT uint kSpecTransmissionMaps = 37u; // and of thickness
ISOLUX_CONSTANT uint kSpecSpecularMaps = 38u;
ISOLUX_CONSTANT uint kSpecVertexColors = 39u;
ISOLUX_CONSTANT uint kSpecAlphaMask = 40u;
ISOLUX_CONSTANT uint kSpecAlphaBlend = 41u;
ISOLUX_CONSTANT uint kSpecUnlit = 42u;
ISOLUX_CONSTANT uint kSpecBackFaceCulling = 43u;
ISOLUX_CONSTANT uint kSpecCoincident = 44u;

ISOLUX_CONSTANT uint kLightsNone = 0u;
ISOLUX_CONSTANT uint kLightsOne = 1u;
ISOLUX_CONSTANT uint kLightsMany = 2u;

ISOLUX_CONSTANT uint kRouletteOff = 0u;
ISOLUX_CONSTANT uint kRouletteConstant = 1u;
ISOLUX_CONSTANT uint kRouletteThroughput = 2u;

ISOLUX_CONSTANT uint kSamplerIndependent = 0u;
ISOLUX_CONSTANT uint kSamplerStratified = 1u;
ISOLUX_CONSTANT uint kSamplerSobol = 2u;
ISOLUX_CONSTANT uint kSamplerSobolBlueNoise = 3u;

ISOLUX_CONSTANT uint kIntegratorPath = 0u;
ISOLUX_CONSTANT uint kIntegratorNormals = 1u;
ISOLUX_CONSTANT uint kIntegratorAlbedo = 2u;
ISOLUX_CONSTANT uint kIntegratorDepth = 3u;
ISOLUX_CONSTANT uint kIntegratorAmbient = 4u;

ISOLUX_CONSTANT uint kLightSamplingHemisphere = 0u;
ISOLUX_CONSTANT uint kLightSamplingBsdf = 1u;
ISOLUX_CONSTANT uint kLightSamplingLight = 2u;
ISOLUX_CONSTANT uint kLightSamplingMis = 3u;

ISOLUX_SHARED_END

#endif
