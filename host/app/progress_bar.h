// Progress on standard error: a bar on a terminal, a line every few seconds in a log, JSON lines for programs; and the
// answer to Ctrl-C.
#pragma once

#include "core/progress.h"
#include "core/stopwatch.h"

#include <string>
#include <string_view>

namespace isolux {

enum class ProgressDisplay { shown, hidden, json };

class ProgressBar {
public:
    ProgressBar(std::string label, ProgressDisplay display);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Says what is being done before there is a fraction of it: "compiling".
    void stage(std::string_view name);
    /// For renderers: draws, and says `no` once the user has asked to stop.
    [[nodiscard]] ProgressCallback callback();
    [[nodiscard]] double elapsedSeconds() const { return watch_.seconds(); }

private:
    void update(double fraction);
    void print(const std::string& text);
    [[nodiscard]] std::string line(double fraction) const;
    [[nodiscard]] std::string jsonLine(double fraction) const;

    std::string label_;
    ProgressDisplay display_;
    bool terminal_;
    bool drawn_ = false;
    Stopwatch watch_;
    double lastUpdate_ = 0.0; ///< seconds
};

} // namespace isolux
