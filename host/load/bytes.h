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

/// Reads a whole regular file; a missing file, directory, FIFO or device is an error at `pointer`, and is never opened.
[[nodiscard]] Bytes readRegularFile(const std::filesystem::path& path, const LoadContext& context,
                                    std::string_view pointer);

/// 64-bit FNV-1a (Fowler, Noll and Vo), to tell scenes apart; no protection against forgery.
class ContentHash {
public:
    void add(ByteSpan bytes);
    [[nodiscard]] std::string hexadecimal() const;

private:
    std::uint64_t state_ = 0xCBF29CE484222325u;
};

} // namespace isolux
