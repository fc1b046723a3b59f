#include "load/container.h"

#include "load/context.h"

#include <fmt/format.h>

namespace isolux {
namespace {

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kMagic = 0x46546C67u;     // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534Au; // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942u;  // "BIN\0"

std::uint32_t readWord(ByteSpan bytes, std::size_t offset) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) word |= static_cast<std::uint32_t>(bytes[offset + i]) << (8 * i);
    return word;
}

std::string_view asText(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

struct Chunk {
    std::uint32_t type = 0;
    ByteSpan data;
};

/// Takes the first chunk off `rest`.
Chunk takeChunk(ByteSpan& rest, const LoadContext& context) {
    if (rest.size() < kChunkHeaderBytes)
        context.fail("",
                     fmt::format("{} stray bytes where a GLB chunk should start; the file is damaged", rest.size()));
    const std::uint32_t length = readWord(rest, 0);
    const Chunk header{readWord(rest, 4), {}};
    rest = rest.subspan(kChunkHeaderBytes);
    if (length > rest.size())
        context.fail("",
                     fmt::format("a GLB chunk claims {} bytes but only {} are left; the file is cut short or damaged",
                                 length, rest.size()));
    const ByteSpan data = rest.first(length);
    rest = rest.subspan(length);
    return {header.type, data};
}

/// The bytes after the header, as far as the header says the file goes.
ByteSpan checkHeader(ByteSpan file, LoadContext& context) {
    if (file.size() < kHeaderBytes) context.fail("", "the GLB header is cut short");
    if (const std::uint32_t version = readWord(file, 4); version != 2)
        context.fail("", fmt::format("GLB version {} is not supported; export as glTF 2.0", version));
    const std::uint32_t length = readWord(file, 8);
    if (length < kHeaderBytes || length > file.size())
        context.fail("", fmt::format("the GLB header claims {} bytes but the file has {}; it is cut short or damaged",
                                     length, file.size()));
    if (length < file.size()) context.warn("", "bytes after the end of the GLB are ignored");
    return file.first(length).subspan(kHeaderBytes);
}

Container splitGlb(ByteSpan file, LoadContext& context) {
    ByteSpan rest = checkHeader(file, context);
    const Chunk json = takeChunk(rest, context);
    if (json.type != kJsonChunk) context.fail("", "the first GLB chunk is not JSON");
    Container container{asText(json.data), std::nullopt};
    while (!rest.empty()) {
        const Chunk chunk = takeChunk(rest, context);
        if (chunk.type == kJsonChunk) context.fail("", "the GLB has two JSON chunks");
        if (chunk.type != kBinChunk) continue; // glTF 2.0, 4.4.3: unknown chunks are skipped
        if (container.binary) context.fail("", "the GLB has two BIN chunks");
        container.binary = chunk.data;
    }
    return container;
}

} // namespace

Container splitContainer(ByteSpan file, LoadContext& context) {
    if (file.empty()) context.fail("", "the file is empty");
    if (file.size() >= 4 && readWord(file, 0) == kMagic) return splitGlb(file, context);
    return {asText(file), std::nullopt};
}

} // namespace isolux
