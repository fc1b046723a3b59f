#include "render/ray_query.h"

#include "kernels/spirv.h"
#include "shared/interface.h"

#include <algorithm>
#include <cstring>

namespace isolux {
namespace {

constexpr std::uint32_t kWorkgroupSize = 64;
constexpr std::uint32_t kRaysPerDispatch = 1u << 16;
constexpr double kTestsPerDispatch = 1e7; // primitive tests, so that a dispatch stays short
// Some drivers end loops after 65,535 iterations over the lanes of a subgroup: chunks stay far below.
constexpr double kPrimitivesPerDispatch = 4000.0;

} // namespace

RayQuery::RayQuery(const Device& device, const PackedScene& scene, RayMethod method, ReadPath path)
    : device_(device), packed_(scene), method_(method), runner_(device), scene_(device, runner_, scene, path) {
    KernelSource source;
    source.spirv = kernels::intersect;
    source.pushConstantSize = sizeof(shared::IntersectParameters);
    source.specialization = {{shared::kSpecWorkgroupSize, kWorkgroupSize},
                             {shared::kSpecTexelBuffers, scene_.usesTexelBuffers() ? 1u : 0u},
                             {shared::kSpecStackSize, scene.stackBound},
                             {shared::kSpecBruteForce, method == RayMethod::bruteForce ? 1u : 0u}};
    kernel_ = std::make_unique<Kernel>(device, source);
    scene_.bindTo(*kernel_);
}

std::vector<shared::HitRecord> RayQuery::trace(std::span<const shared::RayRecord> rays) {
    std::vector<shared::HitRecord> hits;
    hits.reserve(rays.size());
    for (std::size_t first = 0; first < rays.size(); first += kRaysPerDispatch)
        traceChunk(rays.subspan(first, std::min<std::size_t>(kRaysPerDispatch, rays.size() - first)), hits);
    return hits;
}

void RayQuery::dispatch(std::uint32_t rayCount, std::uint32_t firstPrimitive, std::uint32_t endPrimitive) {
    const shared::IntersectParameters parameters{{0, rayCount, firstPrimitive, endPrimitive}};
    runner_.run([&](VkCommandBuffer commands) {
        kernel_->record(commands, std::as_bytes(std::span(&parameters, 1)),
                        (rayCount + kWorkgroupSize - 1) / kWorkgroupSize);
    });
}

void RayQuery::traceChunk(std::span<const shared::RayRecord> rays, std::vector<shared::HitRecord>& hits) {
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const Buffer rayBuffer(device_, rays.size_bytes(), kStorage, BufferAccess::hostWrites);
    const Buffer hitBuffer(device_, rays.size() * sizeof(shared::HitRecord), kStorage, BufferAccess::hostReads);
    std::memcpy(rayBuffer.mapped().data(), rays.data(), rays.size_bytes());
    rayBuffer.flush();
    kernel_->bind(shared::kBindRays, rayBuffer);
    kernel_->bind(shared::kBindHits, hitBuffer);
    const auto primitives = static_cast<std::uint32_t>(packed_.primitives.size());
    const auto rayCount = static_cast<std::uint32_t>(rays.size());
    if (method_ == RayMethod::bvh) {
        dispatch(rayCount, 0, primitives);
    } else {
        const auto step =
            static_cast<std::uint32_t>(std::clamp(kTestsPerDispatch / rayCount, 1.0, kPrimitivesPerDispatch));
        std::uint32_t begin = 0;
        do { // also without primitives: the misses have to be written
            dispatch(rayCount, begin, std::min(begin + step, primitives));
            begin += step;
        } while (begin < primitives);
    }
    hitBuffer.invalidate();
    const auto* found = reinterpret_cast<const shared::HitRecord*>(hitBuffer.mapped().data());
    hits.insert(hits.end(), found, found + rays.size());
}

} // namespace isolux
