#include "gpu/specialize.h"

#include "core/error.h"

#include <spirv-tools/libspirv.h>
#include <spirv-tools/optimizer.hpp>

#include <cstring>
#include <string>
#include <unordered_map>

namespace isolux {
namespace {

/// After the constants have their values, by spirv-opt's names.
const std::vector<std::string> kPasses{"--freeze-spec-const",
                                       "--fold-spec-const-op-composite",
                                       "--ccp",
                                       "--eliminate-dead-branches",
                                       "--merge-blocks",
                                       "--eliminate-dead-functions",
                                       "--eliminate-dead-code-aggressive"};

} // namespace

std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> spirv, const Specialization& constants) {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    for (const auto& [id, value] : constants) values[id] = {value};
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    std::string message;
    optimizer.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { message = text; });
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values));
    if (!optimizer.RegisterPassesFromFlags(kPasses)) throwFailure("SPIR-V", "SPIRV-Tools lacks a pass: " + message);
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // the module was validated when it was built
    std::vector<std::uint32_t> folded;
    if (!optimizer.Run(spirv.data(), spirv.size(), &folded, options))
        throwFailure("SPIR-V", "SPIRV-Tools cannot specialise the kernel: " + message);
    return folded;
}

PipelineKey specializedKey(std::span<const std::uint32_t> spirv, const Specialization& constants) {
    std::string maker = spvSoftwareVersionDetailsString();
    for (const std::string& pass : kPasses) maker += pass;
    return {{}, hashKernel(spirv, constants, maker)};
}

std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> spirv, const Specialization& constants,
                                      const PipelineFolder& folder) {
    if (!folder.kept()) return specialize(spirv, constants);
    const PipelineKey key = specializedKey(spirv, constants);
    const std::vector<std::byte> bytes = folder.load(key);
    if (bytes.empty()) {
        std::vector<std::uint32_t> folded = specialize(spirv, constants);
        folder.store(key, std::as_bytes(std::span(folded)));
        return folded;
    }
    std::vector<std::uint32_t> folded(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(folded.data(), bytes.data(), folded.size() * sizeof(std::uint32_t));
    return folded;
}

} // namespace isolux
