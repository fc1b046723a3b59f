#include "load/accessor.h"

#include "load/context.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <limits>

namespace isolux {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and elements are read as they are");

template <typename T> T readAs(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

std::uint32_t readUnsigned(const std::uint8_t* bytes, int componentType) {
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return readAs<std::uint16_t>(bytes);
    default: return readAs<std::uint32_t>(bytes);
    }
}

std::size_t bytesOfType(int componentType) {
    return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(componentType)));
}

/// The bytes of a bufferView from an offset on; verified to lie within the buffer.
ByteSpan bytesFrom(const Asset& asset, int bufferView, std::size_t offset) {
    const tinygltf::BufferView& view = asset.model.bufferViews[static_cast<std::size_t>(bufferView)];
    return asset.buffers.spans[static_cast<std::size_t>(view.buffer)].subspan(view.byteOffset).subspan(offset);
}

} // namespace

bool hasData(const tinygltf::Accessor& accessor) { return accessor.bufferView >= 0 || accessor.sparse.isSparse; }

AccessorView::AccessorView(const Asset& asset, std::size_t accessor, const LoadContext& context) {
    const tinygltf::Accessor& source = asset.model.accessors[accessor];
    count_ = source.count;
    componentType_ = source.componentType;
    decoding_ = source.normalized ? Decoding::normalized : Decoding::plain;
    elementBytes_ = bytesOfType(componentType_) *
                    static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(source.type)));
    if (source.bufferView >= 0) {
        base_ = bytesFrom(asset, source.bufferView, source.byteOffset);
        const tinygltf::BufferView& view = asset.model.bufferViews[static_cast<std::size_t>(source.bufferView)];
        stride_ = view.byteStride != 0 ? view.byteStride : elementBytes_;
    }
    if (!source.sparse.isSparse) return;
    const auto& sparse = source.sparse;
    sparseCount_ = static_cast<std::size_t>(sparse.count);
    sparseIndexType_ = sparse.indices.componentType;
    sparseIndices_ = bytesFrom(asset, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset));
    sparseValues_ = bytesFrom(asset, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset));
    verifySparseIndices(fmt::format("/accessors/{}/sparse/indices", accessor), context);
}

std::uint32_t AccessorView::sparseIndex(std::size_t entry) const {
    return readUnsigned(sparseIndices_.data() + entry * bytesOfType(sparseIndexType_), sparseIndexType_);
}

void AccessorView::verifySparseIndices(std::string_view pointer, const LoadContext& context) const {
    for (std::size_t i = 0; i < sparseCount_; ++i) {
        const std::uint32_t index = sparseIndex(i);
        if (index >= count_)
            context.fail(pointer,
                         fmt::format("element {} is {}, but the accessor has only {} elements", i, index, count_));
        if (i > 0 && index <= sparseIndex(i - 1))
            context.fail(pointer, fmt::format("element {} is {} and follows {}, but they must increase strictly", i,
                                              index, sparseIndex(i - 1)));
    }
}

/// Where an element's bytes are; null for one that is zero.
const std::uint8_t* AccessorView::find(std::size_t element) const {
    std::size_t first = 0;
    std::size_t last = sparseCount_;
    while (first < last) {
        const std::size_t middle = first + (last - first) / 2;
        const std::uint32_t index = sparseIndex(middle);
        if (index == element) return sparseValues_.data() + middle * elementBytes_;
        if (index < element)
            first = middle + 1;
        else
            last = middle;
    }
    return base_.empty() ? nullptr : base_.data() + element * stride_;
}

template <int N, typename T> glm::vec<N, float> AccessorView::decode(const std::uint8_t* element) const {
    glm::vec<N, float> result;
    for (int i = 0; i < N; ++i) {
        const auto value = static_cast<float>(readAs<T>(element + static_cast<std::size_t>(i) * sizeof(T)));
        // glTF 2.0, 3.6.2.2: c / largest, and the least signed integer is -1 as well.
        constexpr auto kLargest = static_cast<float>(std::numeric_limits<T>::max());
        const bool isScaled = std::is_integral_v<T> && decoding_ == Decoding::normalized;
        result[i] = isScaled ? std::max(value / kLargest, -1.0f) : value;
    }
    return result;
}

template <int N> glm::vec<N, float> AccessorView::read(std::size_t element) const {
    const std::uint8_t* bytes = find(element);
    if (bytes == nullptr) return glm::vec<N, float>(0.0f);
    switch (componentType_) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return decode<N, std::int8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return decode<N, std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return decode<N, std::int16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return decode<N, std::uint16_t>(bytes);
    default: return decode<N, float>(bytes);
    }
}

template glm::vec<2, float> AccessorView::read<2>(std::size_t element) const;
template glm::vec<3, float> AccessorView::read<3>(std::size_t element) const;
template glm::vec<4, float> AccessorView::read<4>(std::size_t element) const;

std::uint32_t AccessorView::readIndex(std::size_t element) const {
    const std::uint8_t* bytes = find(element);
    return bytes == nullptr ? 0 : readUnsigned(bytes, componentType_);
}

std::uint32_t AccessorView::restartIndex() const {
    switch (componentType_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 0xFFu;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 0xFFFFu;
    default: return 0xFFFFFFFFu;
    }
}

} // namespace isolux
