#include "scene/scene.h"

#include "core/error.h"

#include <fmt/format.h>

namespace isolux {
namespace {

constexpr double kLargest = 1e30; // coordinates

void validateMaterial(const Material& material) {
    const std::string where = fmt::format("material '{}'", material.name);
    if (!isFinite(material.baseColor) || !isFinite(material.emission)) throwBadInput(where, "a factor is not finite");
    const bool albedoInRange = glm::all(glm::greaterThanEqual(material.baseColor, Vec3d(0.0))) &&
                               glm::all(glm::lessThanEqual(material.baseColor, Vec3d(1.0)));
    if (!albedoInRange) throwBadInput(where, "base colour must lie in [0, 1]");
    if (glm::any(glm::lessThan(material.emission, Vec3d(0.0)))) throwBadInput(where, "emission must not be negative");
}

void validateMesh(const Mesh& mesh, std::size_t materialCount) {
    const std::string where = fmt::format("mesh '{}'", mesh.name);
    if (mesh.material >= materialCount) throwBadInput(where, "its material does not exist");
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        throwBadInput(where, "it has another number of normals than positions");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (!isFinite(mesh.positions[i])) throwBadInput(where, fmt::format("position {} is not finite", i));
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t index : triangle)
            if (index >= mesh.positions.size()) throwBadInput(where, fmt::format("index {} is out of range", index));
}

void validateCamera(const Camera& camera) {
    const std::string where = fmt::format("camera '{}'", camera.name);
    const bool finite = isFinite(camera.position) && std::isfinite(camera.yfov) && std::isfinite(camera.ymag);
    if (!finite) throwBadInput(where, "a number is not finite");
    if (camera.projection == Projection::perspective && !(camera.yfov > 0.0 && camera.yfov < kPi))
        throwBadInput(where, "its field of view must lie between 0 and 180 degrees");
    if (camera.projection == Projection::orthographic && !(camera.ymag > 0.0))
        throwBadInput(where, "its magnification must be positive");
}

void validatePunctualLight(const PunctualLight& light) {
    const std::string where = fmt::format("light '{}'", light.name);
    const bool finite = isFinite(light.position) && isFinite(light.direction) && isFinite(light.intensity);
    if (!finite) throwBadInput(where, "a number is not finite");
    if (maxComponent(glm::abs(light.position)) > kLargest) throwBadInput(where, "its position is beyond 1e30");
    if (glm::any(glm::lessThan(light.intensity, Vec3d(0.0)))) throwBadInput(where, "intensity must not be negative");
    if (!(std::abs(glm::length(light.direction) - 1.0) < 1e-6)) throwBadInput(where, "its direction has no length");
    const bool cones = light.cosOuter >= -1.0 && light.cosOuter < light.cosInner && light.cosInner <= 1.0;
    if (light.kind == PunctualKind::spot && !cones)
        throwBadInput(where, "its inner cone must be narrower than its outer one");
}

void validateEnvironment(const Environment& environment) {
    if (!isFinite(environment.radiance)) throwBadInput("environment", "its radiance is not finite");
    if (glm::any(glm::lessThan(environment.radiance, Vec3d(0.0))))
        throwBadInput("environment", "its radiance must not be negative");
}

/// What both renderers may compute with: squares and areas stay far inside double's range.
void validateBounds(const Scene& scene) {
    constexpr double kSmallest = 1e-30;
    const Box3d bounds = worldBounds(scene);
    if (primitiveCount(scene) == 0) return;
    const Vec3d farthest = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
    // Written so that NaN fails: a transform may overflow though its entries and the positions are finite.
    if (!(maxComponent(farthest) <= kLargest))
        throwBadInput("scene", "a transformed position is beyond 1e30 or not finite");
    const double extent = maxComponent(bounds.extent());
    if (extent != 0.0 && !(extent >= kSmallest)) throwBadInput("scene", "it is smaller than 1e-30; scale it up");
}

} // namespace

std::size_t primitiveCount(const Scene& scene) {
    std::size_t count = scene.spheres.size();
    for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
    return count;
}

Box3d worldBounds(const Scene& scene) {
    Box3d bounds;
    for (const Instance& instance : scene.instances)
        for (const Vec3f& position : scene.meshes[instance.mesh].positions)
            bounds.extend(transformPoint(instance.worldFromObject, position));
    for (const Sphere& sphere : scene.spheres) {
        bounds.extend(sphere.center - Vec3d(sphere.radius));
        bounds.extend(sphere.center + Vec3d(sphere.radius));
    }
    return bounds;
}

double worldRadius(const Scene& scene) { return 0.5 * glm::length(worldBounds(scene).extent()); }

Camera frameScene(const Scene& scene) {
    const Box3d bounds = worldBounds(scene);
    const double radius = bounds.empty() ? 1.0 : std::max(0.5 * glm::length(bounds.extent()), 1e-30);
    Camera camera;
    camera.name = "automatic";
    const Vec3d backward = glm::normalize(Vec3d(0.0, 0.25, 1.0));
    const Vec3d right(1.0, 0.0, 0.0);
    camera.worldFromCamera = Mat3d(right, glm::cross(backward, right), backward);
    const Vec3d center = bounds.empty() ? Vec3d(0.0) : bounds.center();
    camera.position = center + backward * (radius / std::sin(0.5 * camera.yfov));
    return camera;
}

void validate(const Scene& scene) {
    for (const Material& material : scene.materials) validateMaterial(material);
    for (const Mesh& mesh : scene.meshes) validateMesh(mesh, scene.materials.size());
    for (const Instance& instance : scene.instances) {
        if (instance.mesh >= scene.meshes.size())
            throwBadInput(fmt::format("node '{}'", instance.name), "its mesh does not exist");
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                if (!std::isfinite(instance.worldFromObject[column][row]))
                    throwBadInput(fmt::format("node '{}'", instance.name), "its transform is not finite");
    }
    for (const Sphere& sphere : scene.spheres) {
        const std::string where = fmt::format("sphere '{}'", sphere.name);
        if (sphere.material >= scene.materials.size()) throwBadInput(where, "its material does not exist");
        if (!isFinite(sphere.center) || !std::isfinite(sphere.radius) || sphere.radius <= 0.0)
            throwBadInput(where, "its centre must be finite and its radius positive");
    }
    for (const Camera& camera : scene.cameras) validateCamera(camera);
    for (const PunctualLight& light : scene.punctualLights) validatePunctualLight(light);
    validateEnvironment(scene.environment);
    validateBounds(scene);
}

} // namespace isolux
