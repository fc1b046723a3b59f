// What validation refuses of images, materials, attributes and environment maps, and whom it names.
#include "core/error.h"
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

namespace isolux {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One textured triangle with every attribute, a sphere of the same material, an environment map.
Scene fullScene() {
    Scene scene;
    scene.images = {{"bricks", 2, 1, std::vector<Texel8>(2), {}}, {"bumps", 1, 2, {}, std::vector<Texel16>(2)}};
    scene.textures.resize(2);
    scene.textures[1].image = 1;
    Material material;
    material.name = "wall";
    for (TextureMap& map : material.maps) map.texture = 1;
    scene.materials = {material};
    Mesh mesh;
    mesh.name = "corner";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, Vec3f(0.0f, 0.0f, 1.0f));
    mesh.triangles = {{0, 1, 2}};
    mesh.uvs = {std::vector<Vec2<float>>(3)};
    mesh.colors.assign(3, glm::vec4(1.0f));
    mesh.tangents.assign(3, glm::vec4(1.0f, 0.0f, 0.0f, -1.0f));
    scene.meshes = {mesh};
    scene.instances = {{"corner", 0, Mat4d(1.0)}};
    scene.spheres = {{"ball", Vec3d(0.0), 1.0, 0}};
    scene.environment.radiance = Vec3d(1.0);
    scene.environment.map = std::make_shared<EnvironmentMap>(EnvironmentMap{"sky", 2, 1, {Vec3f(0.0f), Vec3f(1.0f)}});
    return scene;
}

/// The message with which the scene is refused after a change; empty if it is not.
std::string refusal(const std::function<void(Scene&)>& change) {
    Scene scene = fullScene();
    change(scene);
    try {
        validate(scene);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::badInput);
        return error.what();
    }
    return {};
}

