// Checks of option values that CLI11 lacks.
#pragma once

#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace isolux {

/// A finite number of which `accepts` is true, `what` in words: comparisons with bounds, CLI11's own included, let NaN
/// pass, and its messages print the largest number there is.
template <typename Accepts>
[[nodiscard]] CLI::Validator numberThat(const Accepts& accepts, const std::string& what, const std::string& name) {
    return {[accepts, what](std::string& text) -> std::string {
                double value = 0.0;
                const bool finite = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
                if (!finite) return "'" + text + "' is not a finite number";
                return accepts(value) ? "" : "'" + text + "' is not " + what;
            },
            name};
}

[[nodiscard]] inline CLI::Validator finiteNumber() {
    return numberThat([](double) { return true; }, "", "FINITE");
}

[[nodiscard]] inline CLI::Validator positiveNumber() {
    return numberThat([](double value) { return value > 0.0; }, "above 0", "POSITIVE");
}

[[nodiscard]] inline CLI::Validator nonNegativeNumber() {
    return numberThat([](double value) { return value >= 0.0; }, "0 or more", "NONNEGATIVE");
}

} // namespace isolux
