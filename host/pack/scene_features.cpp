#include "pack/scene_features.h"

#include "pack/coincident.h"
#include "pack/effective_materials.h"
#include "scene/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace isolux {
namespace {

constexpr auto kNamed = std::to_array<NamedFeature>({
    {"spheres", &SceneFeatures::spheres},
    {"smooth-normals", &SceneFeatures::smoothNormals},
    {"area-lights", &SceneFeatures::areaLights},
    {"punctual-lights", &SceneFeatures::punctualLights},
    {"environment", &SceneFeatures::environment},
    {"environment-map", &SceneFeatures::environmentMap},
    {"specular", &SceneFeatures::specular},
    {"rough-specular", &SceneFeatures::roughSpecular},
    {"glass", &SceneFeatures::glass},
    {"rough-glass", &SceneFeatures::roughGlass},
    {"solids", &SceneFeatures::solids},
    {"absorption", &SceneFeatures::absorption},
    {"base-color-maps", &SceneFeatures::baseColorMaps},
    {"metallic-roughness-maps", &SceneFeatures::metallicRoughnessMaps},
    {"normal-maps", &SceneFeatures::normalMaps},
    {"emission-maps", &SceneFeatures::emissionMaps},
    {"transmission-maps", &SceneFeatures::transmissionMaps},
    {"specular-maps", &SceneFeatures::specularMaps},
    {"vertex-colors", &SceneFeatures::vertexColors},
    {"alpha-mask", &SceneFeatures::alphaMask},
    {"alpha-blend", &SceneFeatures::alphaBlend},
    {"unlit", &SceneFeatures::unlit},
    {"back-face-culling", &SceneFeatures::backFaceCulling},
    {"coincident", &SceneFeatures::coincident},
});

bool usesMap(const Material& material, MapSlot slot) { return material.map(slot).present(); }

/// Whether the opaque part of a surface, if it has one, reflects other than diffusely.
bool isSpecular(const Material& material) {
    const bool allGlass = material.transmission == 1.0 && material.metallic == 0.0 &&
                          !usesMap(material, MapSlot::transmission) && !usesMap(material, MapSlot::metallicRoughness);
    return !material.unlit && !allGlass && (material.metallic > 0.0 || material.specular > 0.0);
}

bool isGlass(const Material& material) {
    const bool allMetal = material.metallic == 1.0 && !usesMap(material, MapSlot::metallicRoughness);
    return !material.unlit && !allMetal && material.transmission > 0.0;
}

/// Below it the lobes of a surface without a map are delta lobes for certain.
bool isRough(const Material& material) {
    const bool mapped = usesMap(material, MapSlot::metallicRoughness) && material.roughness > 0.0;
    // Rounding may take what is hardly below the bound for above it.
    return mapped || material.roughness * material.roughness > 0.999 * kSmallestAlpha;
}

bool isSolid(const Material& material) { return isGlass(material) && material.thickness > 0.0; }

bool absorbs(const Material& material) {
    return isSolid(material) && std::isfinite(material.attenuationDistance) && material.attenuationColor != Vec3d(1.0);
}

/// A feature that some surfaces have, and how a reason says so.
struct SurfaceFeature {
    bool SceneFeatures::*flag;
    bool (*has)(const Material&);
    std::string_view having; ///< "2 of 5 materials ..."
};

constexpr auto kOfSurfaces = std::to_array<SurfaceFeature>({
    {&SceneFeatures::specular, isSpecular, "reflect other than diffusely"},
    {&SceneFeatures::roughSpecular, [](const Material& m) { return isSpecular(m) && isRough(m); },
     "reflect so, and not as a mirror"},
    {&SceneFeatures::glass, isGlass, "transmit"},
    {&SceneFeatures::roughGlass, [](const Material& m) { return isGlass(m) && isRough(m); },
     "transmit, and not smoothly"},
    {&SceneFeatures::solids, isSolid, "bound a solid that refracts"},
    {&SceneFeatures::absorption, absorbs, "bound a solid that absorbs"},
    {&SceneFeatures::baseColorMaps, [](const Material& m) { return usesMap(m, MapSlot::baseColor); },
     "have a base colour map that varies"},
    {&SceneFeatures::metallicRoughnessMaps, [](const Material& m) { return usesMap(m, MapSlot::metallicRoughness); },
     "have a metallic-roughness map that varies"},
    {&SceneFeatures::normalMaps, [](const Material& m) { return usesMap(m, MapSlot::normal); },
     "have a normal map that is not flat"},
    {&SceneFeatures::emissionMaps, [](const Material& m) { return usesMap(m, MapSlot::emission); },
     "have an emission map that varies"},
    {&SceneFeatures::transmissionMaps,
     [](const Material& m) { return usesMap(m, MapSlot::transmission) || usesMap(m, MapSlot::thickness); },
     "have a transmission or thickness map that varies"},
    {&SceneFeatures::specularMaps,
     [](const Material& m) { return usesMap(m, MapSlot::specular) || usesMap(m, MapSlot::specularColor); },
     "have a specular map that varies"},
    {&SceneFeatures::alphaMask, [](const Material& m) { return m.alphaMode == AlphaMode::mask; },
     "are cut out by a mask"},
    {&SceneFeatures::alphaBlend, [](const Material& m) { return m.alphaMode == AlphaMode::blend; },
     "are blended with what lies behind"},
    {&SceneFeatures::unlit, [](const Material& m) { return m.unlit; }, "are unlit"},
});

/// Finds each feature with its reason.
class FeatureFinder {
public:
    FeatureFinder(const Scene& scene, const RenderSettings& settings)
        : scene_(scene), settings_(settings), lights_(buildLightTable(scene, settings)) {
        const std::vector<Material> all = effectiveMaterials(scene);
        const std::vector<bool> used = materialsInUse(scene);
        for (std::size_t i = 0; i < all.size(); ++i)
            if (used[i]) materials_.push_back(all[i]);
        findGeometry();
        findCoincidence();
        findLights();
        findRoulette();
        for (const SurfaceFeature& feature : kOfSurfaces) findOnSurfaces(feature);
        findCulledBacks(used);
    }

