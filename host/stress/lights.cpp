// Lights of any size, brightness, distance and number.
#include "stress/families.h"
#include "stress/lights_parts.h"

#include <utility>

namespace isolux {

std::vector<PlannedSweep> lightSweeps(Extent extent) {
    std::vector<PlannedSweep> all;
    for (const auto sweepsOf : {lampSweeps, sphereLightSweeps, punctualSweeps, contrastSweeps})
        for (PlannedSweep& sweep : sweepsOf(extent)) all.push_back(std::move(sweep));
    return all;
}

} // namespace isolux
