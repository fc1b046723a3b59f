#include "scene/lights.h"

#include "core/error.h"
#include "scene/emission.h"

#include <fmt/format.h>

#include <algorithm>

namespace isolux {
namespace {

constexpr std::uint64_t kMaxLightSamples = 0x7FFFFFFFu; // a shading point: their random blocks have 31 bits

/// Flux of a diffuse emitter from one face, as luminance.
double emittedPower(const Vec3d& meanEmission, double area) { return kPi * area * luminance(meanEmission); }

/// Flux of a punctual light; `disc` is the area that one from infinitely far illuminates.
double punctualPower(const PunctualLight& light, double disc) {
    const double level = luminance(light.intensity);
    switch (light.kind) {
    case PunctualKind::point: return 4.0 * kPi * level;
    // The inner cone in full, and between the cones the integral of t^2, a third of that interval of the cosine.
    case PunctualKind::spot:
        return 2.0 * kPi * level * ((1.0 - light.cosInner) + (light.cosInner - light.cosOuter) / 3.0);
    case PunctualKind::directional: return disc * level;
    }
    return 0.0;
}

double triangleArea(const Mat4d& worldFromObject, const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    std::array<Vec3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = transformPoint(worldFromObject, mesh.positions[triangle[i]]);
    return 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
}

/// Collects lights with their powers, in the order of the table.
class Collector {
public:
    Collector(const Scene& scene, const RenderSettings& settings)
        : scene_(scene), settings_(settings), emission_(scene) {
        table_.lightOf.assign(primitiveCount(scene), kNoLight);
    }

    LightTable collect() {
        if (!followsLight(settings_)) return std::move(table_);
        if (samplesWhatScatteringFinds()) {
            for (const Instance& instance : scene_.instances) addInstance(instance);
            for (const Sphere& sphere : scene_.spheres) addSphere(sphere);
        }
        table_.areaCount = static_cast<std::uint32_t>(table_.lights.size());
        addDistantAndPunctual();
        table_.choice = buildAliasTable(powers_);
        countSamples();
        return std::move(table_);
    }

private:
    [[nodiscard]] bool samplesWhatScatteringFinds() const {
        return settings_.lightSampling == LightSampling::light || settings_.lightSampling == LightSampling::mis;
    }

    /// How many samples a shading point takes, and how many of them each light can expect.
    void countSamples() {
        const std::size_t lights = table_.lights.size();
        const std::uint64_t each = settings_.lightSamples;
        table_.mode = settings_.lightChoice;
        table_.samplesPerArea = settings_.lightSamples;
        std::uint64_t total = lights == 0 ? 0 : each;
        if (table_.mode == LightChoice::all) total = table_.punctualCount + each * (lights - table_.punctualCount);
        if (total > kMaxLightSamples)
            throwBadInput("--light-samples",
                          fmt::format("{} light samples a shading point are more than {}", total, kMaxLightSamples));
        table_.sampleCount = static_cast<std::uint32_t>(total);
        const auto expected = [&](std::size_t light) {
            const auto n = static_cast<double>(each);
            if (table_.mode == LightChoice::one) return n * table_.choice.pdf[light];
            return table_.lights[light].kind == LightKind::punctual ? 1.0 : n;
        };
        for (std::size_t light = 0; light < lights; ++light) table_.samplesOf.push_back(expected(light));
    }

    bool add(const Light& light, double power) {
        if (!(power > 0.0)) return false;
        table_.lights.push_back(light);
        powers_.push_back(power);
        return true;
    }

    void addPrimitive(double power) {
        const auto light = static_cast<std::uint32_t>(table_.lights.size());
        if (add({LightKind::area, primitive_}, power)) table_.lightOf[primitive_] = light;
        ++primitive_;
    }

    void addInstance(const Instance& instance) {
        const Mesh& mesh = scene_.meshes[instance.mesh];
        const Material& material = scene_.materials[mesh.material];
        const double faces = material.doubleSided ? 2.0 : 1.0;
        for (const auto& triangle : mesh.triangles)
            addPrimitive(material.emits() ? faces * emittedPower(emission_.ofTriangle(mesh, triangle),
                                                                 triangleArea(instance.worldFromObject, mesh, triangle))
                                          : 0.0);
    }

    void addSphere(const Sphere& sphere) {
        // Seen from outside a sphere's inner face cannot be told apart, so both faces count once.
        addPrimitive(emittedPower(emission_.ofSphere(sphere.material), 4.0 * kPi * sphere.radius * sphere.radius));
    }

    void addDistantAndPunctual() {
        if (scene_.punctualLights.empty() && !scene_.environment.emits()) return;
        const double radius = worldRadius(scene_);
        const double disc = kPi * radius * radius;
        for (std::uint32_t i = 0; i < scene_.punctualLights.size(); ++i)
            if (add({LightKind::punctual, i}, punctualPower(scene_.punctualLights[i], disc))) ++table_.punctualCount;
        if (!samplesWhatScatteringFinds()) return;
        const Environment& environment = scene_.environment;
        const auto light = static_cast<std::uint32_t>(table_.lights.size());
        if (add({LightKind::environment, 0}, disc * environmentFlux(environment))) table_.environment = light;
    }

    const Scene& scene_;
    const RenderSettings& settings_;
    MeanEmission emission_;
    LightTable table_;
    std::vector<double> powers_;
    std::uint32_t primitive_ = 0;
};

} // namespace

std::uint32_t LightTable::lightOfSample(std::uint32_t index) const {
    const std::uint64_t areaSamples = std::uint64_t{areaCount} * samplesPerArea;
    if (index < areaSamples) return index / samplesPerArea;
    return areaCount + std::min(static_cast<std::uint32_t>(index - areaSamples), punctualCount);
}

LightTable buildLightTable(const Scene& scene, const RenderSettings& settings) {
    return Collector(scene, settings).collect();
}

} // namespace isolux
