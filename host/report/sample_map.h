// How many samples each pixel took, in false colour.
#pragma once

#include "film/film.h"
#include "film/image.h"

namespace isolux {

/// R, G, B of the sequential ramp (heatmap.h), from 0 to `maxSamples`.
[[nodiscard]] Image sampleMap(const Film& film, std::uint64_t maxSamples);

} // namespace isolux
