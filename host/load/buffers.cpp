#include "load/buffers.h"

#include "load/context.h"
#include "load/uri.h"

#include <fmt/format.h>

#include <map>

namespace isolux {
namespace {

constexpr std::uintmax_t kLargestBuffer = std::uintmax_t{1} << 34;

class BufferReader {
public:
    BufferReader(const BufferSources& sources, ContentHash& hash) : sources_(sources), hash_(hash) {}

    void add(const JsonReader& buffer, std::size_t index) {
        const ByteSpan bytes = source(buffer, index);
        const std::uint64_t length = buffer.at("byteLength").integer();
        if (length > bytes.size())
            buffer.at("byteLength")
                .fail(fmt::format("is {} but there are only {} bytes of data", length, bytes.size()));
        buffers_.spans.push_back(bytes.first(static_cast<std::size_t>(length)));
    }

    [[nodiscard]] Buffers take() { return std::move(buffers_); }

private:
    ByteSpan source(const JsonReader& buffer, std::size_t index) {
        const std::optional<JsonReader> uri = buffer.find("uri");
        if (!uri) return binaryChunk(buffer, index);
        const std::string& text = uri->string();
        if (isDataUri(text)) return data(*uri);
        return file(resolveUri(text, sources_.folder, *uri), *uri);
    }

    // glTF 2.0, 3.6.1.1, gives buffers two media types; the bytes have one meaning only.
    ByteSpan data(const JsonReader& uri) {
        const std::string type = mediaTypeOf(uri.string());
        if (!type.empty() && type != "application/octet-stream" && type != "application/gltf-buffer")
            uri.warn(fmt::format("its media type {} is not that of a buffer; read all the same", printable(type)));
        return keep(decodeDataUri(uri.string(), uri));
    }

    // glTF 2.0, 4.4.3.3: only the first buffer may be the BIN chunk.
    ByteSpan binaryChunk(const JsonReader& buffer, std::size_t index) {
        if (index != 0 || !sources_.binaryChunk) buffer.fail("has no uri, and there is no binary chunk for it");
        buffers_.totalBytes += sources_.binaryChunk->size();
        return *sources_.binaryChunk;
    }

    // A file is read once, however many buffers name it.
    ByteSpan file(const std::filesystem::path& path, const JsonReader& uri) {
        if (const auto known = files_.find(path); known != files_.end()) return known->second;
        const ByteSpan bytes = keep(readRegularFile(path, {uri.context(), uri.pointer(), kLargestBuffer}));
        hash_.add(bytes);
        return files_.emplace(path, bytes).first->second;
    }

    ByteSpan keep(Bytes bytes) {
        buffers_.totalBytes += bytes.size();
        return *buffers_.owners.emplace_back(std::make_shared<const Bytes>(std::move(bytes)));
    }

    const BufferSources& sources_;
    ContentHash& hash_;
    Buffers buffers_;
    std::map<std::filesystem::path, ByteSpan> files_;
};

} // namespace

Buffers readBuffers(const JsonReader& root, const BufferSources& sources, ContentHash& hash) {
    BufferReader reader(sources, hash);
    const std::size_t count = root.sizeOf("buffers");
    for (std::size_t i = 0; i < count; ++i) reader.add(root.at("buffers").element(i), i);
    return reader.take();
}

} // namespace isolux