    [[nodiscard]] const SceneFeatures& features() const { return features_; }

    /// In the order of kNamed, then lights and roulette.
    [[nodiscard]] std::vector<FeatureNote> notes() const {
        std::vector<FeatureNote> notes;
        notes.reserve(kNamed.size() + 2);
        for (const NamedFeature& named : kNamed)
            notes.push_back({std::string(named.name), features_.*named.flag, reasonOf(named.flag)});
        notes.push_back(lights_.lights.size() > 1
                            ? FeatureNote{"light-choice", true, fmt::format("{} lights", lights_.lights.size())}
                            : FeatureNote{"light-choice", false,
                                          lights_.lights.empty() ? "no light is sampled" : "there is one light"});
        notes.push_back({"roulette", features_.roulette != Roulette::off, rouletteReason_});
        return notes;
    }

private:
    void note(bool SceneFeatures::*flag, bool used, std::string reason) {
        features_.*flag = used;
        reasons_.push_back({flag, std::move(reason)});
    }

    [[nodiscard]] std::string reasonOf(bool SceneFeatures::*flag) const {
        for (const auto& [of, reason] : reasons_)
            if (of == flag) return reason;
        return {};
    }

    void findGeometry() {
        const std::size_t spheres = scene_.spheres.size();
        note(&SceneFeatures::spheres, spheres > 0, spheres > 0 ? fmt::format("{} exact", spheres) : "none is exact");
        const auto smooth = std::count_if(scene_.instances.begin(), scene_.instances.end(),
                                          [&](const Instance& i) { return !scene_.meshes[i.mesh].normals.empty(); });
        note(&SceneFeatures::smoothNormals, smooth > 0,
             fmt::format("{} of {} placed meshes have vertex normals", smooth, scene_.instances.size()));
        const bool colors = hasVertexColors(scene_);
        note(&SceneFeatures::vertexColors, colors, colors ? "some are not white" : "no mesh has any but white");
    }

