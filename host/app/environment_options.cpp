#include "app/environment_options.h"

#include "app/validators.h"
#include "core/error.h"
#include "core/log.h"
#include "load/bytes.h"
#include "load/environment_file.h"
#include "scene/lights.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

namespace isolux {
namespace {

constexpr const char* kNoEnvironment = "none";

/// The numbers between commas; nothing if that is not what the text is.
std::optional<std::vector<double>> parseNumbers(const std::string& text) {
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        double value = 0.0;
        const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, value);
        if (error == std::errc::invalid_argument || stop != text.data() + end) return std::nullopt;
        numbers.push_back(error == std::errc{} ? value : std::numeric_limits<double>::infinity());
        begin = end + 1;
    }
    return numbers;
}

/// "0.5" or "1,0.9,0.8"; nothing if the text holds no numbers and may be a file's name.
std::optional<Vec3d> parseRadiance(const std::string& text) {
    const std::optional<std::vector<double>> numbers = parseNumbers(text);
    if (!numbers) return std::nullopt;
    for (const double value : *numbers)
        if (!(value >= 0.0 && value <= std::numeric_limits<float>::max()))
            throwBadInput("--environment", fmt::format("'{}' is not a radiance such as 1,1,1", text));
    if (numbers->size() == 1) return Vec3d(numbers->front());
    if (numbers->size() != 3) throwBadInput("--environment", "give one number or three: R,G,B");
    return Vec3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

/// Of the scene's files and this one: images of other maps are of other scenes.
std::string hashWith(const std::string& sceneHash, const std::filesystem::path& path) {
    constexpr std::size_t kChunk = std::size_t{1} << 20;
    ContentHash hash;
    const Bytes before(sceneHash.begin(), sceneHash.end());
    hash.add(before);
    std::ifstream file(path, std::ios::binary);
    Bytes chunk(kChunk);
    while (file.read(reinterpret_cast<char*>(chunk.data()), kChunk) || file.gcount() > 0)
        hash.add(ByteSpan(chunk).first(static_cast<std::size_t>(file.gcount())));
    return hash.hexadecimal();
}

bool isBlack(const EnvironmentMap& map) {
    return std::all_of(map.texels.begin(), map.texels.end(), [](const Vec3f& texel) { return texel == Vec3f(0.0f); });
}

void loadMap(Scene& scene, const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
        throwBadInput("--environment", fmt::format("'{}' is no file, no radiance such as 1,1,1 and not none", path));
    scene.environment = Environment{};
    scene.environment.radiance = Vec3d(1.0);
    scene.environment.map = loadEnvironmentMap(path);
    if (isBlack(*scene.environment.map)) {
        spdlog::warn("--environment: '{}' is black: the scene gets no light from it", path);
        scene.environment = Environment{};
    }
    scene.contentHash = hashWith(scene.contentHash, path);
}

/// Puts what --environment names into the scene.
EnvironmentChoice chooseSource(Scene& scene, const std::string& source) {
    if (source.empty()) return {scene.environment.emits() ? EnvironmentOrigin::scene : EnvironmentOrigin::none, "", ""};
    EnvironmentChoice choice{EnvironmentOrigin::options, "", " --environment " + source};
    if (source == kNoEnvironment) {
        scene.environment = Environment{};
        choice.origin = EnvironmentOrigin::none;
    } else if (const std::optional<Vec3d> radiance = parseRadiance(source)) {
        scene.environment = Environment{*radiance};
    } else {
        choice.file = source;
        loadMap(scene, source);
    }
    return choice;
}

void turnAndScale(Scene& scene, const EnvironmentOptions& options, EnvironmentChoice& choice) {
    Environment& environment = scene.environment;
    if (options.strength) {
        environment.radiance *= *options.strength;
        if (!(maxComponent(environment.radiance) <= std::numeric_limits<float>::max()))
            throwBadInput("--environment-strength", "the environment is brighter than single precision can hold");
        choice.options += fmt::format(" --environment-strength {}", *options.strength);
    }
    if (!options.rotation) return;
    if (!environment.map)
        spdlog::warn("--environment-rotation: without effect, as the environment is the same in all directions");
    const double turns = *options.rotation / 360.0;
    environment.rotation = turns - std::floor(turns);
    choice.options += fmt::format(" --environment-rotation {}", *options.rotation);
}

void checkEnvironmentThere(const EnvironmentOptions& options) {
    const char* idle = options.rotation   ? "--environment-rotation"
                       : options.strength ? "--environment-strength"
                                          : nullptr;
    if (idle != nullptr) throwBadInput(idle, "the scene has no environment; --environment gives it one");
}

/// Whether surfaces wait for light and nothing gives any. Unlit ones show their colour without.
bool lacksLight(const Scene& scene) {
    if (!scene.punctualLights.empty() || scene.environment.emits()) return false;
    const std::vector<bool> used = materialsInUse(scene);
    const auto is = [&](auto property) {
        for (std::size_t i = 0; i < used.size(); ++i)
            if (used[i] && property(scene.materials[i])) return true;
        return false;
    };
    if (!is([](const Material& material) { return !material.unlit; })) return false;
    // Emitters of no area or with black maps are in no light table; building one takes time, so only if it may matter.
    return !is([](const Material& material) { return material.emits(); }) || buildLightTable(scene).lights.empty();
}

} // namespace

void addEnvironmentOptions(CLI::App& command, EnvironmentOptions& options) {
    constexpr const char* kGroup = "Environment";
    command.add_option("--environment", options.source)
        ->group(kGroup)
        ->description("Instead of the scene's: constant radiance, R,G,B or one number; an equirectangular image file "
                      "(.hdr or .exr); or none (default: the scene's; 1 if it has no light at all)");
    command.add_option("--environment-rotation", options.rotation)
        ->group(kGroup)
        ->type_name("DEGREES")
        ->check(finiteNumber())
        ->description("Turn the image about the vertical, counter-clockwise seen from above");
    command.add_option("--environment-strength", options.strength)
        ->group(kGroup)
        ->check(nonNegativeNumber())
        ->description("Times the environment's radiance, wherever it is from");
}

EnvironmentChoice applyEnvironment(Scene& scene, const EnvironmentOptions& options, const RenderSettings& settings) {
    EnvironmentChoice choice = chooseSource(scene, options.source);
    if (options.source.empty() && followsLight(settings) && lacksLight(scene)) {
        scene.environment = Environment{Vec3d(1.0)};
        choice = {EnvironmentOrigin::defaultSky, "", " --environment 1"};
    }
    if (choice.origin != EnvironmentOrigin::none)
        turnAndScale(scene, options, choice);
    else if (followsLight(settings))
        checkEnvironmentThere(options);
    return choice;
}

std::optional<EnvironmentSummary> summariseEnvironment(const Scene& scene, const EnvironmentChoice& choice) {
    const Environment& environment = scene.environment;
    if (!environment.emits()) return std::nullopt;
    EnvironmentSummary summary;
    summary.radiance = environment.radiance;
    summary.extent = environment.extent == EnvironmentExtent::sphere ? "sphere" : "upper half";
    if (environment.map) {
        summary.map = choice.file.empty() ? environment.map->name : choice.file;
        summary.rotation = 360.0 * environment.rotation;
    }
    if (choice.origin == EnvironmentOrigin::defaultSky) summary.origin = SkyOrigin::byDefault;
    return summary;
}

} // namespace isolux
