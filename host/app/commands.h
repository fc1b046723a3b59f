// The subcommands: each adds itself to the command line and leaves its exit code in `result`.
#pragma once

#include "core/error.h"

namespace CLI {
class App;
}

namespace isolux {

void addRenderCommand(CLI::App& app, ExitCode& result);
void addCompareCommand(CLI::App& app, ExitCode& result);
void addConvergeCommand(CLI::App& app, ExitCode& result);
void addVerifyCommand(CLI::App& app, ExitCode& result);
void addSceneCommand(CLI::App& app, ExitCode& result);
void addStressCommand(CLI::App& app, ExitCode& result);
void addDevicesCommand(CLI::App& app, ExitCode& result);

} // namespace isolux
