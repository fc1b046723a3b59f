// Vector types shared by the whole host: GLM vectors and matrices, templated on the scalar, and axis-aligned boxes.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isolux {

template <typename Real> using Vec2 = glm::vec<2, Real>;
template <typename Real> using Vec3 = glm::vec<3, Real>;
template <typename Real> using Mat3 = glm::mat<3, 3, Real>;
template <typename Real> using Mat4 = glm::mat<4, 4, Real>;

using Vec2d = Vec2<double>;
using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;
using Mat3d = Mat3<double>;
using Mat4d = Mat4<double>;

inline constexpr double kPi = 3.14159265358979323846;

/// Luminance of linear Rec. 709 RGB (ITU-R BT.709-6).
template <typename Real> [[nodiscard]] Real luminance(const Vec3<Real>& rgb) {
    return Real(0.2126) * rgb.x + Real(0.7152) * rgb.y + Real(0.0722) * rgb.z;
}

/// The mean of three components.
template <typename Real> [[nodiscard]] Real channelMean(const Vec3<Real>& v) { return (v.x + v.y + v.z) / Real(3); }

/// The largest of three components.
template <typename Real> [[nodiscard]] Real maxComponent(const Vec3<Real>& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

template <typename Real> [[nodiscard]] bool isFinite(const Vec3<Real>& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// An axis-aligned box; the default one is empty (lower > upper).
template <typename Real> struct Box3 {
    Vec3<Real> lower{std::numeric_limits<Real>::infinity()};
    Vec3<Real> upper{-std::numeric_limits<Real>::infinity()};

    void extend(const Vec3<Real>& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void extend(const Box3& box) {
        lower = glm::min(lower, box.lower);
        upper = glm::max(upper, box.upper);
    }
    [[nodiscard]] bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    [[nodiscard]] Vec3<Real> center() const { return lower + (upper - lower) * Real(0.5); }
    [[nodiscard]] Vec3<Real> extent() const { return empty() ? Vec3<Real>(0) : upper - lower; }
    /// Half the surface area: what SAH costs compare.
    [[nodiscard]] Real halfArea() const {
        const Vec3<Real> e = extent();
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

using Box3f = Box3<float>;
using Box3d = Box3<double>;

} // namespace isolux