    /// Where the search gives up the kernels ask: that is right everywhere.
    void findCoincidence() {
        const CoincidentTriangles triangles = findCoincident(deviceTriangles(scene_, settings_));
        const auto& [a, b] = triangles.pair;
        note(&SceneFeatures::coincident, triangles.outcome != Coincidence::none,
             triangles.outcome == Coincidence::found  ? fmt::format("triangles {} and {} lie at the same spot", a, b)
             : triangles.outcome == Coincidence::none ? "no two triangles overlap in a plane"
                                                      : "too many triangles lie close together to tell");
    }

    [[nodiscard]] bool hasKind(LightKind kind) const {
        return std::any_of(lights_.lights.begin(), lights_.lights.end(),
                           [&](const Light& light) { return light.kind == kind; });
    }

    void findLights() {
        const std::size_t lights = lights_.lights.size();
        features_.lights = lights == 0 ? LightCount::none : lights == 1 ? LightCount::one : LightCount::many;
        const bool area = hasKind(LightKind::area);
        note(&SceneFeatures::areaLights, area,
             area ? fmt::format("{} emitting primitives", lights_.areaCount) : "no emitting primitive is sampled");
        const bool punctual = hasKind(LightKind::punctual);
        note(&SceneFeatures::punctualLights, punctual,
             punctual ? fmt::format("{} of them", lights_.punctualCount) : "no point, spot or directional light");
        // Seen, even if there is nothing that it could light.
        const bool environment = followsLight(settings_) && scene_.environment.emits();
        note(&SceneFeatures::environment, environment, environment ? "it emits" : "nothing comes from afar");
        const bool map = environment && scene_.environment.map != nullptr;
        note(&SceneFeatures::environmentMap, map,
             map ? fmt::format("{} x {} texels", scene_.environment.map->width, scene_.environment.map->height)
                 : (environment ? "it is constant" : "nothing comes from afar"));
    }

    void findRoulette() {
        // A path of the last bounce is never asked whether to make another.
        const bool follows = followsLight(settings_);
        const bool asked = follows && countedBounces(settings_).last >= settings_.roulette.start;
        features_.roulette = asked ? settings_.roulette.kind : Roulette::off;
        rouletteReason_ = features_.roulette != Roulette::off
                              ? fmt::format("from bounce {} on", settings_.roulette.start)
                          : !follows ? "no path is followed"
                          : !asked   ? fmt::format("the last bounce, {}, comes first", countedBounces(settings_).last)
                                     : "switched off";
    }

    void findOnSurfaces(const SurfaceFeature& feature) {
        const auto count = std::count_if(materials_.begin(), materials_.end(), feature.has);
        note(feature.flag, count > 0, fmt::format("{} of {} materials {}", count, materials_.size(), feature.having));
    }

    /// Of the materials as the scene has them, as Packer culls.
    void findCulledBacks(const std::vector<bool>& used) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < used.size(); ++i)
            if (used[i] && scene_.materials[i].isSingleSided()) ++count;
        const bool culled = settings_.backFaces == BackFaces::culled;
        note(&SceneFeatures::backFaceCulling, culled && count > 0,
             culled ? fmt::format("{} of {} materials are single-sided", count, materials_.size())
                    : "back faces are shown");
    }

    const Scene& scene_;
    const RenderSettings& settings_;
    LightTable lights_;
    std::vector<Material> materials_; ///< effective ones in use
    SceneFeatures features_;
    std::vector<std::pair<bool SceneFeatures::*, std::string>> reasons_;
    std::string rouletteReason_;
};

} // namespace

std::span<const NamedFeature> namedFeatures() { return kNamed; }

SceneFeatures findFeatures(const Scene& scene, const RenderSettings& settings) {
    return FeatureFinder(scene, settings).features();
}

std::vector<FeatureNote> explainFeatures(const Scene& scene, const RenderSettings& settings) {
    return FeatureFinder(scene, settings).notes();
}

} // namespace isolux
