#include "load/bytes.h"

#include "load/context.h"

#include <fmt/format.h>

#include <fstream>

namespace isolux {
namespace {

namespace fs = std::filesystem;

std::string_view describe(fs::file_type type) {
    switch (type) {
    case fs::file_type::not_found: return "the file does not exist";
    case fs::file_type::directory: return "this is a directory, not a file";
    case fs::file_type::fifo:
    case fs::file_type::socket:
    case fs::file_type::block:
    case fs::file_type::character: return "this is not a regular file";
    default: return "the file cannot be read";
    }
}

} // namespace

void requireRegularFile(const fs::path& path, const ReadRequest& request) {
    std::error_code error;
    const fs::file_type type = fs::status(path, error).type();
    if (type != fs::file_type::regular)
        request.context.fail(request.pointer,
                             fmt::format("cannot read '{}': {}", printable(path.string()), describe(type)));
}

Bytes readRegularFile(const fs::path& path, const ReadRequest& request) {
    const std::string name = printable(path.string());
    const auto fail = [&](const std::string& message) { request.context.fail(request.pointer, message); };
    requireRegularFile(path, request);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) fail(fmt::format("cannot open '{}'; check its permissions", name));
    if (size > request.largest)
        fail(fmt::format("'{}' has {} bytes; at most {} are read", name, size, request.largest));
    Bytes bytes(static_cast<std::size_t>(size));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size)
        fail(fmt::format("could read only {} of the {} bytes of '{}'", stream.gcount(), size, name));
    return bytes;
}

void ContentHash::add(ByteSpan bytes) {
    for (const std::uint8_t byte : bytes) state_ = (state_ ^ byte) * 0x100000001B3u;
}

std::string ContentHash::hexadecimal() const { return fmt::format("{:016x}", state_); }

} // namespace isolux
