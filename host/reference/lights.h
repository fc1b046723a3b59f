// Light sampling: choosing one of the scene's lights and a direction to it, and the density of having done so.
#pragma once

#include "core/philox.h"
#include "reference/area_lights.h"
#include "reference/environment.h"
#include "reference/environment_map.h"
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
        : scene_(scene), areaLights_(scene, world), table_(buildLightTable(scene, settings)) {
        if (scene.environment.map && scene.environment.emits()) map_.emplace(scene.environment);
    }

    /// Light samples to be taken at a shading point.
    [[nodiscard]] std::uint32_t sampleCount() const { return table_.sampleCount; }

    /// Whether samples need the words of a cell.
    [[nodiscard]] bool hasMap() const { return map_.has_value(); }

    /// A light and a direction to it, by the four words of the light block of sample `index` of a shading point, and of
    /// the block for the cell of an environment map; none if it sends nothing to `receiver`.
    [[nodiscard]] std::optional<LightSample<Real>> sample(const Surface<Real>& receiver, const PhiloxBlock& words,
                                                          std::uint32_t index = 0,
                                                          const PhiloxBlock& cellWords = {}) const {
        const bool chosen = table_.mode == LightChoice::one;
        const std::uint32_t light =
            chosen ? sampleAliasTable(table_.choice, words[0], words[1]) : table_.lightOfSample(index);
        const bool mapped = map_ && table_.lights[light].kind == LightKind::environment;
        std::optional<LightSample<Real>> sample =
            mapped ? sampleMap(receiver.origin, cellWords)
                   : sampleLight(table_.lights[light], receiver, {unitReal<Real>(words[2]), unitReal<Real>(words[3])});
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
    /// The density with which light sampling chooses a direction from which the environment emits: the same for all but
    /// those to a map.
    [[nodiscard]] Real pdfOfEnvironment(const Vec3<Real>& direction = {0, 1, 0}) const {
        const Real pdf = map_ ? map_->pdf(direction) : environmentPdf<Real>(scene_.environment);
        return samplesOf(table_.environment) * pdf;
    }
    /// Radiance that arrives along a ray which meets nothing.
    [[nodiscard]] Vec3<Real> radianceOfEnvironment(const Vec3<Real>& direction) const {
        return map_ ? map_->radiance(direction) : environmentRadiance(scene_.environment, direction);
    }

private:
    [[nodiscard]] Real samplesOf(std::uint32_t light) const { return static_cast<Real>(table_.samplesOf[light]); }

    [[nodiscard]] std::optional<LightSample<Real>> sampleLight(const Light& light, const Surface<Real>& receiver,
                                                               const Vec2<Real>& uv) const {
        const Vec3<Real>& origin = receiver.origin;
        switch (light.kind) {
        case LightKind::area: return areaLights_.sample(receiver.originFor(light.index), light.index, uv);
        case LightKind::punctual: return samplePunctualLight(scene_.punctualLights[light.index], origin);
        case LightKind::environment: return sampleEnvironment(scene_.environment, origin, uv);
        }
        return std::nullopt;
    }

    [[nodiscard]] std::optional<LightSample<Real>> sampleMap(const Vec3<Real>& origin, const PhiloxBlock& words) const {
        const LightSample<Real> sample = map_->sample(origin, words);
        return sample.emission == Vec3<Real>(0) ? std::nullopt : std::optional(sample);
    }

    const Scene& scene_;
    AreaLights<Real> areaLights_;
    LightTable table_;
    std::optional<MappedEnvironment<Real>> map_;
};

} // namespace isolux
