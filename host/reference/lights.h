// Light sampling: choosing one of the scene's lights and a direction to it, and the density of having done so.
#pragma once

#include "core/philox.h"
#include "reference/area_lights.h"
#include "reference/environment.h"
#include "reference/punctual_lights.h"
#include "scene/lights.h"

#include <cstdint>
#include <optional>

namespace isolux {

/// Densities are those of a shading point's samples together: times the expected number of samples of the light, which
/// includes the probability of choosing it. Keeps references.
template <typename Real> class Lights {
public:
    Lights(const Scene& scene, const World<Real>& world, const RenderSettings& settings = {})
        : scene_(scene), areaLights_(scene, world), table_(buildLightTable(scene, settings)) {}

    /// Light samples to be taken at a shading point.
    [[nodiscard]] std::uint32_t sampleCount() const { return table_.sampleCount; }

    /// A light and a direction to it, by the four words of the light block of sample `index` of a shading point; none
    /// if it sends nothing to `receiver`.
    [[nodiscard]] std::optional<LightSample<Real>> sample(const Surface<Real>& receiver, const PhiloxBlock& words,
                                                          std::uint32_t index = 0) const {
        const bool chosen = table_.mode == LightChoice::one;
        const std::uint32_t light =
            chosen ? sampleAliasTable(table_.choice, words[0], words[1]) : table_.lightOfSample(index);
        const Vec2<Real> uv(unitReal<Real>(words[2]), unitReal<Real>(words[3]));
        std::optional<LightSample<Real>> sample = sampleLight(table_.lights[light], receiver.origin, uv);
        if (sample) sample->pdf *= samplesOf(light);
        return sample;
    }

    /// Whether light sampling can find the primitive.
    [[nodiscard]] bool contains(std::uint32_t primitive) const { return table_.lightOf[primitive] != kNoLight; }
    /// The density with which light sampling from `origin` chooses the direction to `hit`, a light's surface.
    [[nodiscard]] Real pdf(const Vec3<Real>& origin, const Surface<Real>& hit) const {
        return samplesOf(table_.lightOf[hit.primitive]) * areaLights_.pdf(origin, hit);
    }

    /// Whether light sampling can find the environment: not in a scene without extent, which it cannot illuminate.
    [[nodiscard]] bool containsEnvironment() const { return table_.environment != kNoLight; }
    /// The density with which light sampling chooses any direction from which the environment emits.
    [[nodiscard]] Real pdfOfEnvironment() const {
        return samplesOf(table_.environment) * environmentPdf<Real>(scene_.environment);
    }

private:
    [[nodiscard]] Real samplesOf(std::uint32_t light) const { return static_cast<Real>(table_.samplesOf[light]); }

    [[nodiscard]] std::optional<LightSample<Real>> sampleLight(const Light& light, const Vec3<Real>& origin,
                                                               const Vec2<Real>& uv) const {
        switch (light.kind) {
        case LightKind::area: return areaLights_.sample(origin, light.index, uv);
        case LightKind::punctual: return samplePunctualLight(scene_.punctualLights[light.index], origin);
        case LightKind::environment: return sampleEnvironment(scene_.environment, origin, uv);
        }
        return std::nullopt;
    }

    const Scene& scene_;
    AreaLights<Real> areaLights_;
    LightTable table_;
};

} // namespace isolux
