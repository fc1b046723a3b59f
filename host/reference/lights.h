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

/// All densities include the choice of the light. Keeps references.
template <typename Real> class Lights {
public:
    Lights(const Scene& scene, const World<Real>& world)
        : scene_(scene), areaLights_(scene, world), table_(buildLightTable(scene)) {}

    [[nodiscard]] bool empty() const { return table_.lights.empty(); }

    /// A light and a direction to it, by the four words of a light block; none if it sends nothing to `receiver`.
    [[nodiscard]] std::optional<LightSample<Real>> sample(const Surface<Real>& receiver,
                                                          const PhiloxBlock& words) const {
        const std::uint32_t light = sampleAliasTable(table_.choice, words[0], words[1]);
        const Vec2<Real> uv(unitReal<Real>(words[2]), unitReal<Real>(words[3]));
        std::optional<LightSample<Real>> sample = sampleLight(table_.lights[light], receiver.origin, uv);
        if (sample) sample->pdf *= choicePdf(light);
        return sample;
    }

    /// Whether light sampling can find the primitive.
    [[nodiscard]] bool contains(std::uint32_t primitive) const { return table_.lightOf[primitive] != kNoLight; }
    /// The density with which light sampling from `origin` would have chosen the direction to `hit`, a light's surface.
    [[nodiscard]] Real pdf(const Vec3<Real>& origin, const Surface<Real>& hit) const {
        return choicePdf(table_.lightOf[hit.primitive]) * areaLights_.pdf(origin, hit);
    }

    /// Whether light sampling can find the environment: not in a scene without extent, which it cannot illuminate.
    [[nodiscard]] bool containsEnvironment() const { return table_.environment != kNoLight; }
    /// The density with which light sampling would have chosen any direction from which the environment emits.
    [[nodiscard]] Real pdfOfEnvironment() const {
        return choicePdf(table_.environment) * environmentPdf<Real>(scene_.environment);
    }

private:
    [[nodiscard]] Real choicePdf(std::uint32_t light) const { return static_cast<Real>(table_.choice.pdf[light]); }

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
