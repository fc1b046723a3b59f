// `isolux stress`: how far each kind of stiffness may be pushed, on the device and on both references.
#include "app/commands.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/revision.h"
#include "app/scene_options.h"
#include "core/log.h"
#include "core/platform.h"
#include "core/stopwatch.h"
#include "report/format.h"
#include "stress/export.h"
#include "stress/families.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

namespace isolux {
namespace {

namespace fs = std::filesystem;

struct StressCommand {
    SceneOptions run;
    std::vector<std::string> families; ///< empty: all
    std::vector<std::string> beside;   ///< reports of other renderers
    std::string folder;
    std::string exportFolder;
    bool quick = false;
    bool json = false;
};

struct Planned {
    StressFamily family;
    std::vector<PlannedSweep> sweeps;
};

std::vector<std::string> familyNames() {
    std::vector<std::string> names;
    for (const PlannedFamily& family : stressFamilies()) names.push_back(family.name);
    return names;
}

std::vector<Planned> plan(const StressCommand& command) {
    std::vector<Planned> planned;
    for (const PlannedFamily& family : stressFamilies()) {
        const bool asked = std::ranges::find(command.families, family.name) != command.families.end();
        if (!command.families.empty() && !asked) continue;
        planned.push_back(
            {{family.name, family.title, {}}, family.sweeps(command.quick ? Extent::quick : Extent::full)});
    }
    return planned;
}

std::size_t stepCount(const std::vector<Planned>& planned) {
    std::size_t count = 0;
    for (const Planned& family : planned)
        for (const PlannedSweep& sweep : family.sweeps) count += sweep.steps.size();
    return count;
}

/// Tries one step after another until the user asks to stop; a step that was interrupted is left out.
class Sweeper {
public:
    Sweeper(const Device& device, ProgressDisplay display, std::size_t steps)
        : bench_{device, interruptRequested, {}}, bar_("stress", display), progress_(bar_.callback()), steps_(steps) {}

