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

/// A report of another renderer.
struct Beside {
    std::string file;
    nlohmann::ordered_json document;
};

std::vector<Beside> readBeside(const std::vector<std::string>& files) {
    std::vector<Beside> all;
    for (const std::string& file : files) {
        std::ifstream stream(file);
        all.push_back({file, nlohmann::ordered_json::parse(stream, nullptr, false)});
        if (all.back().document.is_discarded()) throwBadInput(file, "it cannot be read as JSON");
    }
    return all;
}

void addBeside(StressRun& run, const std::vector<Beside>& beside) {
    for (const Beside& other : beside) addFigures(run, other.document, other.file);
}

/// Finds what is wrong with them before hours are spent on figures to go beside theirs.
void checkBeside(const std::vector<Beside>& beside, const std::vector<Planned>& planned) {
    StressRun untried;
    for (const Planned& family : planned) {
        StressFamily& copy = untried.families.emplace_back(family.family);
        for (const PlannedSweep& sweep : family.sweeps) {
            StressSweep& steps = copy.sweeps.emplace_back(sweep.about);
            for (const PlannedStep& step : sweep.steps) steps.steps.push_back({step.parameter, step.label, {}});
        }
    }
    addBeside(untried, beside);
}

/// What was found until now.
class Findings {
public:
    Findings(const StressCommand& command, const Device& device, std::vector<Beside> beside)
        : folder_(command.folder), beside_(std::move(beside)) {
        run_.version = versionText();
        run_.device = device.description().name;
        run_.driver = device.description().driverVersion;
        run_.quick = command.quick;
    }

    /// A place for the family's sweeps.
    [[nodiscard]] StressFamily& add(const StressFamily& family) { return run_.families.emplace_back(family); }

    /// What of it has steps, with the other renderers' figures.
    [[nodiscard]] StressRun report() const {
        StressRun run = run_;
        run.seconds = watch_.seconds();
        for (StressFamily& family : run.families)
            std::erase_if(family.sweeps, [](const StressSweep& sweep) { return sweep.steps.empty(); });
        std::erase_if(run.families, [](const StressFamily& family) { return family.sweeps.empty(); });
        addBeside(run, beside_);
        return run;
    }

    /// To the folder, if there is one.
    void write() const {
        if (folder_.empty()) return;
        const StressRun run = report();
        writeText((folder_ / "stress.json").string(), jsonText(toJson(run)));
        writeText((folder_ / "stress.html").string(), toHtml(run));
    }

private:
    fs::path folder_;
    std::vector<Beside> beside_;
    StressRun run_;
    Stopwatch watch_;
};

/// Tries one step after another until the user asks to stop; a step that was interrupted is left out.
class Sweeper {
public:
    Sweeper(const Device& device, ProgressDisplay display, std::size_t steps)
        : bench_{device, interruptRequested, {}}, bar_("stress", display), progress_(bar_.callback()), steps_(steps) {}

    /// Each step is in the family as soon as it is done: an error in the next takes nothing away.
    void run(const Planned& planned, StressFamily& family) {
        for (const PlannedSweep& sweep : planned.sweeps) run(sweep, family.sweeps.emplace_back(sweep.about));
    }

private:
    void run(const PlannedSweep& planned, StressSweep& sweep) {
        for (const PlannedStep& step : planned.steps) {
            if (interruptRequested()) return;
            std::vector<StressFigures> figures = step.trial(bench_);
            if (interruptRequested()) return;
            sweep.steps.push_back({step.parameter, step.label, std::move(figures)});
            static_cast<void>(progress_(static_cast<double>(++done_) / static_cast<double>(steps_)));
        }
    }

    StressBench bench_;
    ProgressBar bar_;
    ProgressCallback progress_;
    std::size_t steps_;
    std::size_t done_ = 0;
};

/// The report is written after each family: whatever ends the program takes no more than one away.
void runFamilies(Findings& findings, const StressCommand& command, const Device& device,
                 const std::vector<Planned>& planned) {
    Sweeper sweeper(device, progressDisplay(command.run), stepCount(planned));
    for (const Planned& family : planned) {
        sweeper.run(family, findings.add(family.family));
        findings.write();
        if (interruptRequested()) return;
    }
}

void print(const StressCommand& command, const StressRun& result) {
    if (command.json) {
        fmt::print("{}", jsonText(toJson(result)));
        return;
    }
    if (!command.run.quiet)
        for (const StressFamily& family : result.families) fmt::print("{}", toText(family));
}

/// After an error, which another one must not hide.
void keep(const StressCommand& command, const Findings& findings) {
    try {
        print(command, findings.report());
        findings.write();
        if (!command.folder.empty())
            fmt::print(stderr, "isolux: stopped by an error: what was tried until then is in {}\n", command.folder);
    } catch (const std::exception& error) {
        spdlog::error("{}", error.what());
    }
}

void conclude(const std::vector<std::string>& broken, const Device& device) {
    for (const std::string& line : broken) spdlog::error("{}", line);
    if (!device.validationMessages().empty())
        spdlog::error("{} validation messages", device.validationMessages().size());
}

