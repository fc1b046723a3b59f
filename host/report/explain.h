// Why an image is black or holds NaN: one line a cause, each with a remedy. An image is never wrong in silence.
#pragma once

#include "film/film.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

enum class CameraPlace {
    unknown,
    outside,
    insideSolid ///< a closed opaque object surrounds the camera
};

/// Where the scene's bounds lie as the camera sees them.
enum class SceneSide { unknown, inFront, behind };

struct PixelPosition {
    std::uint32_t x = 0;
    std::uint32_t y = 0;

    friend bool operator==(const PixelPosition&, const PixelPosition&) = default;
};

/// What is known of an image and its scene. The film's part comes from `symptomsOf`, the rest from the caller.
struct ImageSymptoms {
    double meanLuminance = std::numeric_limits<double>::quiet_NaN();
    double hitShare = 0.0; ///< of the samples: how many camera rays met a surface or an environment that emits
    std::uint64_t sampleCount = 0;
    std::uint64_t pixelCount = 0;
    std::uint64_t nonFinitePixels = 0; ///< with a channel that is NaN or infinite
    std::optional<PixelPosition> firstNonFinite;
    Diagnostics diagnostics;

    std::size_t surfaceCount = 0; ///< triangles and spheres
    std::size_t lightCount = 0;   ///< emitters, punctual lights and an environment that emits
    CameraPlace cameraPlace = CameraPlace::unknown;
    SceneSide sceneSide = SceneSide::unknown;
    std::optional<std::uint32_t> maxDepth; ///< nothing: no limit
};

[[nodiscard]] ImageSymptoms symptomsOf(const Film& film);

/// Nothing for an image with light in it and no faults, nor for one without samples.
[[nodiscard]] std::vector<std::string> explainImage(const ImageSymptoms& symptoms);

} // namespace isolux
