#include "app/progress_bar.h"

#include "core/platform.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace isolux {
namespace {

constexpr double kTerminalInterval = 0.1; // seconds between updates
constexpr double kLogInterval = 5.0;
constexpr double kJsonInterval = 0.5;

double secondsLeft(double elapsed, double fraction) { return elapsed / fraction * (1.0 - fraction); }

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
    if (drawn_) fmt::print(stderr, "\r{:{}}\r", "", terminalColumns() - 1);
}

ProgressCallback ProgressBar::callback() {
    return [this](double fraction) {
        update(fraction);
        return interruptRequested() ? Continue::no : Continue::yes;
    };
}

void ProgressBar::update(double fraction) {
    if (display_ == ProgressDisplay::hidden) return;
    const double interval = display_ == ProgressDisplay::json ? kJsonInterval
                            : terminal_                       ? kTerminalInterval
                                                              : kLogInterval;
    if (elapsedSeconds() - lastUpdate_ < interval) return;
    lastUpdate_ = elapsedSeconds();
    if (display_ == ProgressDisplay::json)
        print(jsonLine(fraction));
    else
        print(line(fraction));
}

void ProgressBar::stage(std::string_view name) {
    if (display_ == ProgressDisplay::json)
        print(nlohmann::ordered_json{{"stage", name}, {"elapsedSeconds", elapsedSeconds()}}.dump());
    else if (display_ == ProgressDisplay::shown && terminal_)
        print(fmt::format("{:<40}", name));
}

void ProgressBar::print(const std::string& text) {
    const bool redraws = terminal_ && display_ != ProgressDisplay::json;
    drawn_ = drawn_ || redraws;
    fmt::print(stderr, "{}{}{}", redraws ? "\r" : "", text, redraws ? "" : "\n");
    std::fflush(stderr);
}

std::string ProgressBar::jsonLine(double fraction) const {
    nlohmann::ordered_json json{{"stage", label_}, {"fraction", fraction}, {"elapsedSeconds", elapsedSeconds()}};
    if (fraction > 0.0) json["secondsLeft"] = secondsLeft(elapsedSeconds(), fraction);
    return json.dump();
}

std::string ProgressBar::line(double fraction) const {
    const double elapsed = elapsedSeconds();
    const std::string left = fraction > 0.0 ? duration(secondsLeft(elapsed, fraction)) + " left" : "...";
    const std::string text = fmt::format("{:5.1f} %  {} elapsed, {}", 100.0 * fraction, duration(elapsed), left);
    if (!terminal_) return fmt::format("{}: {}", label_, text);
    const int columns = std::clamp(terminalColumns() - static_cast<int>(label_.size() + text.size()) - 8, 0, 40);
    const auto filled = static_cast<std::size_t>(fraction * columns);
    return fmt::format("{} [{:<{}}] {}   ", label_, std::string(filled, '#'), columns, text);
}

} // namespace isolux
