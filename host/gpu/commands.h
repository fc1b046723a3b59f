// Records commands, runs them and waits; one submission at a time, timed by the device where it can.
#pragma once

#include "gpu/buffer.h"

#include <functional>

namespace isolux {

class CommandRunner {
public:
    explicit CommandRunner(const Device& device);

    /// Runs what `record` records and waits for it. Everything recorded is ordered after earlier runs, host writes
    /// before it are seen, and what it writes can be read by the host afterwards. Returns its duration in seconds:
    /// by device timestamps, or by the host's clock on a queue without them.
    double run(const std::function<void(VkCommandBuffer)>& record);

    /// Fills a deviceOnly buffer, directly where its memory is mapped, through a staging buffer elsewhere.
    void upload(const Buffer& target, std::span<const std::byte> bytes);

private:
    void begin() const;
    void end() const;
    void submitAndWait() const;
    [[nodiscard]] double elapsedSeconds(double hostSeconds) const;

    const Device* device_;
    DeviceHandle<VkCommandPool> pool_;
    DeviceHandle<VkFence> fence_;
    DeviceHandle<VkQueryPool> timestamps_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

} // namespace isolux
