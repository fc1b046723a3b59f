// What a SPIR-V module says about its own interface: bindings, struct layouts, loops.
#pragma once

#include "gpu/vulkan.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace isolux {

struct SpirvBinding {
    std::uint32_t binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
};

struct SpirvMember {
    std::string name;
    std::uint32_t offset = 0;
};

struct SpirvModule {
    std::vector<SpirvBinding> bindings;                      ///< of descriptor set 0, by number
    std::map<std::string, std::vector<SpirvMember>> structs; ///< members that have offsets, by struct name
    std::map<std::string, std::uint32_t> arrayStrides;       ///< bytes from element to element of arrays of a struct
    std::size_t loopCount = 0;
    std::size_t switchCount = 0; ///< SPIRV-Tools turns early returns into switches, and Mesa those into loops
};

/// Reads a module that SPIRV-Tools has validated. Throws Error on anything it cannot make sense of.
[[nodiscard]] SpirvModule reflectSpirv(std::span<const std::uint32_t> words);

} // namespace isolux
