#include "gpu/buffer.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace isolux {
namespace {

constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
constexpr VkMemoryPropertyFlags kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;

std::uint32_t chooseMemoryType(const Device& device, std::uint32_t typeBits, BufferAccess access) {
    switch (access) {
    case BufferAccess::deviceOnly: return device.memoryType(typeBits, 0, kLocal);
    case BufferAccess::hostReads: return device.memoryType(typeBits, kVisible, kCached);
    case BufferAccess::hostWrites: return device.memoryType(typeBits, kVisible, kCoherent);
    }
    throwFailure("Buffer", "unknown access");
}

/// The call with what it asked for, which tells a user what to make smaller.
std::string sizedCall(const char* call, VkDeviceSize size) {
    constexpr VkDeviceSize kMebibyte = VkDeviceSize{1} << 20;
    return size < kMebibyte ? fmt::format("{} (a buffer of {} bytes)", call, size)
                            : fmt::format("{} (a buffer of {} MiB)", call, size / kMebibyte);
}

} // namespace

Buffer::Buffer(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage, BufferAccess access)
    : device_(&device), size_(std::max<VkDeviceSize>(size, 16)) {
    auto info = vulkanStruct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = size_;
    info.usage = usage;
    info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(device.handle(), &info, nullptr, &buffer), sizedCall("vkCreateBuffer", size_));
    buffer_ = {device.handle(), buffer, vkDestroyBuffer};

    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device.handle(), buffer, &requirements);
    auto allocation = vulkanStruct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize = requirements.size;
    allocation.memoryTypeIndex = chooseMemoryType(device, requirements.memoryTypeBits, access);
    // Checked here, because some drivers hand out more than their heap holds.
    if (requirements.size > device.maxAllocation(allocation.memoryTypeIndex))
        throw Error(ExitCode::tryAgain, device.description().name,
                    fmt::format("a buffer of {} MiB is more than the {} MiB it can allocate at once",
                                requirements.size >> 20, device.maxAllocation(allocation.memoryTypeIndex) >> 20));
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device.handle(), &allocation, nullptr, &memory),
          sizedCall("vkAllocateMemory", requirements.size));
    memory_ = {device.handle(), memory, vkFreeMemory};
    check(vkBindBufferMemory(device.handle(), buffer, memory, 0), "vkBindBufferMemory");

    const VkMemoryPropertyFlags flags = device.memoryFlags(allocation.memoryTypeIndex);
    coherent_ = (flags & kCoherent) != 0;
    if ((flags & kVisible) == 0) return;
    void* pointer = nullptr;
    check(vkMapMemory(device.handle(), memory, 0, VK_WHOLE_SIZE, 0, &pointer), "vkMapMemory");
    mapped_ = {static_cast<std::byte*>(pointer), size_};
}

void Buffer::flush() const {
    if (coherent_) return;
    auto range = vulkanStruct<VkMappedMemoryRange>(VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE);
    range.memory = memory_.get();
    range.size = VK_WHOLE_SIZE;
    check(vkFlushMappedMemoryRanges(device_->handle(), 1, &range), "vkFlushMappedMemoryRanges");
}

void Buffer::invalidate() const {
    if (coherent_) return;
    auto range = vulkanStruct<VkMappedMemoryRange>(VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE);
    range.memory = memory_.get();
    range.size = VK_WHOLE_SIZE;
    check(vkInvalidateMappedMemoryRanges(device_->handle(), 1, &range), "vkInvalidateMappedMemoryRanges");
}

DeviceHandle<VkBufferView> Buffer::texelView(VkDeviceSize texelCount) const {
    auto info = vulkanStruct<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
    info.buffer = buffer_.get();
    info.format = VK_FORMAT_R32G32B32A32_UINT;
    info.range = texelCount * 16;
    VkBufferView view = VK_NULL_HANDLE;
    check(vkCreateBufferView(device_->handle(), &info, nullptr, &view), "vkCreateBufferView");
    return {device_->handle(), view, vkDestroyBufferView};
}

} // namespace isolux
