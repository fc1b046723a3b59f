// The glTF loader on files: the project's own scenes, and the shared ones where they are.
#include "unit/load_shared.h"

#include "core/error.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <map>

namespace isolux {
namespace {

using nlohmann::json;

class ProjectScene : public ::testing::TestWithParam<std::string> {};

TEST_P(ProjectScene, LoadsWithTheExpectedFigures) {
    const fs::path folder = fs::path(ISOLUX_SOURCE_DIR) / "scenes" / GetParam();
    const json expected = json::parse(std::ifstream(folder / "expected.json"));
    const Scene scene = loadScene(folder / (GetParam() + ".gltf"));
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    std::size_t lights = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        lights += scene.materials[mesh.material].emits() ? mesh.triangles.size() : 0;
    }
    for (const Sphere& sphere : scene.spheres) lights += scene.materials[sphere.material].emits() ? 1 : 0;
    EXPECT_EQ(primitiveCount(scene), expected["triangles"].get<std::size_t>() + scene.spheres.size());
    EXPECT_EQ(scene.spheres.size(), expected["spheres"].get<std::size_t>());
    EXPECT_EQ(scene.cameras.size(), expected["cameras"].get<std::size_t>());
    EXPECT_EQ(lights, expected["lights"].get<std::size_t>());
    EXPECT_EQ(scene.cameras.at(0).aspectRatio, expected.value("aspectRatio", 1.0));
    EXPECT_EQ(scene.punctualLights.size(), expected.value("punctualLights", std::size_t{0}));
    for (int c = 0; c < 3; ++c)
        EXPECT_EQ(scene.environment.radiance[c], expected.value("sky", std::vector<double>(3, 0.0))[c]);
}

INSTANTIATE_TEST_SUITE_P(Load, ProjectScene,
                         ::testing::Values("cornell_box", "cornell_spheres", "courtyard", "furnace", "glass", "glossy",
                                           "materials", "veach_mis"),
                         [](const auto& instance) { return instance.param; });

/// World-space corners of every triangle of the instance named so.
std::vector<std::array<Vec3d, 3>> trianglesOf(const Scene& scene, const std::string& name) {
    std::vector<std::array<Vec3d, 3>> triangles;
    for (const Instance& instance : scene.instances) {
        if (instance.name != name) continue;
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (const auto& triangle : mesh.triangles) {
            auto& corners = triangles.emplace_back();
            for (std::size_t i = 0; i < 3; ++i)
                corners[i] = Vec3d(instance.worldFromObject * glm::dvec4(Vec3d(mesh.positions[triangle[i]]), 1.0));
        }
    }
    return triangles;
}

/// Whether all front faces are turned towards a point.
bool allFace(const std::vector<std::array<Vec3d, 3>>& triangles, const Vec3d& point) {
    return !triangles.empty() && std::all_of(triangles.begin(), triangles.end(), [&](const auto& t) {
        return glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), point - t[0]) > 0.0;
    });
}

TEST(ProjectSceneTest, SurfacesFaceTheRightWay) {
    const fs::path folder = fs::path(ISOLUX_SOURCE_DIR) / "scenes";
    const Scene furnace = loadScene(folder / "furnace" / "furnace.gltf");
    EXPECT_TRUE(allFace(trianglesOf(furnace, "walls"), furnace.cameras.at(0).position));
    const Scene box = loadScene(folder / "cornell_box" / "cornell_box.gltf");
    for (const char* name : {"walls", "left wall", "right wall", "lamp"})
        EXPECT_TRUE(allFace(trianglesOf(box, name), Vec3d(0, 1, 0))) << name;
}

TEST(SharedScenes, SeedScenesLoad) {
    const std::optional<fs::path> folder = sharedScenes();
    if (!folder) return;
    const std::vector<fs::path> files = gltfFilesIn(*folder / "seed");
    EXPECT_GE(files.size(), 20u);
    for (const fs::path& file : files) {
        const Scene scene = loadScene(file);
        EXPECT_GT(primitiveCount(scene), 0u) << file;
        EXPECT_EQ(scene.cameras.size(), 1u) << file;
        for (const std::string& warning : scene.warnings)
            EXPECT_EQ(warning.find("punctual"), std::string::npos) << file << ": " << warning;
    }
}

TEST(SharedScenes, SeedScenesKeepTheirLights) {
    const std::optional<fs::path> folder = sharedScenes();
    if (!folder) return;
    const Scene banana = loadScene(*folder / "seed" / "banana.glb");
    EXPECT_EQ(banana.environment.radiance, Vec3d(1.0));
    EXPECT_EQ(banana.environment.extent, EnvironmentExtent::upperHalf);
    ASSERT_EQ(banana.punctualLights.size(), 1u);
    EXPECT_EQ(banana.punctualLights[0].kind, PunctualKind::directional);
    EXPECT_EQ(banana.punctualLights[0].name, "Area_001");
    EXPECT_LT(banana.punctualLights[0].direction.y, -0.7); // down, from the matrix of its node
    const Scene cube = loadScene(*folder / "seed" / "tiny" / "cube.glb");
    EXPECT_FALSE(cube.environment.emits());
    EXPECT_EQ(cube.punctualLights.at(0).kind, PunctualKind::point);
    EXPECT_EQ(cube.punctualLights[0].position, Vec3d(0, 1.49, 0));
}

