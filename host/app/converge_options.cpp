#include "app/converge_options.h"

#include "app/validators.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <string_view>

namespace isolux {
namespace {

constexpr std::uint32_t kMostSamples = 1u << 20;
constexpr std::uint32_t kMostSeeds = 4096;

void addSelection(CLI::App& command, ConvergeOptions& options) {
    command.get_option("SCENE")->required(false);
    for (const char* name : {"--spp", "--first-sample"}) command.remove_option(command.get_option(name));
    command.get_option("--seed")->description("The first seed");
    command.get_option("--cache-dir")
        ->description("Where references and compiled kernels are kept, these also by drivers (default: the user's "
                      "cache)");
    command.get_option("--no-cache")->description("Keep and read neither; drivers may keep kernels all the same");
    command.add_option("--backend", options.backend, "What renders")
        ->check(CLI::IsMember({"vulkan", "reference"}))
        ->capture_default_str();
    command.add_option("--variant", options.variants)
        ->type_name("NAME:OPTIONS")
        ->allow_extra_args(false)
        ->description("A way to render the image, with options of render; may be repeated (default: one, 'default', "
                      "of the options beside it, which hold for all)");
}

void addMeasuring(CLI::App& command, ConvergeOptions& options) {
    constexpr const char* kGroup = "Measuring";
    command.add_option("--seeds", options.seeds, "Independent renders of each variant")
        ->group(kGroup)
        ->check(CLI::Range(2u, kMostSeeds))
        ->capture_default_str();
    command.add_option("--max-spp", options.maxSamples)
        ->group(kGroup)
        ->check(CLI::Range(1u, kMostSamples))
        ->description(fmt::format("Samples a pixel, on average, at which each render ends (default: {}, or what "
                                  "--max-time allows)",
                                  kUsualSamples));
    command.add_option("--max-time", options.maxSeconds)
        ->group(kGroup)
        ->check(positiveNumber())
        ->description("Seconds of rendering in each of which as many checkpoints are taken as fit");
    command.add_option("--errors", options.errors, "Relative RMSEs whose times are asked for, separated by commas")
        ->group(kGroup)
        ->delimiter(',')
        ->check(positiveNumber())
        ->capture_default_str();
    command.add_option("--flip-seeds", options.flipSeeds, "Take FLIP of the first so many seeds: it costs time")
        ->group(kGroup)
        ->capture_default_str();
    command.add_option("--fit", options.fit, "Instead of measuring: what follows from this CSV file of another run")
        ->group(kGroup)
        ->type_name("FILE");
    command.add_option("-o,--output", options.folder, "Where the results go; made if it is not there")
        ->type_name("DIR")
        ->required();
    command.add_flag("--no-images", options.noImages, "Write no images of equal time");
}

void addReferences(CLI::App& command, ConvergeOptions& options) {
    constexpr const char* kGroup = "Reference";
    CLI::Option* files =
        command.add_option("--reference", options.references)
            ->group(kGroup)
            ->type_name("FILE")
            ->allow_extra_args(false)
            ->description("An image to measure against that carries its variance, or two independent ones (default: "
                          "two are rendered, and kept in the cache)");
    command.add_option("--reference-spp", options.referenceSamples)
        ->group(kGroup)
        ->excludes(files)
        ->check(CLI::Range(2u, std::numeric_limits<std::uint32_t>::max()))
        ->description(
            fmt::format("Samples a pixel of each (default: {} times those at which renders end)", kReferenceFactor));
}

/// A word of a command line: quoted where a shell would read it otherwise.
std::string shellWord(const std::string& word) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("-_./:=,+@%").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

} // namespace

void addConvergeOptions(CLI::App& command, ConvergeOptions& options) {
    addSceneOptions(command, options.scene);
    addSelection(command, options);
    addMeasuring(command, options);
    addReferences(command, options);
    addStoppingOptions(command, options.common.stopping);
    command.remove_option(command.get_option("--time"));
    addMethodOptions(command, options.common.methods);
    command.remove_option(command.get_option("--count-tests"));
}

std::string commandLineOf(const CLI::App& command) {
    std::string text = "isolux " + command.get_name();
    for (const CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->count() > 0; })) {
        const bool flag = option->get_type_size() == 0;
        for (const std::string& value : option->results()) {
            if (!option->get_positional()) text += " " + option->get_name();
            if (!flag) text += " " + shellWord(value);
        }
    }
    return text;
}

} // namespace isolux
