#include "gpu/specialize.h"

#include "core/error.h"

#include <spirv-tools/optimizer.hpp>

#include <string>
#include <unordered_map>

namespace isolux {

std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> spirv, const Specialization& constants) {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    for (const auto& [id, value] : constants) values[id] = {value};
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    std::string message;
    optimizer.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { message = text; });
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // the module was validated when it was built
    std::vector<std::uint32_t> folded;
    if (!optimizer.Run(spirv.data(), spirv.size(), &folded, options))
        throwFailure("SPIR-V", "SPIRV-Tools cannot specialise the kernel: " + message);
    return folded;
}

} // namespace isolux