    StressSweep run(const PlannedSweep& planned) {
        StressSweep sweep = planned.about;
        for (const PlannedStep& step : planned.steps) {
            std::vector<StressFigures> figures = step.trial(bench_);
            if (interruptRequested()) break;
            sweep.steps.push_back({step.parameter, step.label, std::move(figures)});
            static_cast<void>(progress_(static_cast<double>(++done_) / static_cast<double>(steps_)));
        }
        return sweep;
    }

private:
    StressBench bench_;
    ProgressBar bar_;
    ProgressCallback progress_;
    std::size_t steps_;
    std::size_t done_ = 0;
};

void runFamilies(StressRun& result, const StressCommand& command, const Device& device) {
    std::vector<Planned> planned = plan(command);
    Sweeper sweeper(device, progressDisplay(command.run), stepCount(planned));
    for (Planned& family : planned) {
        for (const PlannedSweep& sweep : family.sweeps) {
            if (interruptRequested()) break;
            StressSweep found = sweeper.run(sweep);
            if (!found.steps.empty()) family.family.sweeps.push_back(std::move(found));
        }
        if (!family.family.sweeps.empty()) result.families.push_back(std::move(family.family));
    }
}

/// Samples a pixel of exported scenes, over those of the step: others share no random numbers with the truth.
constexpr std::uint32_t kMoreSamples = 16;

/// A file a step, FAMILY-SWEEP-NUMBER.json; steps that are no scenes have none.
ExitCode exportSteps(const StressCommand& command) {
    const Device device(deviceOptions(command.run));
    fs::create_directories(command.exportFolder);
    for (const Planned& planned : plan(command))
        for (const PlannedSweep& sweep : planned.sweeps)
            for (std::size_t i = 0; i < sweep.steps.size(); ++i) {
                if (interruptRequested()) return ExitCode::interrupted;
                const auto write = [&](const RenderTrial& trial) {
                    nlohmann::ordered_json json = exportTrial(trial, kMoreSamples);
                    if (json.is_null()) return;
                    json["family"] = planned.family.name;
                    json["sweep"] = sweep.about.name;
                    json["label"] = sweep.steps[i].label;
                    const std::string name = fmt::format("{}-{}-{:02}.json", planned.family.name, sweep.about.name, i);
                    writeText((fs::path(command.exportFolder) / name).string(), json.dump() + "\n");
                };
                static_cast<void>(sweep.steps[i].trial({device, interruptRequested, write}));
            }
    return ExitCode::success;
}

std::vector<nlohmann::ordered_json> readAll(const std::vector<std::string>& files) {
    std::vector<nlohmann::ordered_json> documents;
    for (const std::string& file : files) {
        std::ifstream stream(file);
        documents.push_back(nlohmann::ordered_json::parse(stream, nullptr, false));
        if (documents.back().is_discarded()) throwBadInput(file, "it cannot be read as JSON");
    }
    return documents;
}

void print(const StressCommand& command, const StressRun& result) {
    if (command.json) {
        fmt::print("{}", jsonText(toJson(result)));
        return;
    }
    if (!command.run.quiet)
        for (const StressFamily& family : result.families) fmt::print("{}", toText(family));
}

void conclude(const std::vector<std::string>& broken, const Device& device) {
    for (const std::string& line : broken) spdlog::error("{}", line);
    if (!device.validationMessages().empty())
        spdlog::error("{} validation messages", device.validationMessages().size());
}

ExitCode run(const StressCommand& command) {
    if (command.run.quiet) setVerbosity(Verbosity::quiet);
    if (!command.folder.empty()) fs::create_directories(command.folder);
    if (!command.exportFolder.empty()) return exportSteps(command);
    const std::vector<nlohmann::ordered_json> others = readAll(command.beside);
    const Device device(deviceOptions(command.run));
    StressRun result;
    result.version = versionText();
    result.device = device.description().name;
    result.driver = device.description().driverVersion;
    result.quick = command.quick;
    const Stopwatch watch;
    runFamilies(result, command, device);
    result.seconds = watch.seconds();
    for (std::size_t i = 0; i < others.size(); ++i) addFigures(result, others[i], command.beside[i]);
    print(command, result);
    if (!command.folder.empty()) {
        writeText((fs::path(command.folder) / "stress.json").string(), jsonText(toJson(result)));
        writeText((fs::path(command.folder) / "stress.html").string(), toHtml(result));
    }
    const std::vector<std::string> broken = brokenPromises(result.families);
    conclude(broken, device);
    if (interruptRequested()) {
        spdlog::warn("interrupted: what was tried until then is in the report");
        return ExitCode::interrupted;
    }
    return broken.empty() && device.validationMessages().empty() ? ExitCode::success : ExitCode::failure;
}

} // namespace

void addStressCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("stress", "Push scenes until they break, and say with numbers where they do");
    auto command = std::make_shared<StressCommand>();
    sub->add_option("--family", command->families, "A family, may be repeated (default: all)")
        ->check(CLI::IsMember(familyNames()));
    sub->add_flag("--quick", command->quick, "Every family, about three steps a sweep");
    sub->add_option("-o,--output", command->folder, "Folder for stress.json and stress.html");
    sub->add_option("--beside", command->beside, "A report of another renderer to show beside ours; may be repeated")
        ->check(CLI::ExistingFile);
    sub->add_option("--export", command->exportFolder,
                    "Instead of rendering, write each step's scene as JSON to this folder, for other renderers");
    sub->add_flag("--json", command->json, "Print JSON");
    addRunOptions(*sub, command->run);
    sub->footer(fmt::format(
        "Families: {}.\n"
        "Device, single and double reference take the same random numbers, so a bias of 0.1 % is seen with few\n"
        "samples. A step holds if the 95 % interval of its relative bias lies within 0.1 % and nothing is counted\n"
        "that should not happen. Ctrl-C keeps the steps that are done.\n"
        "Exit codes: 0 no fault and no step beyond 0.1 %, 1 otherwise, 75 try again, 130 interrupted.\n"
        "Examples:\n"
        "  isolux stress --quick\n"
        "  isolux stress -o stress\n"
        "  isolux stress --family scale --family lights --json",
        fmt::join(familyNames(), ", ")));
    sub->callback([command, &result] { result = run(*command); });
}

} // namespace isolux
