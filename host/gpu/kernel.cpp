#include "gpu/kernel.h"

#include "gpu/specialize.h"

#include "core/log.h"

#include <algorithm>

namespace isolux {
namespace {

/// Of VkPipelineCacheHeaderVersionOne: a driver that keeps nothing returns this much.
constexpr std::size_t kEmptyCacheBytes = 32;

/// A driver's cache of one pipeline, from its file and back to it. Null where none is kept, or the driver has none.
class PipelineCache {
public:
    PipelineCache(const Device& device, const KernelSource& source)
        : device_(&device),
          folder_(device.cacheFolder()), key_{device.identity(), hashKernel(source.spirv, source.specialization)} {
        if (!folder_.kept()) return;
        loaded_ = folder_.load(key_);
        if (!create(loaded_) && !create({})) loaded_.clear();
    }
    [[nodiscard]] VkPipelineCache handle() const { return cache_.get(); }

    /// Keeps what the driver has added.
    void store() const {
        if (cache_.get() == VK_NULL_HANDLE) return;
        std::size_t size = 0;
        if (vkGetPipelineCacheData(device_->handle(), cache_.get(), &size, nullptr) != VK_SUCCESS) return;
        std::vector<std::byte> data(size);
        if (vkGetPipelineCacheData(device_->handle(), cache_.get(), &size, data.data()) != VK_SUCCESS) return;
        data.resize(size);
        spdlog::debug("pipeline cache: the driver has {} bytes of it", size);
        if (size > kEmptyCacheBytes && data != loaded_) folder_.store(key_, data);
    }

private:
    bool create(std::span<const std::byte> data) {
        auto info = vulkanStruct<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
        info.initialDataSize = data.size();
        info.pInitialData = data.data();
        VkPipelineCache cache = VK_NULL_HANDLE;
        if (vkCreatePipelineCache(device_->handle(), &info, nullptr, &cache) != VK_SUCCESS) return false;
        cache_ = {device_->handle(), cache, vkDestroyPipelineCache};
        return true;
    }

    const Device* device_;
    PipelineFolder folder_;
    PipelineKey key_;
    std::vector<std::byte> loaded_;
    DeviceHandle<VkPipelineCache> cache_;
};

} // namespace

Kernel::Kernel(const Device& device, const KernelSource& source)
    : device_(&device), bindings_(reflectSpirv(source.spirv).bindings) {
    createLayouts(source.pushConstantSize);
    createPipeline(source);
    createDescriptorSet();
}

void Kernel::createLayouts(std::uint32_t pushConstantSize) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const SpirvBinding& binding : bindings_)
        bindings.push_back({binding.binding, binding.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    auto setInfo = vulkanStruct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    setInfo.bindingCount = static_cast<std::uint32_t>(bindings.size());
    setInfo.pBindings = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device_->handle(), &setInfo, nullptr, &setLayout), "vkCreateDescriptorSetLayout");
    setLayout_ = {device_->handle(), setLayout, vkDestroyDescriptorSetLayout};

    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushConstantSize};
    auto info = vulkanStruct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    info.setLayoutCount = 1;
    info.pSetLayouts = &setLayout;
    info.pushConstantRangeCount = pushConstantSize > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device_->handle(), &info, nullptr, &layout), "vkCreatePipelineLayout");
    layout_ = {device_->handle(), layout, vkDestroyPipelineLayout};
}

void Kernel::createPipeline(const KernelSource& source) {
    const std::vector<std::uint32_t> spirv =
        specialize(source.spirv, source.specialization, PipelineFolder(device_->cacheFolder()));
    auto moduleInfo = vulkanStruct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    moduleInfo.codeSize = spirv.size() * sizeof(spirv[0]);
    moduleInfo.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device_->handle(), &moduleInfo, nullptr, &module), "vkCreateShaderModule");
    const DeviceHandle<VkShaderModule> moduleHandle(device_->handle(), module, vkDestroyShaderModule);

    auto info = vulkanStruct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout_.get();
    const PipelineCache cache(*device_, source);
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device_->handle(), cache.handle(), 1, &info, nullptr, &pipeline),
          "vkCreateComputePipelines");
    pipeline_ = {device_->handle(), pipeline, vkDestroyPipeline};
    cache.store();
}

void Kernel::createDescriptorSet() {
    std::vector<VkDescriptorPoolSize> sizes;
    for (const SpirvBinding& binding : bindings_) sizes.push_back({binding.type, 1});
    auto poolInfo = vulkanStruct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    poolInfo.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device_->handle(), &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
    pool_ = {device_->handle(), pool, vkDestroyDescriptorPool};

    const VkDescriptorSetLayout setLayout = setLayout_.get();
    auto info = vulkanStruct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &setLayout;
    check(vkAllocateDescriptorSets(device_->handle(), &info, &set_), "vkAllocateDescriptorSets");
}

void Kernel::bind(std::uint32_t binding, const Buffer& buffer) {
    const auto found = std::find_if(bindings_.begin(), bindings_.end(),
                                    [&](const SpirvBinding& candidate) { return candidate.binding == binding; });
    if (found == bindings_.end()) return; // the optimiser removed it: nothing reads it
    const VkDescriptorBufferInfo bufferInfo{buffer.handle(), 0, VK_WHOLE_SIZE};
    auto write = vulkanStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set_;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = found->type;
    write.pBufferInfo = &bufferInfo;
    vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
}

void Kernel::bindTexels(std::uint32_t binding, VkBufferView view) {
    const bool present = std::any_of(bindings_.begin(), bindings_.end(),
                                     [&](const SpirvBinding& candidate) { return candidate.binding == binding; });
    if (!present) return;
    auto write = vulkanStruct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set_;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    write.pTexelBufferView = &view;
    vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
}

void Kernel::record(VkCommandBuffer commands, std::span<const std::byte> pushConstants,
                    std::uint32_t groupCount) const {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set_, 0, nullptr);
    if (!pushConstants.empty())
        vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<std::uint32_t>(pushConstants.size()), pushConstants.data());
    vkCmdDispatch(commands, groupCount, 1, 1);
}

} // namespace isolux
