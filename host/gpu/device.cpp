#include "gpu/device.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace isolux {
namespace {

constexpr std::uint32_t kApiVersion = VK_API_VERSION_1_2;
constexpr std::uint32_t kStorageBuffersNeeded = 11;
constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

void loadVulkan() {
    if (volkInitialize() != VK_SUCCESS)
        throwFailure("Vulkan", "no loader on this machine; install it (Debian: libvulkan1 and mesa-vulkan-drivers for "
                               "the software driver) or render with --backend reference");
}

[[noreturn]] void throwNoDriver() {
    throwFailure("Vulkan",
                 "no driver for any device; install one (Debian: mesa-vulkan-drivers has a software driver) or "
                 "render with --backend reference");
}

/// With `messenger` the validation layer is loaded, and reports to it from the creation of the instance on.
VkInstance makeInstance(const VkDebugUtilsMessengerCreateInfoEXT* messenger) {
    loadVulkan();
    auto application = vulkanStruct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "isolux";
    application.apiVersion = kApiVersion;
    auto info = vulkanStruct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    const std::array enabled{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    auto features = vulkanStruct<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    features.enabledValidationFeatureCount = static_cast<std::uint32_t>(enabled.size());
    features.pEnabledValidationFeatures = enabled.data();
    features.pNext = messenger;
    const std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    if (messenger != nullptr) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
        info.ppEnabledExtensionNames = extensions.data();
    }
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) throwNoDriver();
    if (result == VK_ERROR_LAYER_NOT_PRESENT)
        throwFailure("vkCreateInstance",
                     "the Khronos validation layer is not installed (Debian: vulkan-validationlayers)");
    check(result, "vkCreateInstance");
    volkLoadInstance(instance);
    return instance;
}

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance) {
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
    return devices;
}

std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    return families;
}

std::optional<std::uint32_t> computeQueueFamily(VkPhysicalDevice device) {
    const std::vector<VkQueueFamilyProperties> families = queueFamilies(device);
    for (std::uint32_t i = 0; i < families.size(); ++i)
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0) return i;
    return std::nullopt;
}

DeviceLimits limitsOf(VkPhysicalDevice device) {
    auto subgroup =
        vulkanStruct<VkPhysicalDeviceSubgroupProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES);
    auto properties = vulkanStruct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    auto maintenance = vulkanStruct<VkPhysicalDeviceMaintenance3Properties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES);
    subgroup.pNext = &maintenance;
    properties.pNext = &subgroup;
    vkGetPhysicalDeviceProperties2(device, &properties);
    const VkPhysicalDeviceLimits& vulkan = properties.properties.limits;
    DeviceLimits limits;
    limits.maxAllocationSize = maintenance.maxMemoryAllocationSize;
    limits.maxStorageBufferRange = vulkan.maxStorageBufferRange;
    limits.maxTexelBufferElements = vulkan.maxTexelBufferElements;
    limits.maxWorkgroupSize = std::min(vulkan.maxComputeWorkGroupInvocations, vulkan.maxComputeWorkGroupSize[0]);
    limits.maxWorkgroupCount = vulkan.maxComputeWorkGroupCount[0];
    limits.subgroupSize = std::max(subgroup.subgroupSize, 1u);
    const std::optional<std::uint32_t> family = computeQueueFamily(device);
    const std::uint32_t bits = family ? queueFamilies(device)[*family].timestampValidBits : 0;
    limits.timestampMask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    limits.secondsPerTimestamp = bits == 0 ? 0.0 : static_cast<double>(vulkan.timestampPeriod) * 1e-9;
    return limits;
}

const char* typeName(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "software";
    default: return "other";
    }
}

int preference(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return 1;
    default: return 0;
    }
}

std::string versionText(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

std::string whyUnusable(VkPhysicalDevice device, const VkPhysicalDeviceProperties& properties) {
    if (properties.apiVersion < kApiVersion)
        return fmt::format("it supports Vulkan {}, 1.2 is needed", versionText(properties.apiVersion));
    if (!computeQueueFamily(device)) return "it has no compute queue";
    if (properties.limits.maxPerStageDescriptorStorageBuffers < kStorageBuffersNeeded)
        return fmt::format("a shader can bind {} storage buffers, {} are needed",
                           properties.limits.maxPerStageDescriptorStorageBuffers, kStorageBuffersNeeded);
    return {};
}

DeviceDescription describe(VkPhysicalDevice device, std::uint32_t index) {
    VkPhysicalDeviceProperties basic;
    vkGetPhysicalDeviceProperties(device, &basic);
    DeviceDescription description;
    description.index = index;
    description.name = basic.deviceName;
    description.type = typeName(basic.deviceType);
    description.software = basic.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    description.apiVersion = versionText(basic.apiVersion);
    description.unusable = whyUnusable(device, basic);
    if (basic.apiVersion < kApiVersion) return description; // what follows is not there
    auto driver = vulkanStruct<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto properties = vulkanStruct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(device, &properties);
    description.driverName = driver.driverName;
    description.driverVersion = driver.driverInfo;
    if (description.driverVersion.empty()) description.driverVersion = versionText(basic.driverVersion);
    description.limits = limitsOf(device);
    return description;
}

DriverIdentity identityOf(const VkPhysicalDeviceProperties& properties) {
    DriverIdentity identity{properties.vendorID, properties.deviceID, properties.driverVersion, {}};
    std::copy(std::begin(properties.pipelineCacheUUID), std::end(properties.pipelineCacheUUID),
              identity.pipelineCacheUuid.begin());
    return identity;
}

std::string lowercase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Whether a selector names this device: by its number, or, if it is no device's number, by a part of its name.
bool matches(const DeviceDescription& description, const std::string& selector, std::size_t deviceCount) {
    for (std::size_t i = 0; i < deviceCount; ++i)
        if (std::to_string(i) == selector) return description.index == i;
    return lowercase(description.name).find(lowercase(selector)) != std::string::npos;
}

} // namespace

