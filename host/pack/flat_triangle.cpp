#include "pack/flat_triangle.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace isolux {
namespace {

/// How far off a device's heights over a plane may be, in units of 2^-24 of what `flatten` multiplies it with. D is the
/// size of a corner along the normal, s the longest edge; a device's normal is off by at most 8 s/altitude, a corner of
/// another triangle, no larger, that lies over this one at most two edges away from it. The rule's own 9 D; heights,
/// 3 products and 3 sums each of this triangle's corners and of the other's, 2 * 8 D; the normal, over this triangle
/// and to the other, 8 + 2 * 8; 4 for `normal` and 8 for `liesIn`, rounded here: 25 D + 36 s^2/altitude. Twice that, as
/// the other's plane may be the one that is asked, and a little more.
constexpr double kSlackUnits = 80.0;
constexpr double kUnit = 0x1p-24;

Vec3d crossOfEdges(const TriangleCorners& corners) {
    const Vec3d p0(corners[0]);
    return glm::cross(Vec3d(corners[1]) - p0, Vec3d(corners[2]) - p0);
}

double longestEdge(const Vec3d& p0, const Vec3d& p1, const Vec3d& p2) {
    return std::max({glm::length(p1 - p0), glm::length(p2 - p0), glm::length(p2 - p1)});
}

bool liesIn(const FlatTriangle& plane, const TriangleCorners& corners) {
    return std::all_of(corners.begin(), corners.end(), [&](const Vec3f& corner) {
        return std::abs(glm::dot(plane.normal, corner - plane.corners[0])) <= plane.slack;
    });
}

using Corners2 = std::array<Vec2d, 3>;

/// How far c is to the left of the line from a to b, times its length; 0 where rounding decides about the sign. Corners
/// are floats, so that it is exactly 0 or beyond it unless their sizes are very different.
double leftOf(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    const double plus = (b.x - a.x) * (c.y - a.y);
    const double minus = (b.y - a.y) * (c.x - a.x);
    const double error = 0x1p-51 * (std::abs(plus) + std::abs(minus)); // 3 + 16 u of Shewchuk (1997), table 1
    const double left = plus - minus;
    return std::abs(left) <= error ? 0.0 : left;
}

/// Along the axis nearest to the normal, counter-clockwise; nothing if that leaves no area.
std::optional<Corners2> project(const TriangleCorners& corners, int axis) {
    Corners2 flat;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d corner(corners[i]);
        flat[i] = {corner[(axis + 1) % 3], corner[(axis + 2) % 3]};
    }
    const double area = leftOf(flat[0], flat[1], flat[2]);
    if (area == 0.0) return std::nullopt;
    if (area < 0.0) std::swap(flat[1], flat[2]);
    return flat;
}

/// Whether the other lies on the outer side of an edge.
bool hasSeparatingEdge(const Corners2& triangle, const Corners2& other) {
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d& from = triangle[i];
        const Vec2d& to = triangle[(i + 1) % 3];
        if (std::none_of(other.begin(), other.end(), [&](const Vec2d& c) { return leftOf(from, to, c) > 0.0; }))
            return true;
    }
    return false;
}

int longestAxis(const Vec3f& normal) {
    const Vec3f size = glm::abs(normal);
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

} // namespace

bool hasArea(const TriangleCorners& corners) { return crossOfEdges(corners) != Vec3d(0.0); }

FlatTriangle flatten(const TriangleCorners& corners) {
    const Vec3d p0(corners[0]);
    const Vec3d p1(corners[1]);
    const Vec3d p2(corners[2]);
    const Vec3d normal = crossOfEdges(corners);
    const double twiceArea = glm::length(normal);
    const Vec3d largest = glm::max(glm::abs(p0), glm::max(glm::abs(p1), glm::abs(p2)));
    const double size = longestEdge(p0, p1, p2);
    const double off = glm::dot(glm::abs(normal), largest) / twiceArea + size * size * size / twiceArea;
    FlatTriangle triangle{corners, Vec3f(normal / twiceArea)};
    triangle.size = static_cast<float>(size);
    // A needle's normal may point anywhere; what lies over it is no farther away than it is long.
    triangle.slack = static_cast<float>(std::min(kSlackUnits * kUnit * off, size));
    return triangle;
}

Box3f FlatTriangle::box() const {
    Box3f box;
    for (const Vec3f& corner : corners) box.extend(corner);
    // Over the triangle along the axis nearest to its normal: at most sqrt(3) times as far as off the plane.
    const Vec3f margin(2.0f * slack);
    return {box.lower - margin, box.upper + margin};
}

bool coincide(const FlatTriangle& a, const FlatTriangle& b) {
    const FlatTriangle& larger = a.size >= b.size ? a : b;
    const FlatTriangle& smaller = a.size >= b.size ? b : a;
    if (!liesIn(larger, smaller.corners)) return false;
    const int axis = longestAxis(larger.normal);
    const std::optional<Corners2> first = project(larger.corners, axis);
    const std::optional<Corners2> second = project(smaller.corners, axis);
    return first && second && !hasSeparatingEdge(*first, *second) && !hasSeparatingEdge(*second, *first);
}

} // namespace isolux
