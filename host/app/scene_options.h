// The options that say what to render and on which device, shared by the commands that render.
#pragma once

#include "app/environment_options.h"
#include "app/progress_bar.h"
#include "gpu/device.h"
#include "load/gltf.h"
#include "scene/render_settings.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace isolux {

struct SceneOptions {
    std::string file;
    std::optional<std::uint32_t> width;
    std::optional<std::uint32_t> height;
    std::string size;   ///< "WxH" instead of the two
    std::string camera; ///< number or part of a name; empty: the first
    EnvironmentOptions environment;
    std::optional<std::uint32_t> maxDepth;
    std::uint32_t samples = 64;
    std::uint32_t firstSample = 0;
    std::uint64_t seed = 0;
    std::string device;
    double dispatchMilliseconds = 70.0;
    std::string progress = "auto";
    std::string cacheFolder; ///< of compiled kernels; empty: the user's
    bool noCache = false;
    bool validation = false;
    bool quiet = false;
    bool verbose = false;
};

/// Adds those that say on which device and how talkatively: the last of the fields, from `device` on.
void addRunOptions(CLI::App& command, SceneOptions& options);

/// Adds SCENE, --spp, --width, --seed and the others, with `options`' values as defaults.
void addSceneOptions(CLI::App& command, SceneOptions& options);

/// Loads the scene and logs its warnings.
[[nodiscard]] Scene loadScene(const SceneOptions& options);

/// `methods` with the options' camera, size, samples and depth: a size that is not given follows from the other by the
/// camera's aspect ratio, the width of `methods` if neither is. Throws Error if there is no such camera, or the image
/// or the range of samples is empty or too large.
[[nodiscard]] RenderSettings settingsFor(const Scene& scene, const SceneOptions& options,
                                         const RenderSettings& methods);

[[nodiscard]] DeviceOptions deviceOptions(const SceneOptions& options);

[[nodiscard]] ProgressDisplay progressDisplay(const SceneOptions& options);

} // namespace isolux
