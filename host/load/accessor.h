// Reads elements of verified accessors.
#pragma once

#include "core/math.h"
#include "load/buffers.h"
#include "load/model.h"

#include <cstring>

namespace isolux {

/// A parsed model with the bytes behind it.
struct Asset {
    tinygltf::Model model;
    Buffers buffers;
};

/// The elements of one accessor that has a bufferView. Verified to lie within their buffer.
class AccessorView {
public:
    AccessorView(const Asset& asset, std::size_t accessor);

    [[nodiscard]] std::size_t count() const { return count_; }

    template <typename T> [[nodiscard]] T read(std::size_t element, std::size_t component = 0) const {
        T value;
        std::memcpy(&value, bytes_.data() + element * stride_ + component * sizeof(T), sizeof(T));
        return value;
    }
    [[nodiscard]] Vec3f readVec3(std::size_t element) const {
        return {read<float>(element, 0), read<float>(element, 1), read<float>(element, 2)};
    }
    /// An unsigned integer of whatever width the accessor has.
    [[nodiscard]] std::uint32_t readIndex(std::size_t element) const;

private:
    ByteSpan bytes_;
    std::size_t stride_ = 0;
    std::size_t count_ = 0;
    int componentType_ = 0;
};

} // namespace isolux
