#include "core/log.h"

#include <spdlog/sinks/stdout_sinks.h>

namespace isolux {

void initialiseLog() {
    auto logger = spdlog::stderr_logger_mt("isolux");
    logger->set_pattern("%n: %l: %v");
    spdlog::set_default_logger(std::move(logger));
}

void setVerbosity(Verbosity verbosity) {
    switch (verbosity) {
    case Verbosity::quiet: spdlog::set_level(spdlog::level::err); break;
    case Verbosity::normal: spdlog::set_level(spdlog::level::info); break;
    case Verbosity::verbose: spdlog::set_level(spdlog::level::debug); break;
    }
}

} // namespace isolux
