// The one exception type: what went wrong, where, and the exit code it asks for.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace isolux {

/// Exit codes of every command; the values are part of the command-line interface.
enum class ExitCode : int {
    success = 0,
    failure = 1,      ///< failed while running, or `compare` found a limit exceeded
    badInput = 2,     ///< bad usage, unreadable or invalid input
    tryAgain = 75,    ///< device lost or out of memory: a scheduler may retry
    interrupted = 130 ///< stopped by Ctrl-C; what was done has been kept
};

/// An error the user can act on. `context` says where (file, JSON pointer, Vulkan call), `message` what and why.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, std::string_view context, std::string_view message)
        : std::runtime_error(std::string(context) + ": " + std::string(message)), code_(code) {}

    [[nodiscard]] ExitCode code() const noexcept { return code_; }

private:
    ExitCode code_;
};

/// Invalid input or usage (exit code 2).
[[noreturn]] inline void throwBadInput(std::string_view context, std::string_view message) {
    throw Error(ExitCode::badInput, context, message);
}

/// A failure while running (exit code 1).
[[noreturn]] inline void throwFailure(std::string_view context, std::string_view message) {
    throw Error(ExitCode::failure, context, message);
}

} // namespace isolux
