// The command line of `converge`.
#pragma once

#include "app/converge_variants.h"
#include "report/convergence.h"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace isolux {

struct ConvergeOptions {
    SceneOptions scene;
    CommonMethods common;
    std::vector<std::string> variants; ///< "NAME:OPTIONS"
    std::string backend = "vulkan";
    std::uint32_t seeds = 16;
    std::optional<std::uint32_t> maxSamples;
    std::optional<double> maxSeconds;
    std::vector<std::string> references; ///< files
    std::optional<std::uint32_t> referenceSamples;
    std::vector<double> errors = FitOptions{}.errors;
    std::uint32_t flipSeeds = 4;
    bool noImages = false;
    std::string fit; ///< a CSV file: statistics alone
    std::string folder;
    std::string commandLine; ///< as given
};

/// Adds everything to the command, which sets `options` when it is parsed.
void addConvergeOptions(CLI::App& command, ConvergeOptions& options);

/// What was given to a command that has been parsed, as a shell would read it.
[[nodiscard]] std::string commandLineOf(const CLI::App& command);

/// Samples a pixel at most, where neither they nor seconds are given, and where seconds alone are (which of these is
/// reached is found by a warm-up).
inline constexpr std::uint32_t kUsualSamples = 64;
inline constexpr std::uint32_t kSamplesInTime = 4096;

/// Samples of each reference for one of the longest render. Both together then have a variance of 1 / 128 of that of a
/// render like theirs, below the 1 % that errors can bear.
inline constexpr std::uint32_t kReferenceFactor = 64;

} // namespace isolux
