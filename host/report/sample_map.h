// How many samples each pixel took, in false colour: where an adaptive render spent its time.
#pragma once

#include "film/image.h"

#include <cstdint>

namespace isolux {

/// R, G, B from dark for none to bright for `maxSamples` (the sequential ramp of heatmap.h) and the counts themselves
/// as samples.Y. The metadata's isolux/sampleMapMax says which count is the brightest.
[[nodiscard]] Image sampleMap(const Film& film, std::uint64_t maxSamples);

} // namespace isolux
