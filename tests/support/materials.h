// Scenes in which each part of the surface model has something to do: lobes, maps, alpha, solids, environment maps.
#pragma once

#include "scene/render_settings.h"
#include "scene/scene.h"

#include <ostream>
#include <string>
#include <vector>

namespace isolux::test {

struct SurfaceCase {
    std::string name; ///< letters and digits: part of a test's name
    Scene scene;
    BackFaces backFaces = BackFaces::shown;
};

inline void PrintTo(const SurfaceCase& tested, std::ostream* stream) { *stream << tested.name; }

/// One case for each lobe, map and kind of alpha, one with all of them, and one whose back faces are culled.
[[nodiscard]] std::vector<SurfaceCase> surfaceCases();

/// The case of that name.
[[nodiscard]] Scene surfaceScene(const std::string& name);

/// 16 x 8 texels of a sky: a bright spot in a blue gradient, darker below.
[[nodiscard]] EnvironmentMap skyMap();

} // namespace isolux::test
