// A film rendered on a device, as most tests want it: whole, and without a fault.
#pragma once

#include "film/film.h"
#include "render/path_renderer.h"

#include <gtest/gtest.h>

namespace isolux::test {

[[nodiscard]] inline Film renderOnDevice(const Device& device, const Scene& scene, const RenderSettings& settings,
                                         const RenderOptions& options = {}) {
    Film film(settings.width, settings.height);
    PathRenderer renderer(device, scene, settings, options);
    renderer.render(film, [](double) { return Continue::yes; });
    EXPECT_TRUE(film.diagnostics.clean());
    return film;
}

} // namespace isolux::test
