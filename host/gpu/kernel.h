// A compute pipeline made from one SPIR-V module: bindings by reflection, specialisation named where it is made.
#pragma once

#include "gpu/buffer.h"
#include "gpu/pipeline_cache.h"
#include "gpu/spirv_reflection.h"

#include <span>

namespace isolux {

struct KernelSource {
    std::span<const std::uint32_t> spirv;
    Specialization specialization;
    std::uint32_t pushConstantSize = 0; ///< bytes
};

class Kernel {
public:
    Kernel(const Device& device, const KernelSource& source);

    /// What a binding refers to from now on. Texel buffers take the view, others the whole buffer.
    void bind(std::uint32_t binding, const Buffer& buffer);
    void bindTexels(std::uint32_t binding, VkBufferView view);

    /// Records the dispatch of `groupCount` workgroups.
    void record(VkCommandBuffer commands, std::span<const std::byte> pushConstants, std::uint32_t groupCount) const;

private:
    void createLayouts(std::uint32_t pushConstantSize);
    void createPipeline(const KernelSource& source);
    void createDescriptorSet();

    const Device* device_;
    std::vector<SpirvBinding> bindings_;
    DeviceHandle<VkDescriptorSetLayout> setLayout_;
    DeviceHandle<VkPipelineLayout> layout_;
    DeviceHandle<VkPipeline> pipeline_;
    DeviceHandle<VkDescriptorPool> pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace isolux
