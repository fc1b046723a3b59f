#include "scene/scene.h"

namespace isolux {

std::size_t primitiveCount(const Scene& scene) {
    std::size_t count = scene.spheres.size();
    for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
    return count;
}

Scene moved(Scene scene, const Vec3d& by) {
    for (Instance& instance : scene.instances) instance.worldFromObject[3] += glm::dvec4(by, 0.0);
    for (Sphere& sphere : scene.spheres) sphere.center += by;
    for (Camera& camera : scene.cameras) camera.position += by;
    for (PunctualLight& light : scene.punctualLights) light.position += by;
    return scene;
}

std::vector<bool> materialsInUse(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const Instance& instance : scene.instances) used[scene.meshes[instance.mesh].material] = true;
    for (const Sphere& sphere : scene.spheres) used[sphere.material] = true;
    return used;
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

} // namespace isolux
