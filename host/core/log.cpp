#include "core/log.h"

#include <spdlog/sinks/stdout_sinks.h>

namespace isolux {

void initialiseLog(Verbosity verbosity) {
    auto logger = spdlog::stderr_logger_mt("isolux");
    logger->set_pattern("%n: %l: %v");
    switch (verbosity) {
    case Verbosity::quiet: logger->set_level(spdlog::level::err); break;
    case Verbosity::normal: logger->set_level(spdlog::level::info); break;
    case Verbosity::verbose: logger->set_level(spdlog::level::debug); break;
    }
    spdlog::set_default_logger(std::move(logger));
}

} // namespace isolux
