// Messages for people, on standard error; standard output is for results.
#pragma once

#include <spdlog/spdlog.h>

namespace isolux {

enum class Verbosity { quiet, normal, verbose };

/// Sets up the logger: "isolux: warning: ..." on standard error.
void initialiseLog();
/// `quiet` keeps errors only, `verbose` adds what is done step by step.
void setVerbosity(Verbosity verbosity);

} // namespace isolux
