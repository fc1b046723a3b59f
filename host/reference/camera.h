// Camera rays of the written conventions.
#pragma once

#include "reference/intersect.h"
#include "scene/render_settings.h"
#include "scene/scene.h"

#include <cmath>
#include <cstdint>

namespace isolux {

template <typename Real> class CameraRays {
public:
    CameraRays(const Camera& camera, const RenderSettings& settings)
        : projection_(camera.projection), position_(camera.position), right_(camera.worldFromCamera[0]),
          up_(camera.worldFromCamera[1]), backward_(camera.worldFromCamera[2]),
          width_(static_cast<Real>(settings.width)), height_(static_cast<Real>(settings.height)),
          halfHeight_(
              static_cast<Real>(projection_ == Projection::perspective ? std::tan(camera.yfov / 2) : camera.ymag)) {}

    /// The ray through the point (u, v) of pixel (x, y), y counted from the top.
    [[nodiscard]] Ray<Real> through(std::uint32_t x, std::uint32_t y, Real u, Real v) const {
        const Real aspect = width_ / height_;
        const Real s = (2 * (static_cast<Real>(x) + u) / width_ - 1) * aspect * halfHeight_;
        const Real t = (1 - 2 * (static_cast<Real>(y) + v) / height_) * halfHeight_;
        const Vec3<Real> onPlane = s * right_ + t * up_;
        if (projection_ == Projection::orthographic) return {position_ + onPlane, -backward_};
        return {position_, glm::normalize(onPlane - backward_)};
    }

    /// How far a point lies before the camera along its axis.
    [[nodiscard]] Real depth(const Vec3<Real>& point) const { return glm::dot(point - position_, -backward_); }

private:
    Projection projection_;
    Vec3<Real> position_;
    Vec3<Real> right_;
    Vec3<Real> up_;
    Vec3<Real> backward_;
    Real width_;
    Real height_;
    Real halfHeight_; ///< of the image: at distance 1 in perspective, else in the world
};

} // namespace isolux
