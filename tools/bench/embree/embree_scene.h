// A world's primitives as a scene of Embree 3, and its nearest hits.
#pragma once

#include "reference/ray_caster.h"
#include "reference/world.h"

#include <embree3/rtcore.h>
#include <glm/vec4.hpp>

#include <array>
#include <memory>
#include <type_traits>
#include <vector>

namespace isolux::bench {

/// `robust` lets no ray through the edge between neighbours, as Isolux' own tests do; `fast` is Embree's default.
enum class EmbreeEdges { robust, fast };

/// What Embree reads, which it does where it lies: it must outlive the scenes.
class EmbreeGeometry {
public:
    explicit EmbreeGeometry(const World<float>& world);

    [[nodiscard]] const std::vector<float>& vertices() const { return vertices_; }
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
    [[nodiscard]] const std::vector<glm::vec4>& spheres() const { return spheres_; }

private:
    std::vector<float> vertices_; ///< three a vertex, and one more float, which Embree may read
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<glm::vec4> spheres_; ///< centre and radius
};

using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, decltype(&rtcReleaseDevice)>;
[[nodiscard]] EmbreeDevice openEmbree();

class EmbreeScene {
public:
    /// Builds its BVH, of Embree's medium quality, which is its default. Throws Error where Embree fails.
    EmbreeScene(const EmbreeDevice& device, const EmbreeGeometry& geometry, EmbreeEdges edges);

    /// The primitive's id as Isolux counts, or kNoPrimitive.
    [[nodiscard]] std::uint32_t nearest(const Ray<float>& ray) const;

private:
    std::unique_ptr<std::remove_pointer_t<RTCScene>, decltype(&rtcReleaseScene)> scene_;
    std::uint32_t triangleCount_;
};

} // namespace isolux::bench
