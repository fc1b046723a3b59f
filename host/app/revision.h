// Which revision of the sources this program was built from.
#pragma once

#include <string>

namespace isolux {

/// As git names it, with "-dirty" if files were changed since; empty if it was not built from a git repository.
[[nodiscard]] const char* sourceRevision();

/// "isolux 0.1.0 (4f0c1d2e3a4b)"
[[nodiscard]] inline std::string versionText() {
    const std::string revision = sourceRevision();
    return "isolux " ISOLUX_VERSION + (revision.empty() ? "" : " (" + revision + ")");
}

} // namespace isolux
