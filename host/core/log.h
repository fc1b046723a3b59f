// Messages for people, on standard error; standard output is for results.
#pragma once

#include <spdlog/spdlog.h>

namespace isolux {

/// Sets up the logger: "isolux: warning: ..." on standard error. `quiet` keeps errors only.
enum class Verbosity { quiet, normal, verbose };
void initialiseLog(Verbosity verbosity);

} // namespace isolux
