// `isolux render`: a scene to image files, with a report of time and error.
#include "app/backends.h"
#include "app/commands.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/scene_options.h"
#include "core/log.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace isolux {
namespace {

struct RenderCommand {
    SceneOptions scene;
    std::vector<std::string> outputs;
    std::string backend = "vulkan";
    std::string precision = "double";
    std::string json;
};

constexpr std::uint32_t kDefaultWidth = 512;

ExitCode run(const RenderCommand& command) {
    for (const std::string& output : command.outputs) checkImagePath(output);
    const SceneRun scene = openScene(command.scene, kDefaultWidth);
    Film film(scene.settings.width, scene.settings.height);
    RunReport report = describeRun(scene, command.scene);
    const BackendOptions options{command.backend == "reference" ? Backend::reference : Backend::vulkan,
                                 command.precision == "float" ? Precision::singlePrecision : Precision::doublePrecision,
                                 deviceOptions(command.scene)};
    std::optional<Error> failure;
    {
        ProgressBar bar("rendering", command.scene.quiet ? ProgressDisplay::hidden : ProgressDisplay::shown);
        try {
            renderFilm(film, report, scene, options, bar);
        } catch (const Error& error) {
            // What was finished before a device is lost or memory runs out is worth keeping.
            if (film.maxSampleCount() == 0) throw;
            failure = error;
        }
    }
    describeFilm(report, film);
    const Completion completion =
        film.minSampleCount() == scene.settings.sampleCount ? Completion::whole : Completion::interrupted;
    if (completion == Completion::interrupted && film.maxSampleCount() == 0) {
        spdlog::warn("interrupted before the first sample; nothing was written");
        return ExitCode::interrupted;
    }
    if (failure) fmt::print(stderr, "isolux: error: {}\n", failure->what());
    if (!command.scene.quiet) fmt::print("{}", toText(report));
    if (!command.json.empty()) writeText(command.json, toJson(report).dump(2) + "\n");
    writeOutputs(command.outputs, film, report, completion);
    if (failure) return failure->code();
    if (completion == Completion::interrupted) return ExitCode::interrupted;
    return film.diagnostics.clean() && report.validationMessages.empty() ? ExitCode::success : ExitCode::failure;
}

} // namespace

void addRenderCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("render", "Render a scene to an image");
    auto command = std::make_shared<RenderCommand>();
    addSceneOptions(*sub, command->scene);
    sub->add_option("-o,--output", command->outputs, "Image to write: .exr, .png or .hdr; may be repeated")->required();
    sub->add_option("--backend", command->backend, "What renders")
        ->check(CLI::IsMember({"vulkan", "reference"}))
        ->capture_default_str();
    sub->add_option("--precision", command->precision, "Of the reference")
        ->check(CLI::IsMember({"double", "float"}))
        ->capture_default_str();
    sub->add_option("--json", command->json, "Also write the report to this file");
    sub->footer("Ctrl-C keeps what is done: the samples finished so far are written.\n"
                "Exit codes: 0 done, 1 failed, 2 bad usage or input, 75 try again (device lost, out of memory), "
                "130 interrupted.\n"
                "Examples:\n"
                "  isolux render scene.glb -o image.png\n"
                "  isolux render scene.gltf -o image.exr --spp 1024 --seed 7 --json report.json\n"
                "  isolux render scene.gltf -o half.exr --spp 512 --first-sample 512\n"
                "  isolux render scene.gltf -o truth.exr --backend reference --precision double");
    sub->callback([command, &result] { result = run(*command); });
}

} // namespace isolux
