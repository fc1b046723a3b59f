// A Vulkan device chosen among those present, with one compute queue.
#pragma once

#include "gpu/pipeline_cache.h"
#include "gpu/vulkan.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace isolux {

/// Limits and properties that decide how work is laid out.
struct DeviceLimits {
    VkDeviceSize maxStorageBufferRange = 0;
    VkDeviceSize maxAllocationSize = 0;
    VkDeviceSize maxTexelBufferElements = 0;
    std::uint32_t maxWorkgroupSize = 0;
    std::uint32_t maxWorkgroupCount = 0;
    std::uint32_t subgroupSize = 1;
    double secondsPerTimestamp = 0.0; ///< 0: the queue has no timestamps
    std::uint64_t timestampMask = 0;
};

/// What is known of a physical device before it is opened.
struct DeviceDescription {
    std::uint32_t index = 0;
    std::string name;
    std::string driverName;
    std::string driverVersion; ///< as the driver states it, e.g. with the versions of Mesa and LLVM
    std::string type;          ///< "discrete GPU", "software", ...
    bool software = false;
    std::string apiVersion;
    DeviceLimits limits;
    std::string unusable; ///< why Isolux cannot use it; empty if it can
};

enum class Validation { off, on };

struct DeviceOptions {
    std::string selector; ///< index or part of a name; empty: the best usable device
    Validation validation = Validation::off;
    std::filesystem::path cacheFolder{}; ///< of compiled pipelines; empty: none are kept
};

class Device {
public:
    explicit Device(const DeviceOptions& options);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] VkDevice handle() const { return device_; }
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] std::uint32_t queueFamily() const { return queueFamily_; }
    [[nodiscard]] const DeviceDescription& description() const { return description_; }
    [[nodiscard]] const DeviceLimits& limits() const { return description_.limits; }
    [[nodiscard]] const DriverIdentity& identity() const { return identity_; }
    [[nodiscard]] const std::filesystem::path& cacheFolder() const { return cacheFolder_; }

    /// The first memory type allowed by `typeBits` with all of `wanted`, else with all of `required`. Throws Error.
    [[nodiscard]] std::uint32_t memoryType(std::uint32_t typeBits, VkMemoryPropertyFlags required,
                                           VkMemoryPropertyFlags wanted) const;
    [[nodiscard]] VkMemoryPropertyFlags memoryFlags(std::uint32_t type) const;
    /// The largest single allocation of a memory type: its heap's size, or the driver's limit.
    [[nodiscard]] VkDeviceSize maxAllocation(std::uint32_t type) const;

    /// What the validation layers have said so far; always empty with Validation::off.
    [[nodiscard]] std::vector<std::string> validationMessages() const;

private:
    struct MessageLog;

    void createInstance(Validation validation);
    void choosePhysicalDevice(const std::string& selector);
    void createDevice();
    void destroy() noexcept;

    std::unique_ptr<MessageLog> messages_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queueFamily_ = 0;
    DeviceDescription description_;
    DriverIdentity identity_;
    std::filesystem::path cacheFolder_;
    VkPhysicalDeviceMemoryProperties memory_{};
};

/// Every physical device with the reason why it cannot be used, if there is one. Throws Error without a Vulkan loader.
[[nodiscard]] std::vector<DeviceDescription> listDevices();

} // namespace isolux
