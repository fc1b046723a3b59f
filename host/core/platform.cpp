#include "core/platform.h"

#include "core/error.h"
#include "core/stopwatch.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <optional>
#include <string>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace isolux {
namespace {

/// Milliseconds of the monotonic clock at the first interrupt; 0 before.
std::atomic<std::int64_t> interruptTime{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "the signal handler may only touch lock-free atomics");

/// Programs such as timeout(1) send a signal to the process and to its group: what arrives this soon is the same one.
constexpr std::int64_t kSameInterruptMilliseconds = 500;

extern "C" void onInterrupt(int signal) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const std::int64_t milliseconds = std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000 + 1;
    std::int64_t first = 0;
    if (interruptTime.compare_exchange_strong(first, milliseconds) || milliseconds - first < kSameInterruptMilliseconds)
        return;
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

[[noreturn]] void throwFileError(const std::filesystem::path& path, const char* action) {
    throwFailure(path.string(), std::string(action) + ": " + std::strerror(errno));
}

/// Flushes a file or a directory to disk.
void flushToDisk(const std::filesystem::path& path, int openFlags) {
    const int descriptor =
        ::open(path.c_str(), openFlags); // NOLINT(cppcoreguidelines-pro-type-vararg): POSIX's signature
    if (descriptor < 0) throwFileError(path, "cannot open to flush");
    const int result = ::fsync(descriptor);
    const int error = errno;
    ::close(descriptor);
    errno = error;
    // File systems without fsync on directories answer EINVAL; the rename is then as durable as they can make it.
    if (result != 0 && error != EINVAL) throwFileError(path, "cannot flush to disk");
}

/// For systems that do not tell when a process began.
const Stopwatch sinceLoaded;

/// Field 22 of /proc/self/stat (proc(5)): clock ticks from the machine's start to the process's.
std::optional<double> startTicks() {
    std::ifstream file("/proc/self/stat");
    std::string text;
    if (!std::getline(file, text)) return std::nullopt;
    constexpr int kFieldsAfterName = 20; // the name in brackets may hold blanks: counted from behind it
    std::size_t at = text.rfind(')');
    for (int i = 0; i < kFieldsAfterName && at != std::string::npos; ++i) at = text.find(' ', at + 1);
    if (at == std::string::npos) return std::nullopt;
    return std::strtod(text.c_str() + at, nullptr);
}

/// An environment variable that names an absolute path; others are to be ignored (XDG Base Directory Specification).
std::filesystem::path folderIn(const char* variable) {
    const char* text = std::getenv(variable);
    const std::filesystem::path path = text == nullptr ? "" : text;
    return path.is_absolute() ? path : std::filesystem::path();
}

std::filesystem::path cacheFolderOfAll() {
#if defined(_WIN32)
    return folderIn("LOCALAPPDATA");
#else
#if !defined(__APPLE__)
    if (std::filesystem::path chosen = folderIn("XDG_CACHE_HOME"); !chosen.empty()) return chosen;
    constexpr const char* kInHome = ".cache";
#else
    constexpr const char* kInHome = "Library/Caches";
#endif
    const std::filesystem::path home = folderIn("HOME");
    return home.empty() ? home : home / kInHome;
#endif
}

} // namespace

void catchInterrupts() {
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
}

bool interruptRequested() noexcept { return interruptTime.load(std::memory_order_relaxed) != 0; }

bool standardErrorIsTerminal() { return ::isatty(STDERR_FILENO) == 1; }

int terminalColumns() {
    winsize size{};
    if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
        return 80; // NOLINT(cppcoreguidelines-pro-type-vararg)
    return size.ws_col;
}

void replaceFile(const std::filesystem::path& temporary, const std::filesystem::path& target) {
    flushToDisk(temporary, O_RDONLY);
    std::error_code error;
    std::filesystem::rename(temporary, target, error);
    if (error) throwFailure(target.string(), "cannot rename the finished file to this name: " + error.message());
    const std::filesystem::path folder = target.parent_path();
    flushToDisk(folder.empty() ? std::filesystem::path(".") : folder, O_RDONLY | O_DIRECTORY);
}

unsigned long processId() { return static_cast<unsigned long>(::getpid()); }

double processSeconds() {
#if defined(__linux__)
    timespec now{};
    const std::optional<double> ticks = startTicks();
    if (ticks && clock_gettime(CLOCK_BOOTTIME, &now) == 0)
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
               *ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
#endif
    return sinceLoaded.seconds();
}

bool isWritableFolder(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored) && ::access(path.c_str(), W_OK | X_OK) == 0;
}

void setDefaultVariable(const char* name, const std::string& value) { ::setenv(name, value.c_str(), 0); }

std::filesystem::path userCacheFolder() {
    const std::filesystem::path folder = cacheFolderOfAll();
    return folder.empty() ? folder : folder / "isolux";
}

} // namespace isolux
