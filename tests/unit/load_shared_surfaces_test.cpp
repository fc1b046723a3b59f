// The glTF loader on the shared files: materials, textures and how coordinates are transformed.
#include "unit/load_shared.h"

#include <stdexcept>

namespace isolux {
namespace {

/// What of materials and textures a file of the collection holds.
struct SurfaceFigures {
    const char* file;
    std::size_t images;
    std::size_t textures;
    std::size_t maps;
    std::size_t coloredMeshes;
    std::size_t tangentMeshes;
};

TEST(SharedScenes, SampleFilesKeepTheirSurfaces) {
    const std::optional<fs::path> folder = sharedScenes();
    if (!folder) return;
    const std::vector<SurfaceFigures> files = {
        {"BoxTextured/BoxTextured.gltf", 1, 1, 1, 0, 0},
        {"BoxVertexColors.glb", 0, 0, 0, 1, 0},
        {"box-textured-with-fallback/box-textured-with-fallback.gltf", 1, 1, 1, 0, 0},
        {"NormalTangentMirrorTest.glb", 3, 3, 3, 0, 1},
        {"TextureSettingsTest.glb", 3, 8, 9, 0, 0},
    };
    for (const SurfaceFigures& expected : files) {
        const Scene scene = loadScene(*folder / "gltf" / expected.file);
        EXPECT_EQ(scene.images.size(), expected.images) << expected.file;
        EXPECT_EQ(scene.textures.size(), expected.textures) << expected.file;
        std::size_t maps = 0;
        for (const Material& material : scene.materials)
            for (const TextureMap& map : material.maps) maps += map.present() ? 1 : 0;
        EXPECT_EQ(maps, expected.maps) << expected.file;
        const auto count = [&](auto member) {
            return static_cast<std::size_t>(std::count_if(scene.meshes.begin(), scene.meshes.end(),
                                                          [&](const Mesh& mesh) { return !(mesh.*member).empty(); }));
        };
        EXPECT_EQ(count(&Mesh::colors), expected.coloredMeshes) << expected.file;
        EXPECT_EQ(count(&Mesh::tangents), expected.tangentMeshes) << expected.file;
    }
}

const Instance& instanceNamed(const Scene& scene, const std::string& name) {
    const auto found = std::find_if(scene.instances.begin(), scene.instances.end(),
                                    [&](const Instance& instance) { return instance.name == name; });
    if (found == scene.instances.end()) throw std::runtime_error("no instance " + name);
    return *found;
}

/// The file marks where the tip of an arrow is if the transform is right, and where it is without one.
TEST(SharedScenes, TransformsOfCoordinatesPutTheArrowWhereItIsMarked) {
    const std::optional<fs::path> folder = sharedScenes();
    if (!folder) return;
    const Scene scene = loadScene(*folder / "gltf" / "TextureTransformTest" / "TextureTransformTest.gltf");
    for (const std::string name : {"Rotation", "Scale"}) {
        const Instance& quad = instanceNamed(scene, name);
        const auto coordinatesOf = [&](const std::string& marker) {
            const Vec3d p = Vec3d(instanceNamed(scene, marker).worldFromObject[3] - quad.worldFromObject[3]);
            return Vec2d(0.5 + p.x, 0.5 - p.y); // the quad is of size 1, and v grows downwards
        };
        const Material& material = scene.materials.at(scene.meshes.at(quad.mesh).material);
        const TextureMap& map = material.map(MapSlot::baseColor);
        const Vec2d seen = map.uvFromMesh * coordinatesOf(name + " - Correct") + map.offset;
        EXPECT_NEAR(glm::distance(seen, coordinatesOf(name + " - Not Supported")), 0.0, 1e-6) << name;
    }
}

} // namespace
} // namespace isolux
