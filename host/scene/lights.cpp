#include "scene/lights.h"

namespace isolux {
namespace {

/// Flux of a diffuse emitter, as luminance: pi * area * radiance, twice that if both faces emit.
double emittedPower(const Material& material, double area, bool closed) {
    const double faces = material.doubleSided && !closed ? 2.0 : 1.0;
    return faces * kPi * area * luminance(material.emission);
}

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
    explicit Collector(const Scene& scene) : scene_(scene) { table_.lightOf.assign(primitiveCount(scene), kNoLight); }

    LightTable collect() {
        for (const Instance& instance : scene_.instances) addInstance(instance);
        for (const Sphere& sphere : scene_.spheres) addSphere(sphere);
        addDistantAndPunctual();
        table_.choice = buildAliasTable(powers_);
        return std::move(table_);
    }

private:
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
        for (const auto& triangle : mesh.triangles)
            addPrimitive(material.emits()
                             ? emittedPower(material, triangleArea(instance.worldFromObject, mesh, triangle), false)
                             : 0.0);
    }

    void addSphere(const Sphere& sphere) {
        const Material& material = scene_.materials[sphere.material];
        // Seen from outside a sphere's inner face cannot be told apart, so both faces count once.
        addPrimitive(material.emits() ? emittedPower(material, 4.0 * kPi * sphere.radius * sphere.radius, true) : 0.0);
    }

    void addDistantAndPunctual() {
        if (scene_.punctualLights.empty() && !scene_.environment.emits()) return;
        const double radius = worldRadius(scene_);
        const double disc = kPi * radius * radius;
        for (std::uint32_t i = 0; i < scene_.punctualLights.size(); ++i)
            add({LightKind::punctual, i}, punctualPower(scene_.punctualLights[i], disc));
        const Environment& environment = scene_.environment;
        const auto light = static_cast<std::uint32_t>(table_.lights.size());
        if (add({LightKind::environment, 0}, environment.solidAngle() * disc * luminance(environment.radiance)))
            table_.environment = light;
    }

    const Scene& scene_;
    LightTable table_;
    std::vector<double> powers_;
    std::uint32_t primitive_ = 0;
};

} // namespace

LightTable buildLightTable(const Scene& scene) { return Collector(scene).collect(); }

} // namespace isolux
