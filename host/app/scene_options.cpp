#include "app/scene_options.h"

#include "core/error.h"
#include "core/log.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>

namespace isolux {
namespace {

constexpr std::uint32_t kMaxEdge = 65536;
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;

std::uint32_t scaledEdge(double edge) {
    return static_cast<std::uint32_t>(std::clamp(std::round(edge), 1.0, static_cast<double>(kMaxEdge)));
}

void checkSettings(const RenderSettings& settings) {
    if (settings.width == 0 || settings.height == 0 || settings.width > kMaxEdge || settings.height > kMaxEdge)
        throwBadInput("--width, --height", fmt::format("must lie between 1 and {}", kMaxEdge));
    if (std::uint64_t{settings.width} * settings.height > kMaxPixels)
        throwBadInput("--width, --height",
                      fmt::format("{} x {} pixels are more than {}", settings.width, settings.height, kMaxPixels));
    if (settings.sampleCount == 0) throwBadInput("--spp", "must be at least 1");
    if (settings.firstSample > std::numeric_limits<std::uint32_t>::max() - settings.sampleCount)
        throwBadInput("--first-sample", "sample indices must stay below 2^32");
}

} // namespace

void addSceneOptions(CLI::App& command, SceneOptions& options) {
    command.add_option("SCENE", options.file, "A glTF 2.0 file (.gltf or .glb)")->required();
    command.add_option("--spp,--samples", options.samples, "Samples a pixel")->capture_default_str();
    command.add_option("--first-sample", options.firstSample, "Index of the first sample")->capture_default_str();
    command.add_option("--width", options.width, "Image width in pixels");
    command.add_option("--height", options.height, "Image height; by default from the width and the camera");
    command.add_option("--seed", options.seed, "Seed of the random numbers")->capture_default_str();
    command.add_option("--max-depth", options.maxDepth,
                       "Most bounces: 0 emitted light alone, 1 direct light (default: no limit)");
    command.add_option("--device", options.device, "Vulkan device by number or part of its name (default: the best)");
    command.add_flag("--validation", options.validation,
                     "Run under the Vulkan validation layers; any message is a failure");
    command.add_flag("-q,--quiet", options.quiet, "Print errors alone");
    command.add_flag("-v,--verbose", options.verbose, "Say what is being done");
}

Scene loadScene(const SceneOptions& options) {
    setVerbosity(options.quiet ? Verbosity::quiet : options.verbose ? Verbosity::verbose : Verbosity::normal);
    Scene scene = loadScene(std::filesystem::path(options.file));
    for (const std::string& warning : scene.warnings) spdlog::warn("{}: {}", options.file, warning);
    return scene;
}

RenderSettings settingsFor(const Scene& scene, const SceneOptions& options, std::uint32_t defaultWidth) {
    RenderSettings settings;
    const double aspect = scene.cameras.at(settings.camera).aspectRatio.value_or(4.0 / 3.0);
    settings.width = options.width.value_or(options.height ? scaledEdge(*options.height * aspect) : defaultWidth);
    settings.height = options.height.value_or(scaledEdge(settings.width / aspect));
    settings.seed = options.seed;
    settings.firstSample = options.firstSample;
    settings.sampleCount = options.samples;
    settings.maxDepth = options.maxDepth.value_or(kUnlimitedDepth);
    checkSettings(settings);
    return settings;
}

DeviceOptions deviceOptions(const SceneOptions& options) {
    return {options.device, options.validation ? Validation::on : Validation::off};
}

} // namespace isolux
