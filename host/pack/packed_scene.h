// A scene in the form that kernels read: the records of shaders/shared, in device space.
#pragma once

#include "accel/bvh.h"
#include "pack/device_space.h"
#include "pack/packed_environment.h"
#include "pack/packed_materials.h"
#include "pack/scene_features.h"
#include "scene/render_settings.h"
#include "scene/scene.h"

#include "shared/path_records.h"
#include "shared/scene_records.h"

#include <cstdint>
#include <vector>

namespace isolux {

struct PackedScene {
    std::vector<shared::NodeRecord> nodes;
    std::vector<shared::PrimitiveRecord> primitives; ///< in the order of the BVH's leaves
    std::vector<glm::vec4> attributes;               ///< sections of records beside `primitives`
    glm::uvec4 attributeOffsets{0u};                 ///< first word of each section (RenderParameters)
    std::vector<glm::uvec4>
        tables; ///< materials, lights, light bins, filter, textures, environment, one after the other
    TextureOffsets textures;
    PackedEnvironment environment;
    std::uint32_t materialCount = 0;
    std::uint32_t lightCount = 0;
    std::uint32_t lightBits = 0;
    std::uint32_t lightOffset = 0;  ///< first word of the lights in `tables`
    std::uint32_t binOffset = 0;    ///< first word of the light bins
    std::uint32_t filterOffset = 0; ///< first word of the pixel filter's quantiles
    /// How many light samples a shading point takes, and how they are dealt out (LightTable).
    std::uint32_t lightSamples = 0;
    std::uint32_t samplesPerArea = 1;
    std::uint32_t areaLights = 0;
    std::uint32_t punctualLights = 0;
    /// Density of light samples per solid angle, of a map times that of its cells; 0 if they never go to the
    /// environment.
    double environmentPdf = 0.0;
    std::vector<std::uint32_t> firstOfObject; ///< first primitive id of each instance and each sphere, in scene order
    std::uint32_t stackBound = 1;             ///< entries of a traversal stack: as many as it must hold, or some more
    /// Device radiance = this * world radiance: a power of two that brings the lights near 1, so that squares of
    /// radiance, the variance, stay within single precision whatever the unit.
    double radianceScale = 1.0;
    BvhStatistics bvh; ///< of the binary tree that `nodes` was made from
    DeviceSpace space;
};

/// Transforms in double, builds the BVH over the rounded vertices, unless the settings want none, and packs everything.
/// Holds what `features`, at least those that the scene needs, can reach. Throws Error if the scene has more primitives
/// than a child slot can name (2^28 - 1).
[[nodiscard]] PackedScene packScene(const Scene& scene, const RenderSettings& settings, const SceneFeatures& features);
[[nodiscard]] inline PackedScene packScene(const Scene& scene, const RenderSettings& settings = {}) {
    return packScene(scene, settings, findFeatures(scene, settings));
}

/// The parameters that stay the same over a render.
[[nodiscard]] shared::RenderParameters packParameters(const PackedScene& packed, const Scene& scene,
                                                      const RenderSettings& settings);

} // namespace isolux
