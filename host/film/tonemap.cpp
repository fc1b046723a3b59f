#include "film/tonemap.h"

#include "core/error.h"
#include "core/srgb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace isolux {
namespace {

struct NamedTonemap {
    std::string_view name;
    Tonemap tonemap;
};

constexpr std::array kTonemaps{NamedTonemap{"none", Tonemap::none}, NamedTonemap{"reinhard", Tonemap::reinhard},
                               NamedTonemap{"aces", Tonemap::aces}, NamedTonemap{"agx", Tonemap::agx},
                               NamedTonemap{"pbr-neutral", Tonemap::pbrNeutral}};

/// Not std::clamp: every comparison with NaN is false, so that NaN stays.
double clamped(double value, double largest) { return value > largest ? largest : value < 0.0 ? 0.0 : value; }
Vec3d clamped(const Vec3d& value, double largest) {
    return {clamped(value.x, largest), clamped(value.y, largest), clamped(value.z, largest)};
}

bool hasNan(const Vec3d& value) { return std::isnan(value.x) || std::isnan(value.y) || std::isnan(value.z); }

/// Reinhard, Stark, Shirley and Ferwerda 2002, eq. 3, on luminance, which keeps hue and saturation.
Vec3d reinhard(const Vec3d& color) { return color / (1.0 + luminance(color)); }

/// Stephen Hill's fit of the ACES reference rendering and sRGB output transforms (2015, in Pettineo's BakingLab).
/// Columns: the matrices go from Rec. 709 to the primaries and saturation of the rendering transform, and back.
Vec3d aces(const Vec3d& color) {
    const Mat3d input(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const Mat3d output(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    const Vec3d v = input * color;
    const Vec3d numerator = v * (v + 0.0245786) - 0.000090537;
    const Vec3d denominator = v * (0.983729 * v + 0.4329510) + 0.238081;
    return output * (numerator / denominator);
}

/// Wrensch 2023, "Minimal AgX Implementation": polynomial of order six in place of AgX's default contrast curve; mean
/// squared error 3.67e-6.
double agxContrast(double x) {
    return (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
}

/// AgX (Sobotka 2022) with the constants of Wrensch 2023: inset, curve over stops, outset. Its result is what a display
/// is sent, so the encoding that files apply later is undone here, not AgX's nominal power of 2.2: codes stay AgX's
/// own.
Vec3d agx(const Vec3d& color) {
    constexpr double kDarkest = -12.47393; // stops
    constexpr double kBrightest = 4.026069;
    const Mat3d inset(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992, 0.878468636469772,
                      0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const Mat3d outset(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368,
                       1.15190312990417, -0.0980434501171241, -0.0990297440797205, -0.0989611768448433,
                       1.15107367264116);
    Vec3d curved = inset * color;
    for (int c = 0; c < 3; ++c) {
        const double stops = std::clamp(std::log2(curved[c]), kDarkest, kBrightest);
        curved[c] = agxContrast((stops - kDarkest) / (kBrightest - kDarkest));
    }
    const Vec3d encoded = clamped(outset * curved, 1.0);
    return {linearFromSrgb(encoded.x), linearFromSrgb(encoded.y), linearFromSrgb(encoded.z)};
}

/// Khronos PBR Neutral (Khronos Group 2024, "PBR Neutral Specification"), in its own letters.
Vec3d pbrNeutral(const Vec3d& color) {
    constexpr double kF90 = 0.04;
    constexpr double kKs = 0.8 - kF90;
    constexpr double kKd = 0.15;
    const double x = std::min({color.x, color.y, color.z});
    const double f = x <= 2.0 * kF90 ? x - x * x / (4.0 * kF90) : kF90;
    const Vec3d offset = color - f;
    const double p = maxComponent(offset);
    if (p <= kKs) return offset;
    const double pn = 1.0 - (1.0 - kKs) * (1.0 - kKs) / (p + 1.0 - 2.0 * kKs);
    const double g = 1.0 / (kKd * (p - pn) + 1.0);
    return offset * (pn / p * g) + pn * (1.0 - g);
}

Vec3d mapTone(Tonemap tonemap, const Vec3d& color) {
    switch (tonemap) {
    case Tonemap::none: return color;
    case Tonemap::reinhard: return reinhard(color);
    case Tonemap::aces: return aces(color);
    case Tonemap::agx: return agx(color);
    case Tonemap::pbrNeutral: return pbrNeutral(color);
    }
    return color;
}

} // namespace

Tonemap parseTonemap(std::string_view name) {
    std::string known;
    for (const NamedTonemap& tonemap : kTonemaps) {
        if (tonemap.name == name) return tonemap.tonemap;
        known += fmt::format("{}{}", known.empty() ? "" : ", ", tonemap.name);
    }
    throwBadInput(fmt::format("tone map \"{}\"", name), "unknown: use one of " + known);
}

Vec3d applyDisplay(const DisplayTransform& transform, const Vec3d& linearRec709) {
    constexpr double kHuge = std::numeric_limits<float>::max(); // finite in every formula, where infinity would be NaN
    const Vec3d exposed = clamped(linearRec709 * std::exp2(transform.exposure), kHuge);
    if (transform.tonemap != Tonemap::none && hasNan(exposed)) return Vec3d(std::numeric_limits<double>::quiet_NaN());
    return clamped(mapTone(transform.tonemap, exposed), 1.0);
}

} // namespace isolux
