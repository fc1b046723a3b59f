// One step of a stress test: a scene or a set of rays, tried on the device and on both references.
#pragma once

#include "gpu/device.h"
#include "report/stress.h"
#include "scene/render_settings.h"
#include "scene/scene.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// What a sample whose value differs from the expected one is a sign of.
enum class Symptom { leak, selfHit };

/// A scene in which every sample has the same value, but for rounding, and another one after a fault.
struct Probe {
    double value = 0.0;
    double faultChange = 1.0; ///< how much a fault changes a sample by, up or down, at least: more than rounding does
    Symptom symptom = Symptom::leak;
};

/// Which renderers a step is for. A step takes as long as the slowest of them.
enum class Renderers {
    all,
    deviceAndSingle, ///< where double takes too long and an answer in closed form is there
    deviceAlone
};

/// A scene to be rendered with the same random numbers by all. `settings` are those of the step: small images.
struct RenderTrial {
    Scene scene;
    RenderSettings settings;
    std::optional<double> expected;   ///< mean luminance of the image in closed form
    double expectedUncertainty = 0.0; ///< relative: how well the closed form is known
    std::optional<Probe> probe;
    /// The device's image must be, to the last bit, that of this scene times `imageFactor`, a power of two.
    std::shared_ptr<const Scene> sameBitsAs;
    double imageFactor = 1.0;
    Renderers renderers = Renderers::all;
};

/// Rays of a packed scene to nearest hits: aimed where tests fail.
struct AimedRay {
    Vec3d origin{0.0};
    Vec3d direction{0.0, 0.0, 1.0}; ///< of any length but zero
};

enum class RayCheck {
    closed,    ///< a ray that meets nothing is a leak
    bruteForce ///< the BVH must find what testing every primitive finds, to the last bit; as many differentBits as do
               ///< not
};

/// `make(first, count)` gives rays number first ... first + count - 1, always the same, in world space.
struct RayTrial {
    Scene scene;
    std::uint64_t count = 0;
    std::function<std::vector<AimedRay>(std::uint64_t first, std::size_t count)> make;
    RayCheck check = RayCheck::closed;
    Renderers renderers = Renderers::all;
};

/// What trials are run with. Everything a trial does ends early once `interrupted` says so.
struct StressBench {
    const Device& device;
    std::function<bool()> interrupted; ///< may be empty
    /// Instead of being rendered, scenes are handed to this, if it is there: for other renderers.
    std::function<void(const RenderTrial&)> exported{};
};

using Trial = std::function<std::vector<StressFigures>(const StressBench&)>;

/// The trials as functions. An Error in one renderer is that renderer's `failure`; a lost device is thrown on. What was
/// interrupted has no figures.
[[nodiscard]] Trial trialOf(std::function<RenderTrial()> make);
[[nodiscard]] Trial trialOf(std::function<RayTrial()> make);
/// A step that is neither; there is nothing to export.
[[nodiscard]] Trial trialBy(Trial run);

/// A step that has not been tried yet.
struct PlannedStep {
    double parameter = 0.0;
    std::string label;
    Trial trial;
};

/// A sweep that has not been tried yet: its StressSweep has no steps. The gentlest step is the first.
struct PlannedSweep {
    StressSweep about;
    std::vector<PlannedStep> steps;
};

/// `quick`: every family in some seconds, with about three steps a sweep, which are among those of `full`.
enum class Extent { full, quick };

} // namespace isolux
