// One sample into a batch's running statistics (Welford 1962); the host joins batches in double.
#ifndef ISOLUX_FILM_ACCUMULATE_GLSL
#define ISOLUX_FILM_ACCUMULATE_GLSL

#include "core/math.glsl"
#include "shared/path_records.h"

// `precise`: the sum must not depend on how a driver contracts it, or batches would differ by more than rounding.
void accumulateSample(inout FilmRecord film, vec3 radiance) {
    film.counts.x += 1u;
    if (!isFiniteBits(radiance)) film.counts.w += 1u;
    if (radiance.x < 0.0 || radiance.y < 0.0 || radiance.z < 0.0) film.faults.x += 1u;
    precise vec3 before = radiance - film.mean.xyz;
    precise vec3 mean = film.mean.xyz + before / float(film.counts.x);
    precise vec3 after = radiance - mean;
    film.mean.xyz = mean;
    film.squaredDeviation.xyz += before * after;
    film.squaredDeviation.w += luminance(before) * luminance(after);
}

#endif
