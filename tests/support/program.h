// Runs the program as users do, in a folder that is gone afterwards.
#pragma once

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace isolux::test {

struct ProgramResult {
    int exitCode = -1;  ///< 128 and the signal's number if one ended it
    std::string output; ///< standard output and error together
};

/// The built program with these arguments (a shell's words, which may redirect a stream); `prefix` may set its
/// environment.
[[nodiscard]] inline ProgramResult runProgram(const std::string& arguments, const std::string& prefix = "") {
    const std::string command = "{ " + prefix + " '" + ISOLUX_BINARY_DIR + "/isolux' " + arguments + "; } 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    ProgramResult result;
    std::array<char, 4096> buffer;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
        result.output.append(buffer.data(), count);
    const int status = ::pclose(pipe);
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

/// How often `part` occurs in `text`.
[[nodiscard]] inline std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
    return count;
}

[[nodiscard]] inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A test with a folder of its own.
class ProgramTest : public ::testing::Test {
protected:
    ProgramTest() : folder_(std::filesystem::temp_directory_path() / ("isolux-program-" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~ProgramTest() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] std::string file(const std::string& name) const { return (folder_ / name).string(); }
    [[nodiscard]] std::size_t fileCount() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
    }

private:
    std::filesystem::path folder_;
};

} // namespace isolux::test
