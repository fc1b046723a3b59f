// Nearest hits of lists of rays on a device, without light: for tests and measurements of traversal.
#pragma once

#include "render/device_scene.h"

#include "shared/ray_records.h"

#include <memory>
#include <span>
#include <vector>

namespace isolux {

enum class RayMethod { bvh, bruteForce };

/// Keeps references to the device and the scene.
class RayQuery {
public:
    RayQuery(const Device& device, const PackedScene& scene, RayMethod method, ReadPath path = ReadPath::automatic);

    /// A hit a ray, in device space.
    [[nodiscard]] std::vector<shared::HitRecord> trace(std::span<const shared::RayRecord> rays);

private:
    void dispatch(std::uint32_t rayCount, std::uint32_t firstPrimitive, std::uint32_t endPrimitive);
    void traceChunk(std::span<const shared::RayRecord> rays, std::vector<shared::HitRecord>& hits);

    const Device& device_;
    const PackedScene& packed_;
    RayMethod method_;
    CommandRunner runner_;
    DeviceScene scene_;
    std::unique_ptr<Kernel> kernel_;
};

} // namespace isolux
