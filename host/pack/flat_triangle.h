// Whether two triangles lie at the same spot: in one plane, as shaders/geometry/plane.glsl has it, and over each other.
#pragma once

#include "pack/device_space.h"

namespace isolux {

/// A triangle and its plane.
struct FlatTriangle {
    TriangleCorners corners;
    Vec3f normal;       ///< of length 1
    float slack = 0.0f; ///< how far off the plane corners may be that a device may take to lie in it
    float size = 0.0f;  ///< the longest edge

    /// Contains what lies in the plane and over the triangle.
    [[nodiscard]] Box3f box() const;
};

/// Without area no ray meets a triangle.
[[nodiscard]] bool hasArea(const TriangleCorners& corners);

/// Of a triangle with area.
[[nodiscard]] FlatTriangle flatten(const TriangleCorners& corners);

/// Whether one may lie in the plane of the other and their interiors overlap there. An edge or a corner in common, to
/// the bit, is no overlap.
[[nodiscard]] bool coincide(const FlatTriangle& a, const FlatTriangle& b);

} // namespace isolux
