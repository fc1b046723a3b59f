#include "support/scenes.h"

#include <cstdlib>
#include <stdexcept>

namespace isolux::test {

std::filesystem::path projectScene(const std::string& name) {
    return std::filesystem::path(ISOLUX_SOURCE_DIR) / "scenes" / name / (name + ".gltf");
}

std::filesystem::path blobScene() {
    const std::filesystem::path path = std::filesystem::path(ISOLUX_SOURCE_DIR) / "build" / "scenes" / "blob.glb";
    if (!std::filesystem::exists(path))
        throw std::runtime_error(path.string() + " is missing; make it with: tools/make_scenes --blob " +
                                 path.string());
    return path;
}

std::optional<std::filesystem::path> sharedFolder() {
    const std::filesystem::path path = std::filesystem::path(ISOLUX_SOURCE_DIR).parent_path() / "shared";
    return std::filesystem::exists(path / "scenes") ? std::optional(path) : std::nullopt;
}

bool inContinuousIntegration() { return std::getenv("CI") != nullptr; }

bool longTests() { return std::getenv("ISOLUX_LONG_TESTS") != nullptr; }

double workShare() { return std::getenv("ISOLUX_REPEATED_DRIVER") != nullptr && !longTests() ? 0.1 : 1.0; }

Scene furnaceScene(const Vec3d& albedo, const Vec3d& emission) {
    Scene scene;
    scene.name = "furnace";
    scene.materials = {{"wall", albedo, emission, true}};
    Mesh box;
    box.name = "box";
    for (int i = 0; i < 8; ++i)
        box.positions.emplace_back((i & 1) != 0 ? 1.0f : -1.0f, (i & 2) != 0 ? 1.0f : -1.0f,
                                   (i & 4) != 0 ? 1.0f : -1.0f);
    box.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                     {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    scene.meshes = {box};
    scene.instances = {{"box", 0, Mat4d(1.0)}};
    Camera camera;
    camera.position = Vec3d(0.1, -0.2, 0.3);
    camera.yfov = 1.2;
    scene.cameras = {camera};
    return scene;
}

} // namespace isolux::test