/// What a file of the collection holds.
struct FileFigures {
    const char* file;
    std::size_t triangles;
    std::size_t cameras;
    std::size_t lights;
};

TEST(SharedScenes, SampleFilesLoadWithTheExpectedFigures) {
    const std::optional<fs::path> folder = sharedScenes();
    if (!folder) return;
    const std::vector<FileFigures> files = {
        {"AnimatedMorphCube-glTF-Quantized/AnimatedMorphCube.gltf", 12, 1, 0},
        {"SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12, 1, 0},
        {"MeshPrimitiveModes/MeshPrimitiveModes.gltf", 6 + 4 + 6, 1, 0},
        {"PrimitiveModeNormalsTest.glb", 2562, 1, 0},
        {"Cameras/Cameras.gltf", 2, 2, 0},
        {"BoxInterleaved.glb", 12, 1, 0},
        {"LightsPunctualLamp/LightsPunctualLamp.gltf", 6000, 1, 5},
        {"MultipleScenes/MultipleScenes.gltf", 2, 1, 0},
    };
    for (const FileFigures& expected : files) {
        const Scene scene = loadScene(*folder / "gltf" / expected.file);
        EXPECT_EQ(primitiveCount(scene), expected.triangles) << expected.file;
        EXPECT_EQ(scene.cameras.size(), expected.cameras) << expected.file;
        EXPECT_EQ(scene.punctualLights.size(), expected.lights) << expected.file;
    }
}

TEST(SharedScenes, SampleFilesDecodeToTheShapesTheyDescribe) {
    const std::optional<fs::path> shared = sharedScenes();
    if (!shared) return;
    const fs::path folder = *shared / "gltf";
    const Scene modes = loadScene(folder / "MeshPrimitiveModes" / "MeshPrimitiveModes.gltf");
    for (const char* name : {"node 4", "node 5", "node 6"}) // triangles, a strip and a fan, wound alike
        EXPECT_TRUE(allFace(trianglesOf(modes, name), Vec3d(0, 0, 1))) << name;
    const Scene sparse = loadScene(folder / "SimpleSparseAccessor" / "SimpleSparseAccessor.gltf");
    EXPECT_EQ(sparse.meshes.at(0).positions.at(8), Vec3f(1, 2, 0));
    EXPECT_EQ(sparse.meshes[0].positions.at(9), Vec3f(2, 1, 0));
    EXPECT_EQ(sparse.meshes[0].positions.at(12), Vec3f(5, 4, 0));
    const fs::path quantised = folder / "AnimatedMorphCube-glTF-Quantized" / "AnimatedMorphCube.gltf";
    const Scene cube = loadScene(quantised);
    EXPECT_NEAR(glm::distance(worldBounds(cube).extent(), Vec3d(2.0)), 0.0, 1e-3); // steps of 100 * 3.65e-6
    for (const Vec3f& normal : cube.meshes.at(0).normals) EXPECT_EQ(glm::length(normal), 1.0f);
    EXPECT_EQ(worldBounds(loadScene(folder / "BoxInterleaved.glb")).extent(), Vec3d(1.0));
    const Scene cameras = loadScene(folder / "Cameras" / "Cameras.gltf");
    EXPECT_EQ(cameras.cameras.at(1).projection, Projection::orthographic);
    EXPECT_EQ(cameras.cameras[1].ymag, 1.0);
    EXPECT_EQ(cameras.cameras[1].name, "camera 1");
}

/// The files of the collection that require an extension which is not supported, and that extension.
const std::map<std::string, std::string>& refusedFiles() {
    static const std::map<std::string, std::string> kFiles = {
        {"IridescenceSuzanne.glb", "KHR_materials_iridescence"},
        {"MorphPrimitivesTest-glTF-Draco", "KHR_draco_mesh_compression"},
        {"meshopt-no-fallback", "EXT_meshopt_compression"},
    };
    return kFiles;
}

/// What loading a file fails with; empty if it succeeds.
std::string failureOf(const fs::path& file) {
    try {
        EXPECT_GT(primitiveCount(loadScene(file)), 0u) << file;
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(SharedScenes, SampleFilesLoadUnlessTheyRequireWhatIsNotSupported) {
    const std::optional<fs::path> folder = sharedScenes();
    if (!folder) return;
    const std::vector<fs::path> files = gltfFilesIn(*folder / "gltf");
    EXPECT_GE(files.size(), 49u);
    std::size_t refused = 0;
    for (const fs::path& file : files) {
        const std::string name = file.lexically_relative(*folder / "gltf").begin()->string();
        const std::string failure = failureOf(file);
        const auto expected = refusedFiles().find(name);
        if (expected == refusedFiles().end()) {
            EXPECT_EQ(failure, "");
            continue;
        }
        EXPECT_NE(failure.find(": /extensionsRequired/"), std::string::npos) << failure;
        EXPECT_NE(failure.find("the file requires " + expected->second), std::string::npos) << failure;
        ++refused;
    }
    EXPECT_EQ(refused, refusedFiles().size());
}

} // namespace
} // namespace isolux
