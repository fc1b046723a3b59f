// The Vulkan API (loaded at run time by volk, so that a machine without a loader can still use the CPU), and the check
// that every call's result goes through.
#pragma once

#include <volk.h>

#include <string_view>
#include <utility>

namespace isolux {

/// Throws Error naming the call and the result unless it is VK_SUCCESS. A lost device and exhausted memory ask for
/// exit code 75: the same work may succeed later or elsewhere.
void check(VkResult result, std::string_view call);

/// A zeroed Vulkan structure of the given type.
template <typename Info> [[nodiscard]] Info vulkanStruct(VkStructureType type) {
    Info info{};
    info.sType = type;
    return info;
}

/// A handle that its device destroys; movable, and null after a move.
template <typename Handle> class DeviceHandle {
public:
    using Destroy = void (*)(VkDevice, Handle, const VkAllocationCallbacks*);

    DeviceHandle() = default;
    DeviceHandle(VkDevice device, Handle handle, Destroy destroy)
        : device_(device), handle_(handle), destroy_(destroy) {}
    DeviceHandle(const DeviceHandle&) = delete;
    DeviceHandle& operator=(const DeviceHandle&) = delete;
    DeviceHandle(DeviceHandle&& other) noexcept { swap(other); }
    DeviceHandle& operator=(DeviceHandle&& other) noexcept {
        swap(other);
        return *this;
    }
    ~DeviceHandle() {
        if (handle_ != VK_NULL_HANDLE) destroy_(device_, handle_, nullptr);
    }

    [[nodiscard]] Handle get() const { return handle_; }

private:
    void swap(DeviceHandle& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        std::swap(destroy_, other.destroy_);
    }

    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_ = VK_NULL_HANDLE;
    Destroy destroy_ = nullptr;
};

} // namespace isolux
