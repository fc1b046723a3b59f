// Checks of option values that CLI11 lacks.
#pragma once

#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace isolux {

/// A number that is neither NaN nor infinite: comparisons with bounds, CLI11's own included, let NaN pass.
[[nodiscard]] inline CLI::Validator finiteNumber() {
    return {[](std::string& text) -> std::string {
                double value = 0.0;
                const bool finite = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
                return finite ? "" : "'" + text + "' is not a finite number";
            },
            "FINITE"};
}

} // namespace isolux
