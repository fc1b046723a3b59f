// A film rendered on a device, as most tests want it: whole, and without a fault.
#pragma once

#include "film/film.h"
#include "render/path_renderer.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace isolux::test {

/// More features than a scene needs: all of them or, on drivers that repeat what another has done, of which one takes
/// minutes to compile all, every kind of geometry and light, and a little of what surfaces may have.
[[nodiscard]] inline SceneFeatures moreFeatures(const SceneFeatures& needed) {
    if (workShare() == 1.0) return {};
    SceneFeatures more = needed;
    more.spheres = more.smoothNormals = more.areaLights = more.punctualLights = more.environment = true;
    more.vertexColors = more.unlit = more.alphaMask = more.backFaceCulling = more.coincident = true;
    more.lights = LightCount::many;
    more.roulette = Roulette::throughput;
    return more;
}

[[nodiscard]] inline Film renderOnDevice(const Device& device, const Scene& scene, const RenderSettings& settings,
                                         const RenderOptions& options = {}) {
    Film film(settings.width, settings.height);
    PathRenderer renderer(device, scene, settings, options);
    renderer.render(film, [](double) { return Continue::yes; });
    EXPECT_TRUE(film.diagnostics.clean());
    return film;
}

} // namespace isolux::test