void expectRefusal(const std::string& name, const std::function<void(Scene&)>& change) {
    const std::string message = refusal(change);
    EXPECT_TRUE(message.starts_with(name + ":")) << name << " should be named in '" << message << "'";
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(SceneValidation, AcceptsWhatIsComplete) {
    EXPECT_EQ(refusal([](Scene&) {}), "");
    EXPECT_EQ(refusal([](Scene& scene) { scene.materials[0].attenuationDistance = 1e-3; }), "");
    EXPECT_EQ(refusal([](Scene& scene) { scene.materials[0].normalScale = -2.0; }), "");
    EXPECT_EQ(refusal([](Scene& scene) { scene.materials[0].specularColor = Vec3d(7.0); }), "");
    EXPECT_EQ(refusal([](Scene& scene) { scene.environment.rotation = -3.5; }), "");
    EXPECT_EQ(refusal([](Scene& scene) { scene.meshes[0].uvs[0][1].x = std::numeric_limits<float>::quiet_NaN(); }), "")
        << "it reads as 0";
}

TEST(SceneValidation, ImagesHaveThePixelsTheySay) {
    const std::string name = "image 'bricks'";
    expectRefusal(name, [](Scene& scene) { scene.images[0].width = 0; });
    expectRefusal(name, [](Scene& scene) { scene.images[0].height = 0; });
    expectRefusal(name, [](Scene& scene) { scene.images[0].height = 2; });
    expectRefusal(name, [](Scene& scene) { scene.images[0].texels8.clear(); });
    expectRefusal(name, [](Scene& scene) { scene.images[0].texels16.resize(2); });
    expectRefusal(name, [](Scene& scene) { scene.images[0].width = scene.images[0].height = 65536; });
    expectRefusal("image 'bumps'", [](Scene& scene) { scene.images[1].texels16.pop_back(); });
}

TEST(SceneValidation, IndicesLeadSomewhere) {
    expectRefusal("texture 1", [](Scene& scene) { scene.textures[1].image = 2; });
    for (std::size_t slot = 0; slot < kMapSlots; ++slot)
        expectRefusal("material 'wall'", [&](Scene& scene) { scene.materials[0].maps[slot].texture = 2; });
    expectRefusal("mesh 'corner'", [](Scene& scene) { scene.meshes[0].material = 1; });
    expectRefusal("node 'corner'", [](Scene& scene) { scene.instances[0].mesh = 1; });
    expectRefusal("sphere 'ball'", [](Scene& scene) { scene.spheres[0].material = 1; });
}

TEST(SceneValidation, FactorsLieInTheirRanges) {
    const auto expectRange = [](double Material::*factor, std::initializer_list<double> good,
                                std::initializer_list<double> bad) {
        for (const double number : good)
            EXPECT_EQ(refusal([&](Scene& scene) { scene.materials[0].*factor = number; }), "") << number;
        for (const double number : bad)
            expectRefusal("material 'wall'", [&](Scene& scene) { scene.materials[0].*factor = number; });
    };
    for (double Material::*factor :
         {&Material::metallic, &Material::roughness, &Material::specular, &Material::transmission, &Material::alpha})
        expectRange(factor, {0.0, 0.3, 1.0}, {-1e-9, 1.0 + 1e-9, kNaN, kInfinity});
    expectRange(&Material::ior, {1.0, 1.5, 100.0}, {0.0, 0.999, -1.5, kNaN, kInfinity});
    expectRange(&Material::thickness, {0.0, 1e6}, {-1.0, kNaN, kInfinity});
    expectRange(&Material::attenuationDistance, {1e-9, kInfinity}, {0.0, -1.0, kNaN});
    expectRange(&Material::alphaCutoff, {0.0, 0.5, 1.5}, {-0.1, kNaN, kInfinity});
    expectRange(&Material::normalScale, {-1.0, 0.0, 3.0}, {kNaN, kInfinity, 1e30});
}

TEST(SceneValidation, ColoursLieInTheirRanges) {
    for (Vec3d Material::*color : {&Material::baseColor, &Material::attenuationColor})
        for (const double number : {-0.1, 1.1, kNaN, kInfinity})
            expectRefusal("material 'wall'", [&](Scene& scene) { (scene.materials[0].*color).y = number; });
    for (Vec3d Material::*color : {&Material::emission, &Material::specularColor})
        for (const double number : {-0.1, kNaN, kInfinity})
            expectRefusal("material 'wall'", [&](Scene& scene) { (scene.materials[0].*color).z = number; });
}

TEST(SceneValidation, CoordinatesAreTransformedByNumbers) {
    for (const double number : {kNaN, kInfinity}) {
        expectRefusal("material 'wall'", [&](Scene& scene) { scene.materials[0].maps[3].offset.y = number; });
        expectRefusal("material 'wall'", [&](Scene& scene) { scene.materials[0].maps[0].uvFromMesh[1][0] = number; });
    }
    EXPECT_EQ(refusal([](Scene& scene) {
                  scene.materials[0].maps[3].texture = kNoTexture;
                  scene.materials[0].maps[3].offset.y = kNaN;
              }),
              "")
        << "a map that is not there is of no concern";
}

TEST(SceneValidation, AttributesHaveOneEntryAPosition) {
    const std::string name = "mesh 'corner'";
    expectRefusal(name, [](Scene& scene) { scene.meshes[0].normals.pop_back(); });
    expectRefusal(name, [](Scene& scene) { scene.meshes[0].uvs[0].pop_back(); });
    expectRefusal(name, [](Scene& scene) { scene.meshes[0].colors.emplace_back(1.0f); });
    expectRefusal(name, [](Scene& scene) { scene.meshes[0].tangents.pop_back(); });
}

TEST(SceneValidation, MapsFindTheirCoordinatesAndTangents) {
    const std::string name = "mesh 'corner'";
    expectRefusal(name, [](Scene& scene) { scene.materials[0].maps[6].uvSet = 1; });
    expectRefusal(name, [](Scene& scene) { scene.meshes[0].uvs.clear(); });
    expectRefusal(name, [](Scene& scene) { scene.meshes[0].uvs[0].clear(); });
    expectRefusal(name, [](Scene& scene) { scene.meshes[0].tangents.clear(); });
    EXPECT_EQ(refusal([](Scene& scene) {
                  scene.materials[0].maps = {};
                  scene.meshes[0].uvs.clear();
                  scene.meshes[0].tangents.clear();
              }),
              "");
    EXPECT_EQ(refusal([](Scene& scene) {
                  scene.meshes[0] = Mesh{};
                  scene.meshes[0].name = "no triangles";
              }),
              "");
}

TEST(SceneValidation, VertexColoursAndTangentsAreNumbers) {
    for (const float number : {-0.01f, 1.01f, static_cast<float>(kNaN), static_cast<float>(kInfinity)})
        for (int channel = 0; channel < 4; ++channel)
            expectRefusal("mesh 'corner'", [&](Scene& scene) { scene.meshes[0].colors[2][channel] = number; });
    for (const float number : {static_cast<float>(kNaN), static_cast<float>(kInfinity)})
        expectRefusal("mesh 'corner'", [&](Scene& scene) { scene.meshes[0].tangents[1].y = number; });
    for (const float sign : {0.0f, 0.5f, 2.0f, static_cast<float>(kNaN)})
        expectRefusal("mesh 'corner'", [&](Scene& scene) { scene.meshes[0].tangents[1].w = sign; });
}

TEST(SceneValidation, EnvironmentMapsAreLight) {
    const auto withMap = [](const EnvironmentMap& map) {
        return [map](Scene& scene) { scene.environment.map = std::make_shared<EnvironmentMap>(map); };
    };
    const std::string name = "environment map 'sky'";
    expectRefusal(name, withMap({"sky", 0, 0, {}}));
    expectRefusal(name, withMap({"sky", 2, 2, {Vec3f(1.0f)}}));
    for (const float number : {-1e-9f, static_cast<float>(kNaN), static_cast<float>(kInfinity)})
        expectRefusal(name, withMap({"sky", 1, 2, {Vec3f(1.0f), Vec3f(0.0f, number, 0.0f)}}));
    EXPECT_EQ(refusal(withMap({"sky", 1, 1, {Vec3f(0.0f)}})), "");
    expectRefusal("environment", [](Scene& scene) { scene.environment.extent = EnvironmentExtent::upperHalf; });
    expectRefusal("environment", [](Scene& scene) { scene.environment.rotation = kNaN; });
}

} // namespace
} // namespace isolux
