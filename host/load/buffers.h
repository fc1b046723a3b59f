// The bytes behind the document's buffers, from data URIs, files beside the scene, or the binary chunk of a .glb.
#pragma once

#include "load/bytes.h"
#include "load/container.h"
#include "load/json_reader.h"

#include <filesystem>
#include <vector>

namespace isolux {

/// Buffers with the byteLength that the document gives; several may share one file's bytes.
struct Buffers {
    std::vector<ByteSpan> spans;
    std::vector<std::shared_ptr<const Bytes>> owners;
    std::uint64_t totalBytes = 0; ///< distinct bytes read
};

/// What buffers may refer to.
struct BufferSources {
    std::filesystem::path folder;
    std::optional<ByteSpan> binaryChunk;
};

/// Reads every buffer of a verified document; files are added to `hash`.
[[nodiscard]] Buffers readBuffers(const JsonReader& root, const BufferSources& sources, ContentHash& hash);

} // namespace isolux
