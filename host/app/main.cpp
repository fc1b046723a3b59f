// The command line: one subcommand a file, errors as one line, exit codes by core/error.h.
#include "app/commands.h"
#include "app/revision.h"
#include "core/error.h"
#include "core/log.h"
#include "core/platform.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <new>

namespace {

int run(int argumentCount, char** arguments) {
    CLI::App app("Isolux: a Vulkan compute path tracer that measures itself.");
    app.set_version_flag("--version", isolux::versionText());
    app.require_subcommand(1);
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
        return fmt::format("isolux: error: {} (--help lists what there is)\n", error.what());
    });
    app.footer("Examples:\n"
               "  isolux render scene.glb -o image.exr --spp 256\n"
               "  isolux scene scene.glb\n"
               "  isolux verify scene.glb\n"
               "  isolux compare image.exr reference.exr --max-relative-bias 0.01\n"
               "  isolux converge scene.glb -o out --variant mis --variant 'light:--light-sampling light'\n"
               "  isolux stress --family scale\n"
               "`isolux COMMAND --help` shows a command's options.");
    isolux::ExitCode result = isolux::ExitCode::success;
    isolux::addRenderCommand(app, result);
    isolux::addCompareCommand(app, result);
    isolux::addConvergeCommand(app, result);
    isolux::addVerifyCommand(app, result);
    isolux::addStressCommand(app, result);
    isolux::addSceneCommand(app, result);
    isolux::addDevicesCommand(app, result);
    try {
        app.parse(argumentCount, arguments);
    } catch (const CLI::Success& success) { // --help and --version
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        app.exit(error);
        return static_cast<int>(isolux::ExitCode::badInput);
    }
    return static_cast<int>(result);
}

} // namespace

int main(int argumentCount, char** arguments) {
    isolux::catchInterrupts();
    isolux::initialiseLog();
    try {
        return run(argumentCount, arguments);
    } catch (const isolux::Error& error) {
        fmt::print(stderr, "isolux: error: {}\n", error.what());
        return static_cast<int>(error.code());
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "isolux: error: out of memory\n");
        return static_cast<int>(isolux::ExitCode::tryAgain);
    } catch (const std::exception& error) {
        fmt::print(stderr, "isolux: error: {}\n", error.what());
        return static_cast<int>(isolux::ExitCode::failure);
    }
}
