#include "scene/lights.h"

namespace isolux {
namespace {

/// Flux of a diffuse emitter, as luminance: pi * area * radiance, twice that if both faces emit.
double emittedPower(const Material& material, double area, bool closed) {
    const double faces = material.doubleSided && !closed ? 2.0 : 1.0;
    return faces * kPi * area * luminance(material.emission);
}

double triangleArea(const Mat4d& worldFromObject, const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    std::array<Vec3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = transformPoint(worldFromObject, mesh.positions[triangle[i]]);
    return 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
}

} // namespace

LightTable buildLightTable(const Scene& scene) {
    LightTable table;
    table.lightOf.assign(primitiveCount(scene), kNoLight);
    std::vector<double> powers;
    std::uint32_t primitive = 0;
    const auto consider = [&](double power) {
        if (power > 0.0) {
            table.lightOf[primitive] = static_cast<std::uint32_t>(table.primitives.size());
            table.primitives.push_back(primitive);
            powers.push_back(power);
        }
        ++primitive;
    };
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const Material& material = scene.materials[mesh.material];
        for (const auto& triangle : mesh.triangles)
            consider(material.emits()
                         ? emittedPower(material, triangleArea(instance.worldFromObject, mesh, triangle), false)
                         : 0.0);
    }
    for (const Sphere& sphere : scene.spheres) {
        const Material& material = scene.materials[sphere.material];
        // Seen from outside a sphere's inner face cannot be told apart, so both faces count once.
        consider(material.emits() ? emittedPower(material, 4.0 * kPi * sphere.radius * sphere.radius, true) : 0.0);
    }
    table.choice = buildAliasTable(powers);
    return table;
}

} // namespace isolux
