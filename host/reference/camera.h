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
        : position_(camera.position), worldFromCamera_(camera.worldFromCamera),
          width_(static_cast<Real>(settings.width)), height_(static_cast<Real>(settings.height)),
          tanHalfFov_(static_cast<Real>(std::tan(camera.yfov / 2))) {}

    /// The ray through the point (u, v) of pixel (x, y), y counted from the top.
    [[nodiscard]] Ray<Real> through(std::uint32_t x, std::uint32_t y, Real u, Real v) const {
        const Real aspect = width_ / height_;
        const Real s = (2 * (static_cast<Real>(x) + u) / width_ - 1) * aspect * tanHalfFov_;
        const Real t = (1 - 2 * (static_cast<Real>(y) + v) / height_) * tanHalfFov_;
        return {position_, glm::normalize(s * worldFromCamera_[0] + t * worldFromCamera_[1] - worldFromCamera_[2])};
    }

private:
    Vec3<Real> position_;
    Mat3<Real> worldFromCamera_;
    Real width_;
    Real height_;
    Real tanHalfFov_;
};

} // namespace isolux
