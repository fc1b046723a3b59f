// How the reference renders: choices that must not change the expectation of the image.
#pragma once

#include "core/progress.h"
#include "film/sample_plan.h"
#include "scene/render_settings.h"

#include <functional>

namespace isolux {

/// The type of every quantity along a path. Sums over samples are double in both.
enum class Precision { doublePrecision, singlePrecision };

/// Which normal tells the two sides of a surface apart. `geometric` is the written convention. `shading` is the rule of
/// renderers that ask the shading normal alone, such as Mitsuba: rays may then pass through the surface they leave. It
/// is there to tell how much of a difference from such a renderer is due to its rule.
enum class SideRule { geometric, shading };

struct ReferenceOptions {
    Precision precision = Precision::doublePrecision;
    PathSignatures signatures = PathSignatures::off;
    Aovs aovs = Aovs::off;
    SideRule sides = SideRule::geometric;
    TraversalCounts counts = TraversalCounts::off;
    StoppingRule stopping{};
    /// Told after each pass what is done; saying `no` ends the render there. May be empty.
    std::function<Continue(const Film&)> pass{};
};

} // namespace isolux