ExitCode tryAll(const StressCommand& command) {
    const std::vector<Planned> planned = plan(command);
    std::vector<Beside> beside = readBeside(command.beside);
    checkBeside(beside, planned);
    if (!command.folder.empty()) makeFolder(command.folder);
    const Device device(deviceOptions(command.run));
    Findings findings(command, device, std::move(beside));
    try {
        runFamilies(findings, command, device, planned);
    } catch (...) { // a lost device, say
        keep(command, findings);
        throw;
    }
    const StressRun result = findings.report();
    print(command, result);
    const std::vector<std::string> broken = brokenPromises(result.families);
    conclude(broken, device);
    if (interruptRequested()) {
        spdlog::warn("interrupted: what was tried until then is in the report");
        return ExitCode::interrupted;
    }
    return broken.empty() && device.validationMessages().empty() ? ExitCode::success : ExitCode::failure;
}

/// Samples a pixel of exported scenes, over those of the step: others share no random numbers with the truth.
constexpr std::uint32_t kMoreSamples = 16;

/// Writes one step's scene after another until the user asks to stop: a file a step, FAMILY-SWEEP-NUMBER.json. Steps
/// that are no scenes have none.
class Exporter {
public:
    Exporter(const StressCommand& command, const Device& device, std::size_t steps)
        : device_(device), folder_(command.exportFolder), bar_("export", progressDisplay(command.run)),
          progress_(bar_.callback()), steps_(steps) {}

    void run(const std::string& family, const PlannedSweep& sweep) {
        for (std::size_t i = 0; i < sweep.steps.size() && !interruptRequested(); ++i) {
            const auto write = [&](const RenderTrial& trial) {
                nlohmann::ordered_json json = exportTrial(trial, kMoreSamples, withinStep());
                if (json.is_null()) return;
                json["family"] = family;
                json["sweep"] = sweep.about.name;
                json["label"] = sweep.steps[i].label;
                const std::string name = fmt::format("{}-{}-{:02}.json", family, sweep.about.name, i);
                writeText((folder_ / name).string(), json.dump() + "\n");
            };
            static_cast<void>(sweep.steps[i].trial({device_, interruptRequested, write}));
            ++done_;
            static_cast<void>(withinStep()(0.0));
        }
    }

private:
    /// From the fraction of a step to that of all.
    [[nodiscard]] ProgressCallback withinStep() const {
        return [this](double fraction) {
            return progress_((static_cast<double>(done_) + fraction) / static_cast<double>(steps_));
        };
    }

    const Device& device_;
    fs::path folder_;
    ProgressBar bar_;
    ProgressCallback progress_;
    std::size_t steps_;
    std::size_t done_ = 0;
};

ExitCode exportSteps(const StressCommand& command) {
    const std::vector<Planned> planned = plan(command);
    makeFolder(command.exportFolder);
    const Device device(deviceOptions(command.run));
    {
        Exporter exporter(command, device, stepCount(planned));
        for (const Planned& family : planned)
            for (const PlannedSweep& sweep : family.sweeps) exporter.run(family.family.name, sweep);
    }
    if (!interruptRequested()) return ExitCode::success;
    spdlog::warn("interrupted: {} has the scenes that were whole", command.exportFolder);
    return ExitCode::interrupted;
}

ExitCode run(const StressCommand& command) {
    if (command.run.quiet) setVerbosity(Verbosity::quiet);
    return command.exportFolder.empty() ? tryAll(command) : exportSteps(command);
}

} // namespace

void addStressCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("stress", "Push scenes until they break, and say with numbers where they do");
    auto command = std::make_shared<StressCommand>();
    sub->add_option("--family", command->families, "A family, may be repeated (default: all)")
        ->check(CLI::IsMember(familyNames()));
    sub->add_flag("--quick", command->quick, "Every family, about three steps a sweep");
    CLI::Option* output = sub->add_option("-o,--output", command->folder,
                                          "Folder for stress.json and stress.html, written after each family");
    CLI::Option* beside = sub->add_option("--beside", command->beside,
                                          "A report of another renderer to show beside ours; may be repeated")
                              ->check(CLI::ExistingFile);
    CLI::Option* json = sub->add_flag("--json", command->json, "Print JSON");
    sub->add_option("--export", command->exportFolder,
                    "Instead of rendering, write each step's scene as JSON to this folder, for other renderers")
        ->excludes(output)
        ->excludes(beside)
        ->excludes(json);
    addRunOptions(*sub, command->run);
    sub->footer(fmt::format(
        "Families: {}.\n"
        "Device, single and double reference take the same random numbers, so a bias of 0.1 % is seen with few\n"
        "samples. A step holds if the 95 % interval of its relative bias lies within 0.1 % and nothing is counted\n"
        "that should not happen. Every sweep promises a range of steps: none of these has a fault, has a bias whose\n"
        "interval lies beyond 0.1 %, or contradicts an answer in closed form. No step at all fails or has samples\n"
        "that are no light.\n"
        "Ctrl-C and errors keep the steps that are done.\n"
        "Exit codes: 0 all promises kept, 1 one broken or failed, 2 bad usage or input, 75 try again, 130 "
        "interrupted.\n"
        "Examples:\n"
        "  isolux stress --quick\n"
        "  isolux stress -o stress\n"
        "  isolux stress --family scale --family lights --json",
        fmt::join(familyNames(), ", ")));
    sub->callback([command, &result] { result = run(*command); });
}

} // namespace isolux