struct Device::MessageLog {
    std::mutex mutex;
    std::vector<std::string> messages;
};

Device::Device(const DeviceOptions& options)
    : messages_(std::make_unique<MessageLog>()), cacheFolder_(options.cacheFolder) {
    try {
        createInstance(options.validation);
        choosePhysicalDevice(options.selector);
        createDevice();
    } catch (...) {
        destroy();
        throw;
    }
}

Device::~Device() { destroy(); }

void Device::destroy() noexcept {
    if (device_ != VK_NULL_HANDLE) vkDestroyDevice(device_, nullptr);
    if (messenger_ != VK_NULL_HANDLE) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

void Device::createInstance(Validation validation) {
    if (validation == Validation::off) {
        instance_ = makeInstance(nullptr);
        return;
    }
    auto info =
        vulkanStruct<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pUserData = messages_.get();
    info.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) -> VkBool32 {
        auto* log = static_cast<MessageLog*>(user);
        const std::lock_guard lock(log->mutex);
        log->messages.emplace_back(data->pMessage);
        return VK_FALSE;
    };
    instance_ = makeInstance(&info);
    check(vkCreateDebugUtilsMessengerEXT(instance_, &info, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
}

void Device::choosePhysicalDevice(const std::string& selector) {
    const std::vector<VkPhysicalDevice> devices = physicalDevices(instance_);
    if (devices.empty()) throwNoDriver();
    int best = -1;
    std::string seen;
    for (std::uint32_t i = 0; i < devices.size(); ++i) {
        const DeviceDescription description = describe(devices[i], i);
        seen += fmt::format("\n  {}: {}{}{}", i, description.name,
                            description.unusable.empty() ? "" : ", unusable: ", description.unusable);
        if (!selector.empty() && !matches(description, selector, devices.size())) continue;
        if (!description.unusable.empty()) continue;
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (preference(properties.deviceType) <= best) continue;
        best = preference(properties.deviceType);
        physical_ = devices[i];
        description_ = description;
        identity_ = identityOf(properties);
    }
    if (physical_ != VK_NULL_HANDLE) return;
    if (selector.empty()) throwFailure("Vulkan", "no usable device among these:" + seen);
    throwBadInput("--device " + selector, "no usable device of this number or name among these:" + seen);
}

void Device::createDevice() {
    queueFamily_ = *computeQueueFamily(physical_);
    const float priority = 1.0f;
    auto queueInfo = vulkanStruct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queueInfo.queueFamilyIndex = queueFamily_;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    auto info = vulkanStruct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    check(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
    volkLoadDevice(device_);
    vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
}

std::uint32_t Device::memoryType(std::uint32_t typeBits, VkMemoryPropertyFlags required,
                                 VkMemoryPropertyFlags wanted) const {
    for (const VkMemoryPropertyFlags flags : {required | wanted, required})
        for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
            if ((typeBits & (1u << i)) != 0 && (memory_.memoryTypes[i].propertyFlags & flags) == flags) return i;
    throwFailure(description_.name, "it has no memory type that the host can read and write");
}

VkMemoryPropertyFlags Device::memoryFlags(std::uint32_t type) const { return memory_.memoryTypes[type].propertyFlags; }

VkDeviceSize Device::maxAllocation(std::uint32_t type) const {
    const VkDeviceSize heap = memory_.memoryHeaps[memory_.memoryTypes[type].heapIndex].size;
    return std::min(heap, description_.limits.maxAllocationSize);
}

std::vector<std::string> Device::validationMessages() const {
    const std::lock_guard lock(messages_->mutex);
    return messages_->messages;
}

std::vector<DeviceDescription> listDevices() {
    struct InstanceOwner {
        VkInstance instance;
        ~InstanceOwner() { vkDestroyInstance(instance, nullptr); }
    };
    const InstanceOwner owner{makeInstance(nullptr)};
    std::vector<DeviceDescription> descriptions;
    const std::vector<VkPhysicalDevice> devices = physicalDevices(owner.instance);
    for (std::uint32_t i = 0; i < devices.size(); ++i) descriptions.push_back(describe(devices[i], i));
    return descriptions;
}

} // namespace isolux
