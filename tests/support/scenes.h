// Where tests find scenes: the project's own, the generated one, and the optional collection beside the checkout.
#pragma once

#include "scene/scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isolux::test {

/// scenes/<name>/<name>.gltf
[[nodiscard]] std::filesystem::path projectScene(const std::string& name);
/// The displaced sphere of about 200,000 triangles that tools/test generates; throws std::runtime_error without it.
[[nodiscard]] std::filesystem::path blobScene();
/// ../shared beside the checkout, which a user does not have.
[[nodiscard]] std::optional<std::filesystem::path> sharedFolder();
/// Whether tests run in continuous integration, where nothing may be missing.
[[nodiscard]] bool inContinuousIntegration();
/// Whether `tools/test --long` asked for the long versions.
[[nodiscard]] bool longTests();

/// The share of a test's work to do: all of it on the first driver and with `tools/test --long`, a tenth on drivers
/// that repeat what another has done (ISOLUX_REPEATED_DRIVER), of which one is thirty times slower.
[[nodiscard]] double workShare();

/// A closed box of edge 2 about the origin, seen from inside: radiance is emission / (1 - albedo) everywhere.
[[nodiscard]] Scene furnaceScene(const Vec3d& albedo, const Vec3d& emission);

} // namespace isolux::test
