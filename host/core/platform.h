// Everything that differs between operating systems, in one place: interrupts, terminals, durable file replacement,
// processes, the user's folders.
#pragma once

#include <filesystem>
#include <string>

namespace isolux {

/// From now on Ctrl-C (SIGINT, SIGTERM) sets a flag; another one, half a second later or more, ends the process.
void catchInterrupts();
[[nodiscard]] bool interruptRequested() noexcept;

/// Whether standard error is a terminal (progress bars are drawn only there), and its width in columns.
[[nodiscard]] bool standardErrorIsTerminal();
[[nodiscard]] int terminalColumns();

/// Flushes `temporary` to disk, then renames it to `target`, replacing it atomically. Throws Error.
void replaceFile(const std::filesystem::path& temporary, const std::filesystem::path& target);

/// A number that differs between running processes, for temporary names.
[[nodiscard]] unsigned long processId();

/// Since the process began, loading of its libraries included, to about 0.01 s.
[[nodiscard]] double processSeconds();

/// Whether it is a folder in which this process may make files.
[[nodiscard]] bool isWritableFolder(const std::filesystem::path& path);

/// Sets an environment variable of this process unless it has a value. Not while other threads read any.
void setDefaultVariable(const char* name, const std::string& value);

/// Where this user's programs keep what can be made again, this one's own folder in it; it may not exist. Empty if
/// there is no such place.
[[nodiscard]] std::filesystem::path userCacheFolder();

} // namespace isolux
