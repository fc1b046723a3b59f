// Textures as the written conventions read them: wrapped, interpolated after decoding, never filtered further.
#pragma once

#include "core/srgb.h"
#include "scene/scene.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace isolux {

template <typename Real> using Vec4 = glm::vec<4, Real>;

/// How a texel's red, green and blue are stored. Alpha is linear always.
enum class Encoding { linear, srgb };

/// What every code of an integer stands for.
struct DecodingTable {
    std::vector<double> linear;
    std::vector<double> srgb;

    explicit DecodingTable(std::uint32_t largestCode) {
        for (std::uint32_t code = 0; code <= largestCode; ++code) {
            linear.push_back(code / static_cast<double>(largestCode));
            srgb.push_back(linearFromSrgb(linear.back()));
        }
    }
    template <typename Texel> [[nodiscard]] glm::dvec4 decode(const Texel& texel, Encoding encoding) const {
        const std::vector<double>& rgb = encoding == Encoding::srgb ? srgb : linear;
        return {rgb[texel.x], rgb[texel.y], rgb[texel.z], linear[texel.w]};
    }
};

inline const DecodingTable& decoding8() {
    static const DecodingTable table(0xFFu);
    return table;
}
inline const DecodingTable& decoding16() {
    static const DecodingTable table(0xFFFFu);
    return table;
}

/// The texel that a whole number, of any size and sign, stands for along an axis of `size` texels.
template <typename Real> [[nodiscard]] std::uint32_t wrapIndex(Real index, std::uint32_t size, TextureWrap wrap) {
    const Real n = static_cast<Real>(size);
    if (wrap == TextureWrap::clampToEdge) return static_cast<std::uint32_t>(std::clamp(index, Real(0), n - 1));
    const Real period = wrap == TextureWrap::repeat ? n : 2 * n;
    const Real rest = std::fmod(index, period); // exact
    const Real place = rest < 0 ? rest + period : rest;
    return static_cast<std::uint32_t>(place < n ? place : period - 1 - place);
}

template <typename Real> class TextureReader {
public:
    TextureReader(const Texture& texture, const TextureImage& image, Encoding encoding)
        : texture_(texture), image_(image), encoding_(encoding) {}

    [[nodiscard]] Vec4<Real> at(const Vec2<Real>& uv) const {
        const Vec2<Real> s(inTexels(uv.x, image_.width), inTexels(uv.y, image_.height));
        return texture_.filter == TextureFilter::nearest ? texel(glm::floor(s)) : interpolated(s - Real(0.5));
    }

private:
    [[nodiscard]] static Real inTexels(Real coordinate, std::uint32_t size) {
        const Real s = coordinate * static_cast<Real>(size);
        return std::isfinite(s) ? s : Real(0);
    }

    [[nodiscard]] Vec4<Real> texel(const Vec2<Real>& index) const {
        const std::uint32_t column = wrapIndex(index.x, image_.width, texture_.wrapU);
        const std::uint32_t row = wrapIndex(index.y, image_.height, texture_.wrapV);
        const std::size_t place = std::size_t{row} * image_.width + column;
        if (!image_.texels8.empty()) return Vec4<Real>(decoding8().decode(image_.texels8[place], encoding_));
        return Vec4<Real>(decoding16().decode(image_.texels16[place], encoding_));
    }

    /// Between the four texels about `s`, whose whole numbers are centres.
    [[nodiscard]] Vec4<Real> interpolated(const Vec2<Real>& s) const {
        const Vec2<Real> low = glm::floor(s);
        const Vec2<Real> part = s - low;
        const Vec4<Real> top = glm::mix(texel(low), texel(low + Vec2<Real>(1, 0)), part.x);
        const Vec4<Real> bottom = glm::mix(texel(low + Vec2<Real>(0, 1)), texel(low + Vec2<Real>(1, 1)), part.x);
        return glm::mix(top, bottom, part.y);
    }

    const Texture& texture_;
    const TextureImage& image_;
    Encoding encoding_;
};

} // namespace isolux
