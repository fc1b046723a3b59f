#include "app/scene_options.h"
#include "app/validators.h"

#include "core/error.h"
#include "core/log.h"
#include "core/platform.h"

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

/// "640x480"
void parseSize(const std::string& text, RenderSettings& settings) {
    const std::size_t cross = text.find('x');
    const auto edge = [&](const std::string& digits) {
        const bool number =
            !digits.empty() && digits.size() < 7 && digits.find_first_not_of("0123456789") == std::string::npos;
        if (!number) throwBadInput("--size", fmt::format("'{}' is not a size such as 640x480", text));
        return static_cast<std::uint32_t>(std::stoul(digits));
    };
    settings.width = edge(text.substr(0, cross));
    settings.height = edge(cross == std::string::npos ? "" : text.substr(cross + 1));
}

/// The camera of a number, of a name, or of the only name that contains the text.
std::uint32_t findCamera(const Scene& scene, const std::string& text) {
    if (text.empty()) return 0;
    std::vector<std::uint32_t> matches;
    std::string names;
    for (std::uint32_t i = 0; i < scene.cameras.size(); ++i) {
        const std::string& name = scene.cameras[i].name;
        if (name == text || text == std::to_string(i)) return i;
        if (name.find(text) != std::string::npos) matches.push_back(i);
        names += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, name);
    }
    if (matches.size() == 1) return matches.front();
    throwBadInput("--camera", fmt::format("{} camera matches '{}'; there are: {}",
                                          matches.empty() ? "no" : "more than one", text, names));
}

/// The folder that was asked for is also that of the caches which drivers keep by themselves (Mesa's and NVIDIA's):
/// where they have one, they tell nothing that could be kept here. Not if nothing can be written there: Mesa would do
/// without, and 22.3 then compiles for every dispatch.
void keepDriverCachesIn(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    if (!isWritableFolder(folder)) return;
    const std::filesystem::path absolute = std::filesystem::absolute(folder, ignored);
    for (const char* variable : {"MESA_SHADER_CACHE_DIR", "__GL_SHADER_DISK_CACHE_PATH"})
        setDefaultVariable(variable, absolute.string());
}

void checkSettings(const RenderSettings& settings) {
    if (settings.width == 0 || settings.height == 0 || settings.width > kMaxEdge || settings.height > kMaxEdge)
        throwBadInput("image size", fmt::format("{} x {}: edges must lie between 1 and {} pixels", settings.width,
                                                settings.height, kMaxEdge));
    if (std::uint64_t{settings.width} * settings.height > kMaxPixels)
        throwBadInput("image size",
                      fmt::format("{} x {} pixels are more than {}", settings.width, settings.height, kMaxPixels));
    if (settings.firstSample == std::numeric_limits<std::uint32_t>::max())
        throwBadInput("--first-sample", "sample indices must stay below 2^32 - 1");
    if (settings.sampleCount == 0) throwBadInput("--spp", "must be at least 1");
    if (settings.firstSample > std::numeric_limits<std::uint32_t>::max() - settings.sampleCount)
        throwBadInput("--first-sample", "sample indices must stay below 2^32");
}

} // namespace

void addRunOptions(CLI::App& command, SceneOptions& options) {
    command.add_option("--device", options.device, "Vulkan device by number or part of its name (default: the best)");
    command.add_option("--progress", options.progress, "Bar or lines, JSON lines for programs, or nothing")
        ->check(CLI::IsMember({"auto", "json", "none"}))
        ->capture_default_str();
    CLI::Option* cache =
        command.add_option("--cache-dir", options.cacheFolder)
            ->type_name("DIR")
            ->description("Where compiled kernels are kept, also by drivers (default: the user's cache)");
    command.add_flag("--no-cache", options.noCache, "Neither read nor keep compiled kernels; drivers may all the same")
        ->excludes(cache);
    command.add_flag("--validation", options.validation,
                     "Run under the Vulkan validation layers; any message is a failure");
    command.add_flag("-q,--quiet", options.quiet, "Print errors alone");
    command.add_flag("-v,--verbose", options.verbose, "Say what is being done");
}

void addSceneOptions(CLI::App& command, SceneOptions& options) {
    command.add_option("SCENE", options.file, "A glTF 2.0 file (.gltf or .glb)")->required();
    command.add_option("--spp,--samples", options.samples, "Samples a pixel")->capture_default_str();
    command.add_option("--first-sample", options.firstSample, "Index of the first sample")->capture_default_str();
    CLI::Option* width = command.add_option("--width", options.width, "Image width in pixels");
    CLI::Option* height =
        command.add_option("--height", options.height, "Image height; by default from the width and the camera");
    command.add_option("--size", options.size, "Both, as WxH")->excludes(width)->excludes(height);
    command.add_option("--camera", options.camera, "Camera by number or part of its name (default: the first)");
    command.add_option("--seed", options.seed, "Seed of the random numbers")->capture_default_str();
    command.add_option("--max-depth", options.maxDepth,
                       "Most bounces: 0 emitted light alone, 1 direct light (default: no limit)");
    command.add_option("--dispatch-ms", options.dispatchMilliseconds, "How long one dispatch should last, about")
        ->check(finiteNumber())
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    addRunOptions(command, options);
    addEnvironmentOptions(command, options.environment);
}

Scene loadScene(const SceneOptions& options) {
    setVerbosity(options.quiet ? Verbosity::quiet : options.verbose ? Verbosity::verbose : Verbosity::normal);
    Scene scene = loadScene(std::filesystem::path(options.file));
    for (const std::string& warning : scene.warnings) spdlog::warn("{}: {}", options.file, warning);
    return scene;
}

RenderSettings settingsFor(const Scene& scene, const SceneOptions& options, const RenderSettings& methods) {
    RenderSettings settings = methods;
    settings.camera = findCamera(scene, options.camera);
    const double aspect = scene.cameras.at(settings.camera).aspectRatio.value_or(4.0 / 3.0);
    settings.width = options.width.value_or(options.height ? scaledEdge(*options.height * aspect) : methods.width);
    settings.height = options.height.value_or(scaledEdge(settings.width / aspect));
    if (!options.size.empty()) parseSize(options.size, settings);
    settings.seed = options.seed;
    settings.firstSample = options.firstSample;
    settings.sampleCount = options.samples;
    settings.maxDepth = options.maxDepth.value_or(kUnlimitedDepth);
    checkSettings(settings);
    return settings;
}

ProgressDisplay progressDisplay(const SceneOptions& options) {
    if (options.progress == "json") return ProgressDisplay::json;
    return options.quiet || options.progress == "none" ? ProgressDisplay::hidden : ProgressDisplay::shown;
}

DeviceOptions deviceOptions(const SceneOptions& options) {
    if (!options.cacheFolder.empty()) keepDriverCachesIn(options.cacheFolder);
    std::filesystem::path cache = options.cacheFolder;
    if (cache.empty() && !options.noCache) cache = userCacheFolder();
    return {options.device, options.validation ? Validation::on : Validation::off, cache};
}

} // namespace isolux
