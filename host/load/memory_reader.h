// Bytes in memory for OpenImageIO's decoders, whose own reader follows any offset that a file names.
#pragma once

#include "load/bytes.h"

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cstring>

namespace isolux {

/// The bytes must outlive it. Nothing outside of them is read: what lies there counts as the end of the file.
class MemoryReader : public OIIO::Filesystem::IOProxy {
public:
    explicit MemoryReader(ByteSpan bytes) : IOProxy("", Read), bytes_(bytes) {}

    [[nodiscard]] const char* proxytype() const override { return "memory"; }
    [[nodiscard]] std::size_t size() const override { return bytes_.size(); }

    bool seek(std::int64_t offset) override {
        if (offset < 0 || static_cast<std::uint64_t>(offset) > bytes_.size()) return false;
        m_pos = offset;
        return true;
    }
    std::size_t read(void* target, std::size_t count) override {
        const std::size_t done = pread(target, count, m_pos);
        m_pos += static_cast<std::int64_t>(done);
        return done;
    }
    std::size_t pread(void* target, std::size_t count, std::int64_t offset) override {
        if (offset < 0 || static_cast<std::uint64_t>(offset) >= bytes_.size()) return 0;
        const ByteSpan rest = bytes_.subspan(static_cast<std::size_t>(offset));
        const std::size_t done = std::min(count, rest.size());
        std::memcpy(target, rest.data(), done);
        return done;
    }

private:
    ByteSpan bytes_;
};

} // namespace isolux
