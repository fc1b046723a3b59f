#include "gpu/commands.h"

#include "core/stopwatch.h"

#include <array>
#include <cstring>

namespace isolux {
namespace {

void memoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags fromAccess,
                   VkPipelineStageFlags to, VkAccessFlags toAccess) {
    auto barrier = vulkanStruct<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    barrier.srcAccessMask = fromAccess;
    barrier.dstAccessMask = toAccess;
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

constexpr VkPipelineStageFlags kWork = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
constexpr VkAccessFlags kWrites = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
constexpr VkAccessFlags kReads = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_UNIFORM_READ_BIT;

} // namespace

CommandRunner::CommandRunner(const Device& device) : device_(&device) {
    auto poolInfo = vulkanStruct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    poolInfo.queueFamilyIndex = device.queueFamily();
    VkCommandPool pool = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool), "vkCreateCommandPool");
    pool_ = {device.handle(), pool, vkDestroyCommandPool};

    auto info = vulkanStruct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = pool;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle(), &info, &commands_), "vkAllocateCommandBuffers");

    const auto fenceInfo = vulkanStruct<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    VkFence fence = VK_NULL_HANDLE;
    check(vkCreateFence(device.handle(), &fenceInfo, nullptr, &fence), "vkCreateFence");
    fence_ = {device.handle(), fence, vkDestroyFence};

    if (device.limits().secondsPerTimestamp == 0.0) return;
    auto queryInfo = vulkanStruct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    queryInfo.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queryInfo.queryCount = 2;
    VkQueryPool queries = VK_NULL_HANDLE;
    check(vkCreateQueryPool(device.handle(), &queryInfo, nullptr, &queries), "vkCreateQueryPool");
    timestamps_ = {device.handle(), queries, vkDestroyQueryPool};
}

double CommandRunner::run(const std::function<void(VkCommandBuffer)>& record) {
    begin();
    record(commands_);
    end();
    const Stopwatch watch;
    submitAndWait();
    return elapsedSeconds(watch.seconds());
}

void CommandRunner::begin() const {
    auto info = vulkanStruct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &info), "vkBeginCommandBuffer");
    if (timestamps_.get() != VK_NULL_HANDLE) {
        vkCmdResetQueryPool(commands_, timestamps_.get(), 0, 2);
        vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps_.get(), 0);
    }
    memoryBarrier(commands_, kWork | VK_PIPELINE_STAGE_HOST_BIT, kWrites | VK_ACCESS_HOST_WRITE_BIT, kWork,
                  kReads | kWrites);
}

void CommandRunner::end() const {
    memoryBarrier(commands_, kWork, kWrites, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    if (timestamps_.get() != VK_NULL_HANDLE)
        vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_.get(), 1);
    check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
}

void CommandRunner::submitAndWait() const {
    const VkFence fence = fence_.get();
    check(vkResetFences(device_->handle(), 1, &fence), "vkResetFences");
    auto submit = vulkanStruct<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    check(vkQueueSubmit(device_->queue(), 1, &submit, fence), "vkQueueSubmit");
    constexpr std::uint64_t kSecond = 1'000'000'000;
    VkResult result = VK_TIMEOUT;
    while (result == VK_TIMEOUT) result = vkWaitForFences(device_->handle(), 1, &fence, VK_TRUE, kSecond);
    check(result, "vkWaitForFences");
}

double CommandRunner::elapsedSeconds(double hostSeconds) const {
    if (timestamps_.get() == VK_NULL_HANDLE) return hostSeconds;
    std::array<std::uint64_t, 2> ticks{};
    check(vkGetQueryPoolResults(device_->handle(), timestamps_.get(), 0, 2, sizeof(ticks), ticks.data(),
                                sizeof(ticks[0]), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    const std::uint64_t elapsed = (ticks[1] - ticks[0]) & device_->limits().timestampMask;
    return static_cast<double>(elapsed) * device_->limits().secondsPerTimestamp;
}

void CommandRunner::upload(const Buffer& target, std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    if (!target.mapped().empty()) {
        std::memcpy(target.mapped().data(), bytes.data(), bytes.size());
        target.flush();
        return;
    }
    const Buffer staging(*device_, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferAccess::hostWrites);
    std::memcpy(staging.mapped().data(), bytes.data(), bytes.size());
    staging.flush();
    run([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes.size()};
        vkCmdCopyBuffer(commands, staging.handle(), target.handle(), 1, &region);
    });
}

} // namespace isolux
