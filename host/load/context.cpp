#include "load/context.h"

#include "core/error.h"

#include <fmt/format.h>

namespace isolux {
namespace {

constexpr std::size_t kMostWarnings = 32;

} // namespace

std::string printable(std::string_view text) {
    constexpr std::size_t kLongest = 120;
    std::string result(text.substr(0, kLongest));
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
    // A cut inside a UTF-8 sequence would leave invalid text.
    if (text.size() > kLongest) {
        while (!result.empty() && (static_cast<unsigned char>(result.back()) & 0xC0u) == 0x80u) result.pop_back();
        if (!result.empty() && (static_cast<unsigned char>(result.back()) & 0x80u) != 0) result.pop_back();
        result += "...";
    }
    return result;
}

std::string printableLines(std::string_view text) {
    std::string joined;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (end > begin && !joined.empty()) joined += "; ";
        joined += text.substr(begin, end - begin);
        begin = end + 1;
    }
    return printable(joined);
}

void LoadContext::fail(std::string_view pointer, std::string_view message) const {
    throwBadInput(pointer.empty() ? file_ : fmt::format("{}: {}", file_, printable(pointer)), message);
}

void LoadContext::warn(std::string_view pointer, std::string_view message) {
    const auto entry = warningOf_.find(message);
    if (entry != warningOf_.end()) {
        ++warnings_[entry->second].count;
    } else if (warnings_.size() < kMostWarnings) {
        warningOf_.emplace(message, warnings_.size());
        warnings_.push_back({printable(pointer), std::string(message), 1});
    } else {
        ++unlisted_;
    }
}

std::vector<std::string> LoadContext::warnings() const {
    std::vector<std::string> lines;
    for (const Warning& warning : warnings_) {
        std::string line =
            warning.pointer.empty() ? warning.message : fmt::format("{}: {}", warning.pointer, warning.message);
        if (warning.count > 1) line += fmt::format(" (and {} more)", warning.count - 1);
        lines.push_back(std::move(line));
    }
    if (unlisted_ > 0) lines.push_back(fmt::format("{} more warnings", unlisted_));
    return lines;
}

} // namespace isolux
