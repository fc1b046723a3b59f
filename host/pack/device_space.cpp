#include "pack/device_space.h"

#include <cmath>

namespace isolux {

DeviceSpace chooseSpace(const Scene& scene) {
    DeviceSpace space;
    const Box3d bounds = worldBounds(scene);
    if (bounds.empty()) return space;
    space.center = bounds.center();
    const double halfExtent = 0.5 * maxComponent(bounds.extent());
    if (halfExtent > 0.0) space.scale = std::exp2(-std::ceil(std::log2(halfExtent)));
    return space;
}

std::vector<TriangleCorners> deviceTriangles(const Scene& scene, const Instance& instance, const DeviceSpace& space) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    std::vector<Vec3f> positions(mesh.positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] = Vec3f(space.fromWorld(transformPoint(instance.worldFromObject, mesh.positions[i])));
    const bool mirrored = glm::determinant(Mat3d(instance.worldFromObject)) < 0.0;
    std::vector<TriangleCorners> triangles;
    triangles.reserve(mesh.triangles.size());
    for (auto triangle : mesh.triangles) {
        // A mirrored instance shows its front where the vertices run clockwise; turned round, they do not.
        if (mirrored) std::swap(triangle[1], triangle[2]);
        triangles.push_back({positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]});
    }
    return triangles;
}

std::vector<TriangleCorners> deviceTriangles(const Scene& scene) {
    const DeviceSpace space = chooseSpace(scene);
    std::vector<TriangleCorners> all;
    for (const Instance& instance : scene.instances) {
        const std::vector<TriangleCorners> triangles = deviceTriangles(scene, instance, space);
        all.insert(all.end(), triangles.begin(), triangles.end());
    }
    return all;
}

} // namespace isolux
