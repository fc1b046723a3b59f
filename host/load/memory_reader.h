// Bytes in memory for OpenImageIO's decoders, whose own reader follows any offset that a file names.
#pragma once

#include "load/bytes.h"

#include <OpenImageIO/filesystem.h>

namespace isolux {

/// The bytes must outlive it. Nothing outside of them is read: no offset leads there. (The decoder of JPEG knows its
/// base by name, and takes the bytes from that.)
class MemoryReader : public OIIO::Filesystem::IOMemReader {
public:
    explicit MemoryReader(ByteSpan bytes) : IOMemReader(bytes.data(), bytes.size()) {}

    bool seek(std::int64_t offset) override { return isInside(offset) && IOMemReader::seek(offset); }
    std::size_t pread(void* target, std::size_t count, std::int64_t offset) override {
        return isInside(offset) ? IOMemReader::pread(target, count, offset) : 0;
    }

private:
    /// The end included.
    [[nodiscard]] bool isInside(std::int64_t offset) const {
        return offset >= 0 && static_cast<std::uint64_t>(offset) <= size();
    }
};

} // namespace isolux
