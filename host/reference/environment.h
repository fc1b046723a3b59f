// The environment: what arrives from infinitely far away, and how directions to it are sampled.
#pragma once

#include "reference/light_sample.h"
#include "scene/scene.h"

namespace isolux {

/// Radiance that arrives along a ray which meets nothing.
template <typename Real>
[[nodiscard]] Vec3<Real> environmentRadiance(const Environment& environment, const Vec3<Real>& rayDirection) {
    const bool covered = environment.extent == EnvironmentExtent::sphere || rayDirection.y > 0;
    return covered ? Vec3<Real>(environment.radiance) : Vec3<Real>(0);
}

/// Density in solid angle of every direction from which the environment emits.
template <typename Real> [[nodiscard]] Real environmentPdf(const Environment& environment) {
    return 1 / static_cast<Real>(environment.solidAngle());
}

/// A direction from which it emits; every one has the same density, the choice of the light not included.
template <typename Real>
[[nodiscard]] LightSample<Real> sampleEnvironment(const Environment& environment, const Vec3<Real>& origin,
                                                  const Vec2<Real>& uv) {
    LightSample<Real> sample;
    sample.wi =
        environment.extent == EnvironmentExtent::sphere ? sampleSphereAboutY(uv.x, uv.y) : sampleUpperHalf(uv.x, uv.y);
    sample.pdf = environmentPdf<Real>(environment);
    sample.emission = Vec3<Real>(environment.radiance);
    sample.shadowRay = {origin, sample.wi};
    return sample;
}

} // namespace isolux
