#include "load/accessor.h"

#include <bit>

namespace isolux {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and elements are read as they are");

AccessorView::AccessorView(const Asset& asset, std::size_t accessor) {
    const tinygltf::Accessor& source = asset.model.accessors[accessor];
    const tinygltf::BufferView& view = asset.model.bufferViews[static_cast<std::size_t>(source.bufferView)];
    bytes_ =
        asset.buffers.spans[static_cast<std::size_t>(view.buffer)].subspan(view.byteOffset).subspan(source.byteOffset);
    stride_ = static_cast<std::size_t>(source.ByteStride(view));
    count_ = source.count;
    componentType_ = source.componentType;
}

std::uint32_t AccessorView::readIndex(std::size_t element) const {
    switch (componentType_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return read<std::uint8_t>(element);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return read<std::uint16_t>(element);
    default: return read<std::uint32_t>(element);
    }
}

} // namespace isolux
