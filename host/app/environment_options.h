// The options that say what shines on the scene from infinitely far away, and the sky of scenes that have no light.
#pragma once

#include "report/run_report.h"
#include "scene/render_settings.h"
#include "scene/scene.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace isolux {

struct EnvironmentOptions {
    std::string source;             ///< "R,G,B", one number, a file or "none"; empty: what the scene has
    std::optional<double> rotation; ///< degrees, counter-clockwise seen from above
    std::optional<double> strength; ///< times the environment, whichever it is
};

/// Adds --environment and the others, in a group.
void addEnvironmentOptions(CLI::App& command, EnvironmentOptions& options);

enum class EnvironmentOrigin { none, scene, options, defaultSky };

/// What the options made of a scene's environment.
struct EnvironmentChoice {
    EnvironmentOrigin origin = EnvironmentOrigin::none;
    std::string file;    ///< of the map; empty: it is constant
    std::string options; ///< that give a scene the same environment again, a blank before each; empty: the scene's own
};

/// Puts the environment that the options ask for into the scene and its file into the scene's hash. A scene without
/// any light gets a sky of radiance 1, unless the options say "none" or no light is followed. Throws Error (bad input).
[[nodiscard]] EnvironmentChoice applyEnvironment(Scene& scene, const EnvironmentOptions& options,
                                                 const RenderSettings& settings);

/// Nothing where there is none.
[[nodiscard]] std::optional<EnvironmentSummary> summariseEnvironment(const Scene& scene,
                                                                     const EnvironmentChoice& choice);

} // namespace isolux
