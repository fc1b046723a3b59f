// The lobe kernel's input and output: one record a query.
#ifndef ISOLUX_SHARED_LOBE_RECORDS_H
#define ISOLUX_SHARED_LOBE_RECORDS_H

#include "shared/types.h"

ISOLUX_SHARED_BEGIN

// Directions are unit, in the frame about the shading normal.
struct LobeQueryRecord {
    vec4 outgoing; // above the surface; w: material, as bits
    vec4 incoming; // what is evaluated, unless a direction is sampled; w unused
    uvec4 random;  // x, y, w: words of a scattering block; z: kLobeQuery... bits
};
ISOLUX_CHECK_SIZE(LobeQueryRecord, 48);

struct LobeAnswerRecord {
    vec4 directionPdf;  // as sampled, zero where that led nowhere, or `incoming`; w: density, delta lobes apart
    vec4 value;         // f |cos| of all lobes but delta lobes, or of a sampled delta lobe its weight; w unused
    vec4 probabilities; // of glass, of the specular lobe if it is not glass, of not sampling a delta lobe; w unused
    vec4 compensation;  // x: of glass; others unused
    uvec4 outcome;      // x: kLobe... that was sampled, y: 1 if it is a delta lobe; z, w unused
};
ISOLUX_CHECK_SIZE(LobeAnswerRecord, 80);

struct LobeParameters {
    uvec4 tables; // first word of materials and of albedo tables, number of queries; w unused
};
ISOLUX_CHECK_SIZE(LobeParameters, 16);

ISOLUX_CONSTANT uint kBindLobeQueries = 13u; // beside the scene's of interface.h
ISOLUX_CONSTANT uint kBindLobeAnswers = 14u;

ISOLUX_CONSTANT uint kLobeQuerySample = 1u; // a direction is sampled, then evaluated
ISOLUX_CONSTANT uint kLobeQueryBack = 2u;   // `outgoing` lies on the back

ISOLUX_SHARED_END

#endif
