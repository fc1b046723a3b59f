#include "render/device_scene.h"

#include "core/error.h"

#include "shared/interface.h"

#include <fmt/format.h>

#include <algorithm>

namespace isolux {
namespace {

constexpr std::size_t kPartCount = 4;
constexpr std::array<std::uint32_t, kPartCount> kBindings{shared::kBindNodes, shared::kBindPrimitives,
                                                          shared::kBindAttributes, shared::kBindTables};
constexpr std::array kPartNames{"BVH", "primitives", "vertex attributes", "materials, textures and lights"};
constexpr VkDeviceSize kWordBytes = 16;

std::array<std::span<const std::byte>, kPartCount> partsOf(const PackedScene& scene) {
    return {std::as_bytes(std::span(scene.nodes)), std::as_bytes(std::span(scene.primitives)),
            std::as_bytes(std::span(scene.attributes)), std::as_bytes(std::span(scene.tables))};
}

bool fitsTexelBuffers(const DeviceLimits& limits, std::span<const std::byte> data) {
    return data.size() / kWordBytes <= limits.maxTexelBufferElements;
}

bool fitsStorageBuffers(const DeviceLimits& limits, std::span<const std::byte> data) {
    return data.size() <= limits.maxStorageBufferRange;
}

} // namespace

DeviceScene::DeviceScene(const Device& device, CommandRunner& runner, const PackedScene& scene, ReadPath path) {
    const auto parts = partsOf(scene);
    const DeviceLimits& limits = device.limits();
    const auto allFit = [&](auto fits) {
        return std::all_of(parts.begin(), parts.end(), [&](auto part) { return fits(limits, part); });
    };
    texels_ = path == ReadPath::texelBuffers || (path == ReadPath::automatic && allFit(fitsTexelBuffers));
    for (std::size_t i = 0; i < kPartCount; ++i) {
        const bool fits = texels_ ? fitsTexelBuffers(limits, parts[i]) : fitsStorageBuffers(limits, parts[i]);
        if (!fits)
            throwFailure(
                device.description().name,
                fmt::format("the scene's {} take {} MiB, more than one buffer can bind there; use a device with "
                            "larger buffers or --backend reference",
                            kPartNames[i], parts[i].size() >> 20));
        parts_.push_back(makePart(device, runner, parts[i]));
        bytes_ += parts[i].size();
    }
}

DeviceScene::Part DeviceScene::makePart(const Device& device, CommandRunner& runner, std::span<const std::byte> data) {
    constexpr VkBufferUsageFlags kTexelUsage =
        VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    constexpr VkBufferUsageFlags kStorageUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    // The binding that is not read still needs something bound to it.
    const VkDeviceSize texelBytes = texels_ ? data.size() : 0;
    const VkDeviceSize storageBytes = texels_ ? 0 : data.size();
    Part part{Buffer(device, storageBytes, kStorageUsage, BufferAccess::deviceOnly),
              Buffer(device, texelBytes, kTexelUsage, BufferAccess::deviceOnly),
              {}};
    part.view = part.texels.texelView(part.texels.size() / kWordBytes);
    runner.upload(texels_ ? part.texels : part.storage, data);
    return part;
}

void DeviceScene::bindTo(Kernel& kernel) const {
    for (std::size_t i = 0; i < kPartCount; ++i) {
        kernel.bind(kBindings[i], parts_[i].storage);
        kernel.bindTexels(kBindings[i] + shared::kBindTexelOffset, parts_[i].view.get());
    }
}

} // namespace isolux
