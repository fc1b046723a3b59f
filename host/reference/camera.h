// Camera rays of the written conventions: pinhole and thin lens, perspective and orthographic; filtered pixels.
#pragma once

#include "core/philox.h"
#include "reference/intersect.h"
#include "scene/pixel_filter.h"
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
              static_cast<Real>(projection_ == Projection::perspective ? std::tan(camera.yfov / 2) : camera.ymag)),
          lens_(settings.lens), filter_(settings.filter.kind), filterTable_(buildFilterTable(settings.filter)) {}

    /// The ray of a sample of pixel (x, y), y counted from the top, by the words of its block 0.
    [[nodiscard]] Ray<Real> sample(std::uint32_t x, std::uint32_t y, const PhiloxBlock& words) const {
        const Vec2<Real> u(unitReal<Real>(words[0]), unitReal<Real>(words[1]));
        const Vec2<Real> point = filter_ == PixelFilter::box ? u : Real(0.5) + Vec2<Real>(offset(u.x), offset(u.y));
        if (lens_.isPinhole()) return through(x, y, point.x, point.y);
        return throughLens(onPlane(x, y, point), sampleDisk(unitReal<Real>(words[2]), unitReal<Real>(words[3])));
    }

    /// The ray through the point (u, v) of pixel (x, y) and the centre of the lens.
    [[nodiscard]] Ray<Real> through(std::uint32_t x, std::uint32_t y, Real u, Real v) const {
        const Vec3<Real> point = onPlane(x, y, {u, v});
        if (projection_ == Projection::orthographic) return {position_ + point, -backward_};
        return {position_, glm::normalize(point - backward_)};
    }

    /// How far a point lies before the camera along its axis.
    [[nodiscard]] Real depth(const Vec3<Real>& point) const { return glm::dot(point - position_, -backward_); }

private:
    /// A point of a pixel relative to the image's centre: at distance 1 in perspective, else in the world.
    [[nodiscard]] Vec3<Real> onPlane(std::uint32_t x, std::uint32_t y, const Vec2<Real>& point) const {
        const Real aspect = width_ / height_;
        const Real s = (2 * (static_cast<Real>(x) + point.x) / width_ - 1) * aspect * halfHeight_;
        const Real t = (1 - 2 * (static_cast<Real>(y) + point.y) / height_) * halfHeight_;
        return s * right_ + t * up_;
    }

    /// A thin lens sends what leaves one point at the distance of focus to one point of the image (Cook, Porter and
    /// Carpenter 1984). `onLens` is in the unit disk.
    [[nodiscard]] Ray<Real> throughLens(const Vec3<Real>& onPlane, const Vec2<Real>& onLens) const {
        const Vec2<Real> ab = onLens * static_cast<Real>(lens_.aperture / 2);
        const Vec3<Real> lens = ab.x * right_ + ab.y * up_;
        const Vec3<Real> shift = lens / static_cast<Real>(lens_.focus);
        if (projection_ == Projection::orthographic)
            return {position_ + onPlane + lens, glm::normalize(-backward_ - shift)};
        return {position_ + lens, glm::normalize(onPlane - backward_ - shift)};
    }

    /// The filter's offset from the pixel's centre, along one axis.
    [[nodiscard]] Real offset(Real u) const {
        const Real place = u * static_cast<Real>(kFilterCells);
        const auto cell = static_cast<std::uint32_t>(place);
        const auto low = static_cast<Real>(filterTable_.quantiles[cell]);
        const auto high = static_cast<Real>(filterTable_.quantiles[cell + 1]);
        return low + (place - static_cast<Real>(cell)) * (high - low);
    }

    Projection projection_;
    Vec3<Real> position_;
    Vec3<Real> right_;
    Vec3<Real> up_;
    Vec3<Real> backward_;
    Real width_;
    Real height_;
    Real halfHeight_; ///< of the image: at distance 1 in perspective, else in the world
    ThinLens lens_;
    PixelFilter filter_;
    FilterTable filterTable_;
};

} // namespace isolux
