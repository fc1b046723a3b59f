// What to render: the part of the options that decides the image, the same for every backend.
#pragma once

#include <cstdint>
#include <limits>

namespace isolux {

inline constexpr std::uint32_t kUnlimitedDepth = std::numeric_limits<std::uint32_t>::max();

/// Roulette never lets a path live with a higher probability than this, so that every path ends: 1 - 2^-10.
inline constexpr double kMaxSurvival = 1.0 - 1.0 / 1024.0;

/// Whether PixelStatistics::pathSignature is filled (README.md, path signature).
enum class PathSignatures { off, on };

/// Whether Film::aovs is filled: what camera rays meet first.
enum class Aovs { off, on };

struct RenderSettings {
    std::uint32_t width = 512;
    std::uint32_t height = 384;
    std::uint32_t camera = 0; ///< index into Scene::cameras
    std::uint64_t seed = 0;
    std::uint32_t firstSample = 0;            ///< samples firstSample ... firstSample + sampleCount - 1 are rendered
    std::uint32_t sampleCount = 64;           ///< samples a pixel
    std::uint32_t maxDepth = kUnlimitedDepth; ///< bounces: 0 emitted light alone, 1 direct light, ...
    std::uint32_t rouletteStart = 4;          ///< the first bounce that roulette may prevent
};

} // namespace isolux
