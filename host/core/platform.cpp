#include "core/platform.h"

#include "core/error.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>

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

} // namespace isolux
