// Reads elements of verified accessors, sparse ones included.
#pragma once

#include "core/math.h"
#include "load/buffers.h"
#include "load/model.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace isolux {

/// A parsed model with the bytes behind it.
struct Asset {
    tinygltf::Model model;
    Buffers buffers;
};

/// Whether an accessor has any data of its own. One without is all zeros (glTF 2.0, 3.6.2.1).
[[nodiscard]] bool hasData(const tinygltf::Accessor& accessor);

/// The elements of one accessor, verified to lie within their buffers. It copies nothing: an element that a sparse
/// accessor replaces is found by bisection, and one that has no bufferView behind it is zero.
class AccessorView {
public:
    /// Throws Error where the indices of a sparse accessor are out of range or do not increase strictly.
    AccessorView(const Asset& asset, std::size_t accessor, const LoadContext& context);

    [[nodiscard]] std::size_t count() const { return count_; }

    /// `N` numbers (2, 3 or 4); normalised integers are decoded.
    template <int N> [[nodiscard]] glm::vec<N, float> read(std::size_t element) const;
    /// An unsigned integer of whatever width the accessor has.
    [[nodiscard]] std::uint32_t readIndex(std::size_t element) const;
    /// The index that this width reserves for primitive restart.
    [[nodiscard]] std::uint32_t restartIndex() const;

private:
    enum class Decoding { plain, normalized };

    [[nodiscard]] const std::uint8_t* find(std::size_t element) const;
    [[nodiscard]] std::uint32_t sparseIndex(std::size_t entry) const;
    void verifySparseIndices(std::string_view pointer, const LoadContext& context) const;
    template <int N, typename T> [[nodiscard]] glm::vec<N, float> decode(const std::uint8_t* element) const;

    ByteSpan base_; ///< empty: zeros
    std::size_t stride_ = 0;
    std::size_t count_ = 0;
    int componentType_ = 0;
    Decoding decoding_ = Decoding::plain;

    ByteSpan sparseIndices_;
    ByteSpan sparseValues_;
    std::size_t sparseCount_ = 0;
    int sparseIndexType_ = 0;
    std::size_t elementBytes_ = 0;
};

} // namespace isolux
