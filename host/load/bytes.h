// Bytes as they come from files: read once, checked, shared read-only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace isolux {

class LoadContext;

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

/// Where errors of reading a file are reported, and how large it may be.
struct ReadRequest {
    const LoadContext& context;
    std::string_view pointer;
    std::uintmax_t largest = 0;
};

/// That a path names a regular file: a missing one, a directory, FIFO or device is an error. Nothing is opened.
void requireRegularFile(const std::filesystem::path& path, const ReadRequest& request);

/// Reads a whole regular file.
[[nodiscard]] Bytes readRegularFile(const std::filesystem::path& path, const ReadRequest& request);

/// 64-bit FNV-1a (Fowler, Noll and Vo), to tell scenes apart; no protection against forgery.
class ContentHash {
public:
    void add(ByteSpan bytes);
    [[nodiscard]] std::string hexadecimal() const;

private:
    std::uint64_t state_ = 0xCBF29CE484222325u;
};

} // namespace isolux
