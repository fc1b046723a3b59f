// What the plans of several families are made of: steps by decades, views and settings that leave little to chance.
#pragma once

#include "stress/shapes.h"
#include "stress/trial.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace isolux {

using TrialAt = std::function<RenderTrial(double parameter)>;

/// Powers of ten between two exponents, both included; the stride may be negative.
struct Decades {
    int first = 0;
    int last = 0;
    int stride = 1;
};

/// A step a power, labelled "1e-7".
[[nodiscard]] std::vector<PlannedStep> stepsBy(const Decades& decades, const TrialAt& trialAt);

/// Any parameters, labelled by their shortest words.
[[nodiscard]] std::vector<PlannedStep> stepsAt(const std::vector<double>& parameters, const TrialAt& trialAt);

/// Of a quick sweep: the first, the middle and the last.
[[nodiscard]] std::vector<PlannedStep> thinned(std::vector<PlannedStep> steps, Extent extent);

/// A rotation that leaves no coordinate of a plane, or of its normal, small.
[[nodiscard]] Mat4d askew();
[[nodiscard]] Vec3d placed(const Mat4d& pose, const Vec3d& point);

/// All rays run the same way; `halfHeight` is that of what is seen.
void parallelCamera(SceneBuilder& builder, const Vec3d& position, const Vec3d& target, double halfHeight);

/// Lights as they are seen and after one bounce, by default methods.
[[nodiscard]] RenderSettings directLight();
/// Light is found by scattering alone, and no path ends by chance: in a furnace no sample differs from another.
[[nodiscard]] RenderSettings scatteringAlone(std::uint32_t maxDepth);

[[nodiscard]] RenderTrial expecting(double mean, Scene scene, const RenderSettings& settings);

/// The mean of f(x, y) over [-halfSize, halfSize]^2, by the middles of cells x cells.
[[nodiscard]] double meanOverSquare(double halfSize, int cells, const std::function<double(double, double)>& f);

} // namespace isolux
