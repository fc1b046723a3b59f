#include "device/lobe_harness.h"

#include "kernels/spirv.h"
#include "shared/interface.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace isolux::test {
namespace {

constexpr std::uint32_t kWorkgroupSize = 64;
constexpr std::size_t kQueriesPerDispatch = 1u << 16;

/// A sphere of each lobe's material.
Scene sceneOf(const std::vector<DeviceLobe>& lobes) {
    Scene scene;
    for (const DeviceLobe& lobe : lobes) {
        const auto index = static_cast<std::uint32_t>(scene.materials.size());
        scene.spheres.push_back({lobe.name, Vec3d(3.0 * index, 0.0, 0.0), 1.0, index});
        scene.materials.push_back(lobe.material);
    }
    return scene;
}

std::vector<MaterialPoint<double>> pointsOf(const Scene& scene) {
    const World<double> world = flatten<double>(scene);
    const Attributes<double> attributes(scene, world);
    std::vector<MaterialPoint<double>> points;
    for (std::uint32_t i = 0; i < scene.spheres.size(); ++i)
        points.push_back(materialPointAt(attributes, i, Place<double>{i, Vec3d(0.0)}));
    return points;
}

Material dielectric(double alpha, double ior, const Vec3d& color) {
    Material material;
    material.baseColor = color;
    material.roughness = static_cast<float>(std::sqrt(alpha));
    material.specular = 1.0;
    material.ior = ior;
    return material;
}

Material metal(double alpha, const Vec3d& color) {
    Material material = dielectric(alpha, 1.5, color);
    material.metallic = 1.0;
    return material;
}

Material thinGlass(double alpha, const Vec3d& color) {
    Material material = dielectric(alpha, 1.5, color);
    material.transmission = 1.0;
    return material;
}

Material solidGlass(double alpha, double ior, const Vec3d& color) {
    Material material = dielectric(alpha, ior, color);
    material.transmission = 1.0;
    material.thickness = 1.0;
    return material;
}

Material mixture(double alpha, double thickness) {
    Material material = dielectric(alpha, 1.5, {0.75, 0.5, 0.25});
    material.metallic = 0.375;
    material.transmission = 0.5;
    material.thickness = thickness;
    material.specularColor = Vec3d(1.0, 0.5, 0.25);
    return material;
}

} // namespace

std::vector<DeviceLobe> deviceLobes(double alpha) {
    const Vec3d tint(0.9, 0.8, 0.7);
    Material halfMetal = mixture(alpha, 0.0);
    halfMetal.transmission = 0.0;
    return {{"metal", metal(alpha, {0.9, 0.6, 0.2})},
            {"plastic", dielectric(alpha, 1.5, {0.8, 0.7, 0.1})},
            {"half metal", halfMetal},
            {"thin glass", thinGlass(alpha, tint)},
            {"glass from outside", solidGlass(alpha, 1.5, tint)},
            {"glass from inside", solidGlass(alpha, 1.5, tint), Side::back},
            {"part glass", mixture(alpha, 1.0)},
            {"part glass, thin", mixture(alpha, 0.0)},
            {"part glass from inside", mixture(alpha, 1.0), Side::back}};
}

std::vector<DeviceLobe> oneLobeEach(double alpha) {
    const Vec3d tint(0.9, 0.8, 0.7);
    std::vector<DeviceLobe> lobes;
    for (const Material& material : {metal(alpha, {0.9, 0.6, 0.2}), thinGlass(alpha, tint),
                                     solidGlass(alpha, 1.5, tint), solidGlass(alpha, 2.4, tint)})
        for (const Side side : {Side::front, Side::back})
            lobes.push_back({side == Side::front ? "from the front" : "from the back", material, side});
    return lobes;
}

std::vector<DeviceLobe> whiteLobes(double alpha) {
    const Vec3d white(1.0);
    std::vector<DeviceLobe> lobes{{"metal", metal(alpha, white)},
                                  {"plastic", dielectric(alpha, 1.5, white)},
                                  {"dense plastic", dielectric(alpha, 2.4, white)},
                                  {"thin glass", thinGlass(alpha, white)}};
    for (const double ior : {1.1, 1.5, 2.4})
        for (const Side side : {Side::front, Side::back})
            lobes.push_back({side == Side::front ? "glass from outside" : "glass from inside",
                             solidGlass(alpha, ior, white), side});
    return lobes;
}

