// Which side of a primitive a ray meets, and which backs are not there for rays (scene/README.md, "Back faces").
#pragma once

#include "reference/intersect.h"
#include "scene/render_settings.h"
#include "scene/scene.h"

namespace isolux {

/// Keeps references.
template <typename Real> class BackFaceTest {
public:
    BackFaceTest(const Scene& scene, const World<Real>& world, BackFaces backFaces)
        : scene_(scene), world_(world), culls_(backFaces == BackFaces::culled) {}

    /// Whether back faces leave the surface to a ray that meets it there.
    [[nodiscard]] bool isThere(const Ray<Real>& ray, const Place<Real>& place) const {
        const bool culled = culls_ && scene_.materials[world_.materialOf(place.primitive)].isSingleSided();
        return !culled || meetsFront(ray, place.primitive);
    }

private:
    [[nodiscard]] bool meetsFront(const Ray<Real>& ray, std::uint32_t primitive) const {
        if (world_.isTriangle(primitive)) return glm::dot(-ray.direction, world_.triangles[primitive].ng) >= 0;
        // A ray from outside meets the front first. The sign of the constant term in `intersectSphere`, so that both
        // agree for a ray that starts just off the sphere.
        const WorldSphere<Real>& sphere = world_.sphere(primitive);
        const Vec3<Real> f = ray.origin - sphere.center;
        return glm::dot(f, f) > sphere.radius * sphere.radius;
    }

    const Scene& scene_;
    const World<Real>& world_;
    bool culls_;
};

} // namespace isolux
