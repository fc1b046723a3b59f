// The tables buffer while it is written: records of shaders/shared one after the other, in 16-byte words.
#pragma once

#include <glm/vec4.hpp>

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace isolux {

class Tables {
public:
    /// The first word of what is appended next.
    [[nodiscard]] std::uint32_t next() const { return static_cast<std::uint32_t>(words_.size()); }

    template <typename Record> void append(const Record& record) {
        static_assert(sizeof(Record) % sizeof(glm::uvec4) == 0);
        appendBytes(&record, sizeof(Record));
    }
    /// Filled up to whole words with zeros.
    template <typename Value> void appendAll(std::span<const Value> values) {
        appendBytes(values.data(), values.size_bytes());
    }

    [[nodiscard]] std::vector<glm::uvec4> take() { return std::move(words_); }

private:
    void appendBytes(const void* data, std::size_t bytes) {
        const std::size_t first = words_.size();
        words_.resize(first + (bytes + sizeof(glm::uvec4) - 1) / sizeof(glm::uvec4));
        if (bytes > 0) std::memcpy(&words_[first], data, bytes);
    }

    std::vector<glm::uvec4> words_;
};

} // namespace isolux
