#include "app/progress_bar.h"

#include "core/platform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace isolux {
namespace {

constexpr double kTerminalInterval = 0.1; // seconds between updates
constexpr double kLogInterval = 5.0;

std::string duration(double seconds) {
    const auto whole = std::lround(seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
    return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

} // namespace

ProgressBar::ProgressBar(std::string label, ProgressDisplay display)
    : label_(std::move(label)), display_(display), terminal_(standardErrorIsTerminal()) {}

ProgressBar::~ProgressBar() {
    if (drawn_ && terminal_) fmt::print(stderr, "\r{:{}}\r", "", terminalColumns() - 1);
}

ProgressCallback ProgressBar::callback() {
    return [this](double fraction) {
        update(fraction);
        return interruptRequested() ? Continue::no : Continue::yes;
    };
}

void ProgressBar::update(double fraction) {
    if (display_ == ProgressDisplay::hidden) return;
    const double interval = terminal_ ? kTerminalInterval : kLogInterval;
    if (elapsedSeconds() - lastUpdate_ < interval) return;
    lastUpdate_ = elapsedSeconds();
    drawn_ = true;
    const std::string text = line(fraction);
    fmt::print(stderr, "{}{}{}", terminal_ ? "\r" : "", text, terminal_ ? "" : "\n");
    std::fflush(stderr);
}

std::string ProgressBar::line(double fraction) const {
    const double elapsed = elapsedSeconds();
    const std::string left = fraction > 0.0 ? duration(elapsed / fraction * (1.0 - fraction)) + " left" : "...";
    const std::string text = fmt::format("{:5.1f} %  {} elapsed, {}", 100.0 * fraction, duration(elapsed), left);
    if (!terminal_) return fmt::format("{}: {}", label_, text);
    const int columns = std::clamp(terminalColumns() - static_cast<int>(label_.size() + text.size()) - 8, 0, 40);
    const auto filled = static_cast<std::size_t>(fraction * columns);
    return fmt::format("{} [{:<{}}] {}   ", label_, std::string(filled, '#'), columns, text);
}

} // namespace isolux
