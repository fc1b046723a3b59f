// An environment map: its radiance from a direction, and directions by its cells (EnvironmentTable).
#pragma once

#include "core/philox.h"
#include "reference/light_sample.h"
#include "scene/environment_table.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace isolux {

/// Keeps a reference to the environment, which has a map.
template <typename Real> class MappedEnvironment {
public:
    explicit MappedEnvironment(const Environment& environment)
        : map_(*environment.map), radiance_(environment.radiance), rotation_(static_cast<Real>(environment.rotation)),
          table_(buildEnvironmentTable(map_)) {
        for (std::uint32_t row = 0; row < map_.height; ++row)
            solidAngles_.push_back(static_cast<Real>(cellSolidAngle(map_, row)));
    }

    [[nodiscard]] Vec3<Real> radiance(const Vec3<Real>& direction) const {
        return radiance_ * interpolated(coordinates(direction));
    }

    /// Density in solid angle of a direction, by the cell that it lies in.
    [[nodiscard]] Real pdf(const Vec3<Real>& direction) const {
        if (table_.cells.pdf.empty()) return 0;
        const Vec2<Real> place = coordinates(direction);
        return cellPdf(wrappedColumn(std::floor(place.x)), clampedRow(std::floor(place.y)));
    }

    /// A direction by the words that choose a cell and a point in it; the choice of the light not included. Only of a
    /// map with light in it.
    [[nodiscard]] LightSample<Real> sample(const Vec3<Real>& origin, const PhiloxBlock& words) const {
        const std::uint32_t cell = sampleAliasTable(table_.cells, words[0], words[1]);
        const std::uint32_t column = cell % map_.width, row = cell / map_.width;
        LightSample<Real> sample;
        sample.wi = directionIn(column, row, {unitReal<Real>(words[2]), unitReal<Real>(words[3])});
        sample.pdf = cellPdf(column, row);
        sample.emission = radiance(sample.wi);
        sample.shadowRay = {origin, sample.wi};
        return sample;
    }

private:
    /// In texels from the upper left corner of the map.
    [[nodiscard]] Vec2<Real> coordinates(const Vec3<Real>& direction) const {
        const Real theta = std::atan2(std::hypot(direction.x, direction.z), direction.y);
        const Real turns = std::atan2(direction.x, -direction.z) / static_cast<Real>(2 * kPi);
        const Real u = Real(0.5) + turns + rotation_;
        return {(u - std::floor(u)) * static_cast<Real>(map_.width),
                theta / static_cast<Real>(kPi) * static_cast<Real>(map_.height)};
    }

    /// Uniform in solid angle: sin^2(theta/2), which is (1 - y)/2 without its cancellation, linear between the edges.
    [[nodiscard]] Vec3<Real> directionIn(std::uint32_t column, std::uint32_t row, const Vec2<Real>& uv) const {
        const Real low = sinSquaredOfHalf(row), high = sinSquaredOfHalf(row + 1);
        const Real s = low + (high - low) * uv.y;
        const Real q = (static_cast<Real>(column) + uv.x) / static_cast<Real>(map_.width);
        const Real phi = static_cast<Real>(2 * kPi) * (q - Real(0.5) - rotation_);
        const Real r = 2 * std::sqrt(s * std::max(1 - s, Real(0)));
        return {r * std::sin(phi), 1 - 2 * s, -r * std::cos(phi)};
    }
    [[nodiscard]] Real sinSquaredOfHalf(std::uint32_t row) const {
        const Real sine =
            std::sin(static_cast<Real>(kPi / 2) * static_cast<Real>(row) / static_cast<Real>(map_.height));
        return sine * sine;
    }

    [[nodiscard]] Real cellPdf(std::uint32_t column, std::uint32_t row) const {
        const double probability = table_.cells.pdf[std::size_t{row} * map_.width + column];
        return static_cast<Real>(probability) / solidAngles_[row];
    }

    [[nodiscard]] std::uint32_t wrappedColumn(Real column) const {
        const Real width = static_cast<Real>(map_.width);
        const Real rest = std::fmod(column, width);
        return static_cast<std::uint32_t>(rest < 0 ? rest + width : rest);
    }
    [[nodiscard]] std::uint32_t clampedRow(Real row) const {
        return static_cast<std::uint32_t>(std::clamp(row, Real(0), static_cast<Real>(map_.height - 1)));
    }
    [[nodiscard]] Vec3<Real> texel(Real column, Real row) const {
        return Vec3<Real>(map_.texels[std::size_t{clampedRow(row)} * map_.width + wrappedColumn(column)]);
    }

    /// Between the four texels about a place.
    [[nodiscard]] Vec3<Real> interpolated(const Vec2<Real>& place) const {
        const Vec2<Real> s = place - Real(0.5);
        const Vec2<Real> low = glm::floor(s);
        const Vec2<Real> part = s - low;
        const Vec3<Real> top = glm::mix(texel(low.x, low.y), texel(low.x + 1, low.y), part.x);
        const Vec3<Real> bottom = glm::mix(texel(low.x, low.y + 1), texel(low.x + 1, low.y + 1), part.x);
        return glm::mix(top, bottom, part.y);
    }

    const EnvironmentMap& map_;
    Vec3<Real> radiance_;
    Real rotation_;
    EnvironmentTable table_;
    std::vector<Real> solidAngles_; ///< of the cells of each row
};

} // namespace isolux
