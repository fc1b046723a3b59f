// A packed scene in device buffers, bound to kernels as texel or as storage buffers.
#pragma once

#include "gpu/commands.h"
#include "gpu/kernel.h"
#include "pack/packed_scene.h"

#include <array>

namespace isolux {

/// Which kind of buffer kernels read scene data from. `automatic`: texel buffers if the scene fits them (lavapipe
/// gathers from them 1.3 to 2 times as fast), storage buffers otherwise.
enum class ReadPath { automatic, texelBuffers, storageBuffers };

class DeviceScene {
public:
    /// Uploads everything. Throws Error if the scene is larger than the device can bind.
    DeviceScene(const Device& device, CommandRunner& runner, const PackedScene& scene, ReadPath path);

    void bindTo(Kernel& kernel) const;
    [[nodiscard]] bool usesTexelBuffers() const { return texels_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

private:
    struct Part {
        Buffer storage; ///< what the storage binding sees: the data, or a placeholder
        Buffer texels;  ///< what the texel binding sees
        DeviceHandle<VkBufferView> view;
    };

    Part makePart(const Device& device, CommandRunner& runner, std::span<const std::byte> data);

    bool texels_ = true;
    std::size_t bytes_ = 0;
    std::vector<Part> parts_; ///< nodes, primitives, normals, tables
};

} // namespace isolux
