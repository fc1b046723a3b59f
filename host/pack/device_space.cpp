#include "pack/device_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isolux {
namespace {

/// Up to here, in half extents of the scene, rays start at the camera itself.
constexpr double kNear = 8.0;
/// Nearer to something than this share of the scene's half extent, the camera sees detail that the scene is large for.
constexpr double kClose = 1.0 / 64.0;
/// In device space, how far before the scene rays of far cameras start: a face that lies in the very plane the scene
/// ends with would be met at a distance of zero, or not at all.
constexpr double kBefore = 1.0 / 16.0;

double distanceTo(const Box3d& box, const Vec3d& point) {
    return glm::length(glm::max(glm::max(box.lower - point, point - box.upper), Vec3d(0.0)));
}

Box3d boundsOf(const Scene& scene, const Instance& instance) {
    Box3d bounds;
    for (const Vec3f& position : scene.meshes[instance.mesh].positions)
        bounds.extend(transformPoint(instance.worldFromObject, position));
    return bounds;
}

/// From a point to the nearest object, by their bounds: within a mesh's it is zero.
double distanceToNearest(const Scene& scene, const Vec3d& point) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Instance& instance : scene.instances)
        nearest = std::min(nearest, distanceTo(boundsOf(scene, instance), point));
    for (const Sphere& sphere : scene.spheres)
        nearest = std::min(nearest, std::max(glm::length(point - sphere.center) - sphere.radius, 0.0));
    return nearest;
}

} // namespace

DeviceSpace chooseSpace(const Scene& scene, const RenderSettings& settings) {
    DeviceSpace space;
    const Box3d bounds = worldBounds(scene);
    if (bounds.empty()) return space;
    space.center = bounds.center();
    if (settings.camera < scene.cameras.size()) {
        const Vec3d& eye = scene.cameras[settings.camera].position;
        if (distanceToNearest(scene, eye) < kClose * 0.5 * maxComponent(bounds.extent())) space.center = eye;
    }
    const double halfExtent = maxComponent(glm::max(bounds.upper - space.center, space.center - bounds.lower));
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

std::vector<TriangleCorners> deviceTriangles(const Scene& scene, const RenderSettings& settings) {
    const DeviceSpace space = chooseSpace(scene, settings);
    std::vector<TriangleCorners> all;
    for (const Instance& instance : scene.instances) {
        const std::vector<TriangleCorners> triangles = deviceTriangles(scene, instance, space);
        all.insert(all.end(), triangles.begin(), triangles.end());
    }
    return all;
}

double startDistance(const Scene& scene, const Camera& camera, const DeviceSpace& space) {
    const Box3d bounds = worldBounds(scene);
    if (bounds.empty() || glm::length(space.fromWorld(camera.position)) <= kNear) return 0.0;
    const Vec3d forward = -camera.worldFromCamera[2];
    // The corner of the bounds that lies least far along the axis.
    const Vec3d corner = glm::mix(bounds.lower, bounds.upper, glm::lessThan(forward, Vec3d(0.0)));
    return std::max(glm::dot(corner - camera.position, forward) * space.scale - kBefore, 0.0);
}

} // namespace isolux
