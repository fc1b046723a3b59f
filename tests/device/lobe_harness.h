// Surfaces as the shaders that ship sample and evaluate them, beside the same surfaces in the double reference.
#pragma once

#include "reference/bsdf.h"
#include "render/device_scene.h"
#include "scene/scene.h"

#include "shared/lobe_records.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace isolux::test {

using LobeQueries = std::vector<shared::LobeQueryRecord>;
using LobeAnswers = std::vector<shared::LobeAnswerRecord>;

/// A material seen from one of its sides; alpha is its own.
struct DeviceLobe {
    std::string name;
    Material material;
    Side side = Side::front;

    [[nodiscard]] double alpha() const { return material.roughness * material.roughness; }
    [[nodiscard]] bool isSolid() const { return material.transmission > 0.0 && material.thickness > 0.0; }
    /// Index beyond over the index on the side that is seen.
    [[nodiscard]] double eta() const { return side == Side::front ? material.ior : 1.0 / material.ior; }
    /// The microfacet that reflects or transmits between wo and wi, on the side of the normal.
    [[nodiscard]] Vec3d microfacetOf(const Vec3d& wo, const Vec3d& wi) const;
};

/// Metal, plastic, both in part, glass thin and solid, and all of them: every combination of lobes, coloured.
[[nodiscard]] std::vector<DeviceLobe> deviceLobes(double alpha);
/// Metal and glass, which have one kind of lobe alone: each from the front, then from the back.
[[nodiscard]] std::vector<DeviceLobe> oneLobeEach(double alpha);
/// Surfaces that absorb nothing.
[[nodiscard]] std::vector<DeviceLobe> whiteLobes(double alpha);
/// White, a part metal and the rest a dielectric.
[[nodiscard]] std::vector<DeviceLobe> partlyMetalLobes(double alpha);

/// The direction as the device gets it; its sine along x.
[[nodiscard]] Vec3f outgoingOfCosine(double cosine);

/// The kernel with the materials of some lobes. Keeps a reference to the device.
class LobeKernel {
public:
    LobeKernel(const Device& device, std::vector<DeviceLobe> lobes, ReadPath path = ReadPath::automatic);

    /// A direction sampled by words x, y and w of a scattering block.
    [[nodiscard]] shared::LobeQueryRecord sampling(std::size_t lobe, const Vec3f& wo, const glm::uvec4& words) const;
    [[nodiscard]] shared::LobeQueryRecord evaluating(std::size_t lobe, const Vec3f& wo, const Vec3f& wi) const;

    [[nodiscard]] LobeAnswers answer(const LobeQueries& queries);

    [[nodiscard]] std::size_t lobeCount() const { return lobes_.size(); }
    [[nodiscard]] const DeviceLobe& lobe(std::size_t index) const { return lobes_[index]; }
    /// The lobe in the reference.
    [[nodiscard]] const MaterialPoint<double>& point(std::size_t index) const { return points_[index]; }

private:
    [[nodiscard]] std::uint32_t sideBits(std::size_t lobe) const;
    void makeKernel();
    void answerSome(std::span<const shared::LobeQueryRecord> queries, LobeAnswers& answers);

    const Device& device_;
    CommandRunner runner_;
    std::vector<DeviceLobe> lobes_;
    std::vector<MaterialPoint<double>> points_;
    shared::LobeParameters parameters_{};
    std::unique_ptr<DeviceScene> scene_;
    std::unique_ptr<Kernel> kernel_;
    std::unique_ptr<Buffer> queries_;
    std::unique_ptr<Buffer> answers_;
};

} // namespace isolux::test