std::vector<DeviceLobe> partlyMetalLobes(double alpha) {
    std::vector<DeviceLobe> lobes;
    for (const double share : {0.25, 0.5, 0.75}) {
        lobes.push_back({"metallic " + std::to_string(share), dielectric(alpha, 1.5, Vec3d(1.0))});
        lobes.back().material.metallic = share;
    }
    return lobes;
}

Vec3d DeviceLobe::microfacetOf(const Vec3d& wo, const Vec3d& wi) const {
    const Vec3d mirrored(wi.x, wi.y, -wi.z);
    const Vec3d sum = wi.z >= 0.0 ? wo + wi : isSolid() ? wo + eta() * wi : wo + mirrored;
    return glm::normalize(sum.z < 0.0 ? -sum : sum);
}

Vec3f outgoingOfCosine(double cosine) {
    return {static_cast<float>(std::sqrt((1.0 - cosine) * (1.0 + cosine))), 0.0f, static_cast<float>(cosine)};
}

LobeKernel::LobeKernel(const Device& device, std::vector<DeviceLobe> lobes, ReadPath path)
    : device_(device), runner_(device), lobes_(std::move(lobes)) {
    const Scene scene = sceneOf(lobes_);
    points_ = pointsOf(scene);
    const PackedScene packed = packScene(scene);
    parameters_.tables = {0u, packed.textures.albedos, 0u, 0u}; // materials come first
    scene_ = std::make_unique<DeviceScene>(device_, runner_, packed, path);
    makeKernel();
}

void LobeKernel::makeKernel() {
    KernelSource source;
    source.spirv = kernels::lobes;
    source.pushConstantSize = sizeof(shared::LobeParameters);
    source.specialization = {{shared::kSpecWorkgroupSize, kWorkgroupSize},
                             {shared::kSpecTexelBuffers, scene_->usesTexelBuffers() ? 1u : 0u}};
    kernel_ = std::make_unique<Kernel>(device_, source);
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    queries_ = std::make_unique<Buffer>(device_, kQueriesPerDispatch * sizeof(shared::LobeQueryRecord), kStorage,
                                        BufferAccess::hostWrites);
    answers_ = std::make_unique<Buffer>(device_, kQueriesPerDispatch * sizeof(shared::LobeAnswerRecord), kStorage,
                                        BufferAccess::hostReads);
    scene_->bindTo(*kernel_);
    kernel_->bind(shared::kBindLobeQueries, *queries_);
    kernel_->bind(shared::kBindLobeAnswers, *answers_);
}

std::uint32_t LobeKernel::sideBits(std::size_t lobe) const {
    return lobes_[lobe].side == Side::back ? shared::kLobeQueryBack : 0u;
}

shared::LobeQueryRecord LobeKernel::sampling(std::size_t lobe, const Vec3f& wo, const glm::uvec4& words) const {
    const auto material = std::bit_cast<float>(static_cast<std::uint32_t>(lobe));
    return {{wo, material}, glm::vec4(0.0f), {words.x, words.y, sideBits(lobe) | shared::kLobeQuerySample, words.w}};
}

shared::LobeQueryRecord LobeKernel::evaluating(std::size_t lobe, const Vec3f& wo, const Vec3f& wi) const {
    const auto material = std::bit_cast<float>(static_cast<std::uint32_t>(lobe));
    return {{wo, material}, {wi, 0.0f}, {0u, 0u, sideBits(lobe), 0u}};
}

LobeAnswers LobeKernel::answer(const LobeQueries& queries) {
    LobeAnswers answers;
    answers.reserve(queries.size());
    for (std::size_t first = 0; first < queries.size(); first += kQueriesPerDispatch)
        answerSome(std::span(queries).subspan(first, std::min(kQueriesPerDispatch, queries.size() - first)), answers);
    return answers;
}

void LobeKernel::answerSome(std::span<const shared::LobeQueryRecord> queries, LobeAnswers& answers) {
    std::memcpy(queries_->mapped().data(), queries.data(), queries.size_bytes());
    queries_->flush();
    const auto count = static_cast<std::uint32_t>(queries.size());
    parameters_.tables.z = count;
    runner_.run([&](VkCommandBuffer commands) {
        kernel_->record(commands, std::as_bytes(std::span(&parameters_, 1)),
                        (count + kWorkgroupSize - 1) / kWorkgroupSize);
    });
    answers_->invalidate();
    const std::size_t first = answers.size();
    answers.resize(first + count);
    std::memcpy(&answers[first], answers_->mapped().data(), count * sizeof(shared::LobeAnswerRecord));
}

} // namespace isolux::test
