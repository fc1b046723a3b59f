// A Vulkan layer that passes every call on and lets the device fail at a chosen one, as no driver does when asked to.
//
//   ISOLUX_FAULT_AFTER=N         the device is lost once N submissions have gone well
//   ISOLUX_FAULT_IN=wait         the submission is taken and the wait for it reports the loss, not vkQueueSubmit
//   ISOLUX_FAULT_MEMORY_AFTER=N  there is no memory left once N allocations have gone well
//
// One instance and one device at a time, which is what the program under test has. The interface is that of the
// loader's LoaderLayerInterface.md, version 2.
#include <vulkan/vk_layer.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string_view>

namespace {

/// The calls of the layer below, or of the driver.
struct Next {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    PFN_vkGetDeviceProcAddr getDeviceProcAddr = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    PFN_vkQueueSubmit queueSubmit = nullptr;
    PFN_vkWaitForFences waitForFences = nullptr;
    PFN_vkGetFenceStatus getFenceStatus = nullptr;
    PFN_vkDeviceWaitIdle deviceWaitIdle = nullptr;
    PFN_vkAllocateMemory allocateMemory = nullptr;
};
Next next;

std::atomic<std::uint64_t> submissions{0};
std::atomic<std::uint64_t> allocations{0};
std::atomic<bool> lost{false};

std::uint64_t numberIn(const char* variable) {
    const char* text = std::getenv(variable);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : std::numeric_limits<std::uint64_t>::max();
}

bool lossShowsInWait() {
    const char* text = std::getenv("ISOLUX_FAULT_IN");
    return text != nullptr && std::string_view(text) == "wait";
}

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* infos,
                                           VkFence fence) {
    if (lost) return VK_ERROR_DEVICE_LOST;
    if (submissions++ < numberIn("ISOLUX_FAULT_AFTER")) return next.queueSubmit(queue, count, infos, fence);
    lost = true;
    return lossShowsInWait() ? next.queueSubmit(queue, count, infos, fence) : VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL waitForFences(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                                             std::uint64_t timeout) {
    if (!lost) return next.waitForFences(device, count, fences, all, timeout);
    next.deviceWaitIdle(device); // a lost device runs nothing any more, and what it used may be freed
    return VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL getFenceStatus(VkDevice device, VkFence fence) {
    return lost ? VK_ERROR_DEVICE_LOST : next.getFenceStatus(device, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL allocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
    if (allocations++ >= numberIn("ISOLUX_FAULT_MEMORY_AFTER")) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return next.allocateMemory(device, info, allocator, memory);
}

/// The loader's record of the next layer, which every layer advances for the one below.
template <typename LayerInfo, typename CreateInfo> LayerInfo* linkIn(const CreateInfo* info, VkStructureType type) {
    const auto* item = static_cast<const LayerInfo*>(info->pNext);
    while (item != nullptr && !(item->sType == type && item->function == VK_LAYER_LINK_INFO))
        item = static_cast<const LayerInfo*>(item->pNext);
    return const_cast<LayerInfo*>(item);
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
    auto* link = linkIn<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    next.getInstanceProcAddr = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(next.getInstanceProcAddr(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result == VK_SUCCESS) next.instance = *instance;
    return result;
}

template <typename Function> void find(Function& function, VkDevice device, const char* name) {
    function = reinterpret_cast<Function>(next.getDeviceProcAddr(device, name));
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* link = linkIn<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr getInstanceProcAddr = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    next.getDeviceProcAddr = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(getInstanceProcAddr(next.instance, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, device);
    if (result != VK_SUCCESS) return result;
    find(next.queueSubmit, *device, "vkQueueSubmit");
    find(next.waitForFences, *device, "vkWaitForFences");
    find(next.getFenceStatus, *device, "vkGetFenceStatus");
    find(next.deviceWaitIdle, *device, "vkDeviceWaitIdle");
    find(next.allocateMemory, *device, "vkAllocateMemory");
    return VK_SUCCESS;
}

PFN_vkVoidFunction getInstanceFunction(VkInstance instance, const char* name);
PFN_vkVoidFunction getDeviceFunction(VkDevice device, const char* name);

/// This layer's own version of a function, if it has one.
PFN_vkVoidFunction ownFunction(std::string_view name) {
    const auto own = [](auto* function) { return reinterpret_cast<PFN_vkVoidFunction>(function); };
    if (name == "vkGetInstanceProcAddr") return own(getInstanceFunction);
    if (name == "vkGetDeviceProcAddr") return own(getDeviceFunction);
    if (name == "vkCreateInstance") return own(createInstance);
    if (name == "vkCreateDevice") return own(createDevice);
    if (name == "vkQueueSubmit") return own(queueSubmit);
    if (name == "vkWaitForFences") return own(waitForFences);
    if (name == "vkGetFenceStatus") return own(getFenceStatus);
    if (name == "vkAllocateMemory") return own(allocateMemory);
    return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceFunction(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction own = ownFunction(name)) return own;
    return next.getInstanceProcAddr == nullptr ? nullptr : next.getInstanceProcAddr(instance, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceFunction(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction own = ownFunction(name)) return own;
    return next.getDeviceProcAddr(device, name);
}

} // namespace

extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* pVersionStruct) {
    if (pVersionStruct->loaderLayerInterfaceVersion < 2) return VK_ERROR_INITIALIZATION_FAILED;
    pVersionStruct->loaderLayerInterfaceVersion = 2;
    pVersionStruct->pfnGetInstanceProcAddr = getInstanceFunction;
    pVersionStruct->pfnGetDeviceProcAddr = getDeviceFunction;
    pVersionStruct->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
