#include "support/materials.h"

#include "load/gltf.h"
#include "support/methods.h"
#include "support/scenes.h"

#include <cmath>
#include <functional>
#include <stdexcept>

namespace isolux::test {
namespace {

constexpr std::uint32_t kPanelCells = 6; // an edge

/// Texels by a formula of their place, in [0, 1].
using Pattern = std::function<glm::dvec4(double u, double v)>;

TextureImage image8(std::uint32_t width, std::uint32_t height, const Pattern& pattern) {
    TextureImage image{"pattern", width, height, {}, {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            image.texels8.emplace_back(pattern((x + 0.5) / width, (y + 0.5) / height) * 255.0 + 0.5);
    return image;
}

TextureImage image16(std::uint32_t width, std::uint32_t height, const Pattern& pattern) {
    TextureImage image{"fine pattern", width, height, {}, {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            image.texels16.emplace_back(pattern((x + 0.5) / width, (y + 0.5) / height) * 65535.0 + 0.5);
    return image;
}

glm::dvec4 colourful(double u, double v) { return {0.2 + 0.7 * u, 0.9 - 0.6 * v, 0.3 + 0.4 * u * v, 0.15 + 0.8 * v}; }

glm::dvec4 bumps(double u, double v) {
    const Vec3d n = glm::normalize(Vec3d(0.5 * std::sin(7.0 * u), 0.4 * std::cos(9.0 * v), 1.0));
    return {0.5 + 0.5 * n, 1.0};
}

/// A panel that bulges towards +z, with every attribute; its second set of coordinates is turned by a quarter.
Mesh bulgingPanel(std::uint32_t material) {
    Mesh mesh;
    mesh.name = "panel";
    mesh.material = material;
    mesh.uvs.resize(2);
    for (std::uint32_t j = 0; j <= kPanelCells; ++j)
        for (std::uint32_t i = 0; i <= kPanelCells; ++i) {
            const float u = static_cast<float>(i) / kPanelCells;
            const float v = static_cast<float>(j) / kPanelCells;
            const float x = 2.0f * u - 1.0f;
            const float y = 1.0f - 2.0f * v;
            mesh.positions.emplace_back(x, y, 0.3f * (1.0f - x * x));
            mesh.normals.push_back(glm::normalize(Vec3f(0.6f * x, 0.0f, 1.0f)));
            mesh.tangents.emplace_back(glm::normalize(Vec3f(1.0f, 0.0f, -0.6f * x)), 1.0f);
            mesh.colors.emplace_back(0.4f + 0.6f * u, 1.0f, 0.5f + 0.5f * v, 0.5f + 0.5f * u);
            mesh.uvs[0].emplace_back(u, v);
            mesh.uvs[1].emplace_back(-v, 3.0f * u);
        }
    for (std::uint32_t j = 0; j < kPanelCells; ++j)
        for (std::uint32_t i = 0; i < kPanelCells; ++i) {
            const std::uint32_t a = j * (kPanelCells + 1) + i;
            const std::uint32_t c = a + kPanelCells + 1;
            mesh.triangles.push_back({a, c, c + 1});
            mesh.triangles.push_back({a, c + 1, a + 1});
        }
    return mesh;
}

/// The Cornell spheres, both of `subject`, and a panel of it that leans above them; every kind of light shines.
class Builder {
public:
    explicit Builder(Material subject) : scene_(mixedLightsScene()) {
        subject.name = "subject";
        subject_ = static_cast<std::uint32_t>(scene_.materials.size());
        scene_.materials.push_back(std::move(subject));
        for (Sphere& sphere : scene_.spheres) sphere.material = subject_;
        Mesh panel = bulgingPanel(subject_);
        panel.colors.clear();
        Instance instance{"panel", static_cast<std::uint32_t>(scene_.meshes.size()), Mat4d(1.0)};
        const double size = 0.45;
        instance.worldFromObject[0] = {size, 0.0, 0.1, 0.0};
        instance.worldFromObject[1] = {0.0, 0.9 * size, -0.3 * size, 0.0};
        instance.worldFromObject[2] = {-0.1, 0.2 * size, size, 0.0};
        instance.worldFromObject[3] = {0.0, 1.25, -0.2, 1.0};
        scene_.meshes.push_back(std::move(panel));
        scene_.instances.push_back(std::move(instance));
    }

    Material& subject() { return scene_.materials[subject_]; }
    Mesh& panel() { return scene_.meshes.back(); }
    Scene& scene() { return scene_; }

    Builder& map(MapSlot slot, TextureImage image, const Texture& how = {}) {
        Texture texture = how;
        texture.image = static_cast<std::uint32_t>(scene_.images.size());
        scene_.images.push_back(std::move(image));
        subject().maps[static_cast<std::size_t>(slot)].texture = static_cast<std::uint32_t>(scene_.textures.size());
        scene_.textures.push_back(texture);
        return *this;
    }

    Builder& colors() {
        panel().colors = bulgingPanel(0).colors;
        return *this;
    }

private:
    Scene scene_;
    std::uint32_t subject_ = 0;
};

Material metal(double roughness, const Vec3d& color = Vec3d(0.9, 0.7, 0.4)) {
    Material material;
    material.baseColor = color;
    material.metallic = 1.0;
    material.roughness = roughness;
    return material;
}

Material plastic(double roughness) {
    Material material;
    material.baseColor = Vec3d(0.2, 0.5, 0.7);
    material.roughness = roughness;
    material.specular = 1.0;
    return material;
}

enum class Walls { thin, solid };

Material glass(double roughness, Walls walls) {
    Material material;
    material.baseColor = Vec3d(0.95, 0.85, 0.7);
    material.roughness = roughness;
    material.specular = 1.0;
    material.transmission = 1.0;
    material.thickness = walls == Walls::solid ? 1.0 : 0.0;
    return material;
}

void addLobes(std::vector<SurfaceCase>& cases) {
    const auto add = [&](const std::string& name, const Material& material) {
        cases.push_back({name, Builder(material).scene()});
    };
    add("Mirror", metal(0.0));
    add("PolishedMetal", metal(0.1));
    add("RoughMetal", metal(0.7));
    add("SmoothPlastic", plastic(0.0));
    add("RoughPlastic", plastic(0.5));
    Material mixed = plastic(0.4);
    mixed.metallic = 0.4;
    mixed.specular = 0.7;
    mixed.specularColor = Vec3d(1.0, 0.5, 0.2);
    mixed.ior = 1.8;
    add("HalfMetal", mixed);
    add("SmoothThinGlass", glass(0.0, Walls::thin));
    add("RoughThinGlass", glass(0.5, Walls::thin));
    add("SmoothSolidGlass", glass(0.0, Walls::solid));
    add("RoughSolidGlass", glass(0.4, Walls::solid));
    Material tinted = glass(0.0, Walls::solid);
    tinted.attenuationColor = Vec3d(0.3, 0.8, 0.5);
    tinted.attenuationDistance = 0.2;
    add("AbsorbingGlass", tinted);
    tinted.roughness = 0.3;
    tinted.transmission = 0.6;
    tinted.metallic = 0.2;
    add("PartlyGlass", tinted);
    Material indexOne = glass(0.5, Walls::solid);
    indexOne.ior = 1.0;
    add("IndexOne", indexOne);
}

void addMaps(std::vector<SurfaceCase>& cases) {
    const auto add = [&](const std::string& name, Builder& builder) { cases.push_back({name, builder.scene()}); };
    Material lambertian;
    Builder base(lambertian);
    base.map(MapSlot::baseColor, image8(5, 7, colourful));
    TextureMap& transformed = base.subject().maps[0];
    transformed.uvFromMesh = {1.5, 0.4, -0.3, 2.0};
    transformed.offset = {0.2, -0.7};
    add("BaseColorMap", base);
    Builder nearest(lambertian);
    nearest.map(MapSlot::baseColor, image16(9, 4, colourful),
                {0, TextureWrap::mirroredRepeat, TextureWrap::clampToEdge, TextureFilter::nearest});
    nearest.subject().maps[0].uvSet = 1;
    add("NearestWideMap", nearest);
    Builder roughness(metal(1.0));
    roughness.map(MapSlot::metallicRoughness, image8(8, 8, colourful));
    roughness.subject().specular = 1.0;
    add("MetallicRoughnessMap", roughness);
    Builder normal(plastic(0.4));
    normal.map(MapSlot::normal, image8(16, 16, bumps));
    normal.subject().normalScale = 0.8;
    add("NormalMap", normal);
    Builder emission(lambertian);
    emission.map(MapSlot::emission, image8(6, 6, colourful));
    emission.subject().emission = Vec3d(2.0, 3.0, 1.0);
    emission.subject().baseColor = Vec3d(0.3);
    add("EmissionMap", emission);
    Builder transmission(glass(0.3, Walls::solid));
    transmission.map(MapSlot::transmission, image8(4, 4, colourful));
    transmission.map(MapSlot::thickness, image8(2, 2, [](double u, double) { return glm::dvec4(u > 0.5 ? 1.0 : 0.0); }),
                     {0, TextureWrap::repeat, TextureWrap::repeat, TextureFilter::nearest});
    add("TransmissionMaps", transmission);
    Builder specular(plastic(0.3));
    specular.map(MapSlot::specular, image8(4, 4, colourful)).map(MapSlot::specularColor, image8(8, 2, colourful));
    add("SpecularMaps", specular);
    Builder colors(lambertian);
    add("VertexColors", colors.colors());
}

void addAlpha(std::vector<SurfaceCase>& cases) {
    Builder mask{Material{}};
    mask.map(MapSlot::baseColor, image8(12, 12, colourful));
    mask.subject().alphaMode = AlphaMode::mask;
    cases.push_back({"AlphaMask", mask.scene()});
    Builder blend{Material{}};
    blend.map(MapSlot::baseColor, image8(12, 12, colourful)).colors();
    blend.subject().alphaMode = AlphaMode::blend;
    blend.subject().alpha = 0.9;
    blend.subject().emission = Vec3d(0.5, 1.0, 0.3);
    cases.push_back({"AlphaBlend", blend.scene()});
    Builder unlit{Material{}};
    unlit.map(MapSlot::baseColor, image8(12, 12, colourful));
    unlit.subject().unlit = true;
    cases.push_back({"Unlit", unlit.scene()});
}

/// A panel of everything, spheres of glass, and a sky.
Scene everything() {
    Builder builder(plastic(1.0));
    builder.map(MapSlot::baseColor, image8(12, 12, colourful)).map(MapSlot::metallicRoughness, image8(8, 8, colourful));
    builder.map(MapSlot::normal, image8(16, 16, bumps)).map(MapSlot::emission, image8(6, 6, colourful)).colors();
    builder.subject().emission = Vec3d(0.3);
    builder.subject().alphaMode = AlphaMode::blend;
    Scene& scene = builder.scene();
    Material tinted = glass(0.2, Walls::solid);
    tinted.attenuationColor = Vec3d(0.3, 0.8, 0.5);
    tinted.attenuationDistance = 0.5;
    scene.spheres[0].material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(tinted);
    scene.spheres[1].material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(metal(0.0));
    scene.environment.map = std::make_shared<EnvironmentMap>(skyMap());
    scene.environment.rotation = 0.3;
    return scene;
}

/// A panel cut out by a mask that turns its back, in a shell that is seen from inside; one of the spheres is glass.
Scene backFaces() {
    Builder builder{Material{}};
    builder.map(MapSlot::baseColor, image8(12, 12, colourful));
    builder.subject().alphaMode = AlphaMode::mask;
    for (auto& triangle : builder.panel().triangles) std::swap(triangle[1], triangle[2]);
    Scene& scene = builder.scene();
    scene.spheres[0].material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(glass(0.2, Walls::solid));
    scene.spheres.push_back({"shell", Vec3d(0.0, 1.0, 0.0), 20.0, static_cast<std::uint32_t>(scene.materials.size())});
    scene.materials.push_back(metal(0.5));
    return scene;
}

} // namespace

EnvironmentMap skyMap() {
    EnvironmentMap map{"sky", 16, 8, {}};
    for (std::uint32_t row = 0; row < map.height; ++row)
        for (std::uint32_t column = 0; column < map.width; ++column) {
            const float height = 1.0f - static_cast<float>(row) / 8.0f;
            const bool sun = row == 2 && column == 5;
            map.texels.push_back(sun ? Vec3f(60.0f, 50.0f, 40.0f) : Vec3f(0.2f, 0.3f, 0.6f) * height);
        }
    return map;
}

std::vector<SurfaceCase> surfaceCases() {
    std::vector<SurfaceCase> cases;
    addLobes(cases);
    addMaps(cases);
    addAlpha(cases);
    Builder sky{Material{}};
    sky.scene().environment.map = std::make_shared<EnvironmentMap>(skyMap());
    sky.scene().environment.rotation = -0.15;
    cases.push_back({"EnvironmentMap", sky.scene()});
    cases.push_back({"Everything", everything()});
    cases.push_back({"CulledBacks", backFaces(), BackFaces::culled});
    return cases;
}

Scene surfaceScene(const std::string& name) {
    for (const SurfaceCase& tested : surfaceCases())
        if (tested.name == name) return tested.scene;
    throw std::runtime_error("no surface case is called " + name);
}

} // namespace isolux::test
