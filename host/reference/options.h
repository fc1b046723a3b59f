// How the reference renders: choices that must not change the expectation of the image.
#pragma once

#include "scene/render_settings.h"

#include <optional>

namespace isolux {

/// The type of every quantity along a path. Sums over samples are double in both.
enum class Precision { doublePrecision, singlePrecision };

/// How rays find primitives: through the BVH, or by asking every primitive (which checks the BVH). Same hits, bit by
/// bit.
enum class Intersector { bvh, bruteForce };

struct ReferenceOptions {
    Precision precision = Precision::doublePrecision;
    Intersector intersector = Intersector::bvh;
    PathSignatures signatures = PathSignatures::off;
    Aovs aovs = Aovs::off;
    std::optional<double> seconds = std::nullopt; ///< stop after about this time, at least one sample a pixel
};

} // namespace isolux
