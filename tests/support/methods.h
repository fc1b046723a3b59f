// Every method that a render can be asked for, by name, and a scene in which each has something to do.
#pragma once

#include "scene/render_settings.h"
#include "scene/scene.h"

#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace isolux::test {

/// Whether a method leaves the expectation of the image as it is without it.
enum class Expectation { same, another };

struct Method {
    std::string name; ///< letters and digits: part of a test's name
    Expectation expectation = Expectation::same;
    std::function<void(RenderSettings&)> apply;
};

inline void PrintTo(const Method& method, std::ostream* stream) { *stream << method.name; }

[[nodiscard]] std::vector<Method> allMethods();

/// A light that shines downwards, a spot with a wide cone.
[[nodiscard]] PunctualLight punctualLight(PunctualKind kind, const Vec3d& position, const Vec3d& intensity);

/// The Cornell spheres with every kind of light: a lamp, a point, a spot and a directional light, an environment.
[[nodiscard]] Scene mixedLightsScene();

} // namespace isolux::test
