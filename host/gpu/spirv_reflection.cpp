#include "gpu/spirv_reflection.h"

#include "core/error.h"

#include <algorithm>
#include <cstring>

namespace isolux {
namespace {

// The few opcodes and enumerants needed (SPIR-V specification, 3.52 and 3.20).
enum Op : std::uint32_t {
    opName = 5,
    opMemberName = 6,
    opTypeImage = 25,
    opTypeArray = 28,
    opTypeRuntimeArray = 29,
    opTypeStruct = 30,
    opTypePointer = 32,
    opVariable = 59,
    opDecorate = 71,
    opMemberDecorate = 72,
    opLoopMerge = 246,
    opSwitch = 251
};
enum Decoration : std::uint32_t { arrayStride = 6, binding = 33, offset = 35 };
enum StorageClass : std::uint32_t { uniformConstant = 0, uniform = 2, storageBuffer = 12 };

constexpr std::size_t kHeaderWords = 5;
constexpr std::uint32_t kMagic = 0x07230203u;

struct Type {
    std::uint32_t op = 0;
    std::vector<std::uint32_t> operands;
};

struct Reader {
    std::map<std::uint32_t, std::string> names;
    std::map<std::uint32_t, std::map<std::uint32_t, std::string>> memberNames;
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> memberOffsets;
    std::map<std::uint32_t, std::uint32_t> bindings;
    std::map<std::uint32_t, std::uint32_t> strides;
    std::map<std::uint32_t, Type> types;
    struct Variable {
        std::uint32_t type;
        std::uint32_t id;
        std::uint32_t storage;
    };
    std::vector<Variable> variables;

    void read(std::uint32_t op, std::span<const std::uint32_t> operands);
};

std::string readString(std::span<const std::uint32_t> words) {
    const char* text = reinterpret_cast<const char*>(words.data());
    return {text, strnlen(text, words.size_bytes())};
}

void Reader::read(std::uint32_t op, std::span<const std::uint32_t> operands) {
    switch (op) {
    case opName: names[operands[0]] = readString(operands.subspan(1)); break;
    case opMemberName: memberNames[operands[0]][operands[1]] = readString(operands.subspan(2)); break;
    case opDecorate:
        if (operands[1] == binding) bindings[operands[0]] = operands[2];
        if (operands[1] == arrayStride) strides[operands[0]] = operands[2];
        break;
    case opMemberDecorate:
        if (operands[2] == offset) memberOffsets[operands[0]][operands[1]] = operands[3];
        break;
    case opTypeImage:
    case opTypeArray:
    case opTypeRuntimeArray:
    case opTypeStruct:
    case opTypePointer: types[operands[0]] = {op, {operands.begin() + 1, operands.end()}}; break;
    case opVariable: variables.push_back({operands[0], operands[1], operands[2]}); break;
    default: break;
    }
}

VkDescriptorType descriptorType(std::uint32_t storage) {
    switch (storage) {
    case uniformConstant: return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    case uniform: return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case storageBuffer: return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    default: throwFailure("SPIR-V", "a binding of a storage class that is not used in this project");
    }
}

} // namespace

SpirvModule reflectSpirv(std::span<const std::uint32_t> words) {
    if (words.size() < kHeaderWords || words[0] != kMagic) throwFailure("SPIR-V", "not a module");
    Reader reader;
    SpirvModule module;
    for (std::size_t i = kHeaderWords; i < words.size();) {
        const std::size_t count = words[i] >> 16;
        if (count == 0 || i + count > words.size()) throwFailure("SPIR-V", "truncated module");
        reader.read(words[i] & 0xFFFFu, words.subspan(i + 1, count - 1));
        module.loopCount += (words[i] & 0xFFFFu) == opLoopMerge ? 1 : 0;
        module.switchCount += (words[i] & 0xFFFFu) == opSwitch ? 1 : 0;
        i += count;
    }
    for (const Reader::Variable& variable : reader.variables) {
        const auto found = reader.bindings.find(variable.id);
        if (found != reader.bindings.end())
            module.bindings.push_back({found->second, descriptorType(variable.storage)});
    }
    std::sort(module.bindings.begin(), module.bindings.end(),
              [](const SpirvBinding& a, const SpirvBinding& b) { return a.binding < b.binding; });
    for (const auto& [id, offsets] : reader.memberOffsets)
        for (const auto& [member, bytes] : offsets)
            module.structs[reader.names[id]].push_back({reader.memberNames[id][member], bytes});
    for (const auto& [id, stride] : reader.strides) {
        const Type& array = reader.types[id];
        if (!array.operands.empty()) module.arrayStrides[reader.names[array.operands[0]]] = stride;
    }
    return module;
}

} // namespace isolux
