// Which revision of the sources this program was built from.
#pragma once

namespace isolux {

/// As git names it, with "-dirty" if files were changed since; empty if it was not built from a git repository.
[[nodiscard]] const char* sourceRevision();

} // namespace isolux
