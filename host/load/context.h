// Where a load reports to: errors with file and JSON pointer, and warnings summarised so that a file yields few lines.
#pragma once

#include "load/limits.h"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace isolux {

/// Text from a file made fit for a message: control characters are replaced and long text is cut.
[[nodiscard]] std::string printable(std::string_view text);

/// The same of a decoder's words, whose lines are joined by "; ".
[[nodiscard]] std::string printableLines(std::string_view text);

class LoadContext {
public:
    explicit LoadContext(std::string file, const LoadLimits& limits = {}) : file_(std::move(file)), limits_(limits) {}

    [[nodiscard]] const LoadLimits& limits() const { return limits_; }

    /// Throws a bad-input Error at a JSON pointer; an empty pointer means the file as a whole.
    [[noreturn]] void fail(std::string_view pointer, std::string_view message) const;

    /// Notes what is not supported. Equal messages are counted, not repeated.
    void warn(std::string_view pointer, std::string_view message);

    /// "pointer: message (and 3 more)", one per message, in order of first appearance; a file can make only so many.
    [[nodiscard]] std::vector<std::string> warnings() const;

private:
    struct Warning {
        std::string pointer;
        std::string message;
        std::size_t count = 0;
    };
    std::string file_;
    LoadLimits limits_;
    std::vector<Warning> warnings_;
    std::size_t unlisted_ = 0;
    std::map<std::string, std::size_t, std::less<>> warningOf_;
};

} // namespace isolux
