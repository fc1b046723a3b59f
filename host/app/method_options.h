// The options that choose how to render: light transport, sampling, camera and intersection, shared by the commands
// that render.
#pragma once

#include "scene/render_settings.h"
#include "scene/scene.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace isolux {

struct MethodOptions {
    RenderSettings chosen;                 ///< what needs no look at other options
    std::string roulette = "throughput";   ///< as given: "off", "constant:0.3", "throughput"
    std::optional<double> ambientDistance; ///< nothing, here and below: not given
    std::optional<double> filterRadius;
    std::optional<double> aperture;
    std::optional<double> focus;
    bool countTests = false;

    [[nodiscard]] TraversalCounts counts() const { return countTests ? TraversalCounts::on : TraversalCounts::off; }
};

/// Adds --integrator and the others, in groups.
void addMethodOptions(CLI::App& command, MethodOptions& options);

/// The methods; the other settings have their defaults. Throws Error (bad input) if options do not fit each other.
[[nodiscard]] RenderSettings chosenMethods(const MethodOptions& options);

/// Throws Error (bad input) if methods do not fit the size, the depth and the samples, and warns of those that have no
/// effect.
void checkMethods(const RenderSettings& settings, const Scene& scene);

} // namespace isolux
