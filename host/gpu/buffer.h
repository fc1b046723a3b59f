// A buffer with its own memory, and the ways data gets in and out of it.
#pragma once

#include "gpu/device.h"

#include <cstddef>
#include <span>

namespace isolux {

/// Where a buffer is used from, which decides its memory.
enum class BufferAccess {
    deviceOnly, ///< fastest for kernels; filled once by `upload` (mapped if the memory allows it, staged otherwise)
    hostReads,  ///< kernels write it, the host reads it back: cached host memory if there is any
    hostWrites  ///< the host writes small amounts often
};

class Buffer {
public:
    /// `size` bytes (at least 16 are allocated). Throws Error with exit code 75 if memory runs out.
    Buffer(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage, BufferAccess access);

    [[nodiscard]] VkBuffer handle() const { return buffer_.get(); }
    [[nodiscard]] VkDeviceSize size() const { return size_; }

    /// Host view of the whole buffer; empty if its memory cannot be mapped.
    [[nodiscard]] std::span<std::byte> mapped() const { return mapped_; }
    /// Makes host writes visible to the device, or device writes to the host, where memory is not coherent.
    void flush() const;
    void invalidate() const;

    /// A view of the buffer as 4 x 32-bit unsigned texels, for `texelCount` texels.
    [[nodiscard]] DeviceHandle<VkBufferView> texelView(VkDeviceSize texelCount) const;

private:
    const Device* device_;
    VkDeviceSize size_;
    DeviceHandle<VkBuffer> buffer_;
    DeviceHandle<VkDeviceMemory> memory_;
    std::span<std::byte> mapped_;
    bool coherent_ = true;
};

} // namespace isolux
