// Means of films of the CPU reference with their intervals, against what is known in closed form.
#pragma once

#include "reference/reference.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace isolux::test {

inline constexpr double kSigmas = 4.5; // one false alarm in 1e5 comparisons

/// All samples of all pixels as one.
inline PixelStatistics renderTotal(const Scene& scene, RenderSettings settings,
                                   Precision precision = Precision::doublePrecision) {
    settings.seed = 20240229;
    const Film film = renderReference(scene, settings, {precision}, {});
    EXPECT_TRUE(film.diagnostics.clean());
    PixelStatistics total;
    for (const PixelStatistics& pixel : film.pixels) total.merge(pixel);
    return total;
}

inline double standardError(const PixelStatistics& total, int channel) {
    return std::sqrt(total.variance()[channel] / static_cast<double>(total.sampleCount));
}

/// The mean is `expected` within the interval, which together with the error is within `limit` of it (relative).
inline void expectRadiance(const PixelStatistics& total, const Vec3d& expected, double limit) {
    for (int channel = 0; channel < 3; ++channel) {
        const double error = total.mean[channel] - expected[channel];
        const double interval = kSigmas * standardError(total, channel) + 1e-6 * expected[channel];
        EXPECT_LE(std::abs(error), interval) << "channel " << channel;
        EXPECT_LE(std::abs(error), limit * expected[channel]) << "channel " << channel;
        EXPECT_LE(interval, 2.0 * limit * expected[channel]) << "too few samples to tell";
        std::printf("channel %d: %.6f of %.6f, error %+.4f %%, standard error %.4f %%\n", channel, total.mean[channel],
                    expected[channel], 100.0 * error / expected[channel],
                    100.0 * standardError(total, channel) / expected[channel]);
    }
}

inline RenderSettings squareImage(std::uint32_t size, std::uint32_t samples) {
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.sampleCount = samples;
    return settings;
}

/// The cube [-1, 1]^3, fronts inwards.
inline Mesh boxMesh(std::uint32_t material) {
    Mesh mesh;
    mesh.material = material;
    for (std::uint32_t i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
    mesh.triangles = {{0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}, {0, 4, 5}, {0, 5, 1},
                      {2, 3, 7}, {2, 7, 6}, {0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}};
    return mesh;
}

inline const Vec3d kAlbedo(0.2, 0.5, 0.8);
inline const Vec3d kEmission(3.0, 0.5, 1.0);
inline const Vec3d kFurnace = kEmission / (1.0 - kAlbedo);

/// A closed box of which every wall reflects and emits: the same radiance everywhere and in every direction.
inline Scene furnaceBox(const Mat4d& worldFromObject) {
    SceneBuilder builder;
    builder.mesh(boxMesh(builder.material(kAlbedo, kEmission, Faces::front)), worldFromObject);
    const Vec3d center(worldFromObject[3]);
    const Vec3d corner(worldFromObject * glm::dvec4(1.0, 0.7, 0.9, 1.0));
    builder.camera(center + (corner - center) * -0.5, corner, 1.2);
    // Rolled: light samples alone have no finite variance at the box's edges, where some views have outliers in 16
    // samples.
    const Frame<double> frame = frameAbout(builder.scene.cameras[0].worldFromCamera[2]);
    builder.scene.cameras[0].worldFromCamera = Mat3d(frame.t, frame.s, frame.n);
    return builder.scene;
}

/// A white floor and a camera that looks at the world's origin on it from the side.
inline SceneBuilder floorSeenFromTheSide(const Vec3d& albedo) {
    SceneBuilder builder;
    builder.scene.materials[0].baseColor = albedo;
    builder.mesh(squareMesh(0), scaling({100.0, 100.0, 1.0}));
    builder.camera({3.0, 0.0, 0.2}, Vec3d(0.0), 1e-6);
    return builder;
}

inline RenderSettings onePoint(std::uint32_t samples) {
    RenderSettings settings = squareImage(4, samples);
    settings.maxDepth = 1;
    return settings;
}

} // namespace isolux::test
