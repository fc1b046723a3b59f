// Device space, and where a scene's vertices lie in it: what is packed and what is found about it must agree to the
// bit.
#pragma once

#include "scene/render_settings.h"
#include "scene/scene.h"

#include <array>
#include <vector>

namespace isolux {

/// Device space is the world moved and scaled so that the scene lies in [-1, 1]: float then has the same relative
/// accuracy for every scene. The scale is a power of two, so scaling itself rounds nothing. Its origin, about which
/// floats are finest, is the middle of the scene or, if the camera is within the bounds of a mesh or a sphere or much
/// closer to them than the scene is large, the camera.
struct DeviceSpace {
    Vec3d center{0.0};
    double scale = 1.0; ///< device length = scale * world length

    [[nodiscard]] Vec3d fromWorld(const Vec3d& point) const { return (point - center) * scale; }
};

[[nodiscard]] DeviceSpace chooseSpace(const Scene& scene, const RenderSettings& settings);

using TriangleCorners = std::array<Vec3f, 3>;

/// The triangles of an instance in the order of its mesh, turned so that every front runs counter-clockwise.
[[nodiscard]] std::vector<TriangleCorners> deviceTriangles(const Scene& scene, const Instance& instance,
                                                           const DeviceSpace& space);
/// Those of the whole scene: the index is the primitive id.
[[nodiscard]] std::vector<TriangleCorners> deviceTriangles(const Scene& scene, const RenderSettings& settings);

/// How far before the camera its rays start, in device space: on a plane that lies before every part of the scene. Zero
/// for cameras within or near the scene. From far away a ray's own rounding would be as large as what it looks at.
[[nodiscard]] double startDistance(const Scene& scene, const Camera& camera, const DeviceSpace& space);

} // namespace isolux
