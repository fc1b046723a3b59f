#include "stress/shapes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace isolux {

Mat4d translation(const Vec3d& offset) {
    Mat4d matrix(1.0);
    matrix[3] = glm::dvec4(offset, 1.0);
    return matrix;
}

Mat4d scaling(const Vec3d& factors) {
    Mat4d matrix(1.0);
    for (int axis = 0; axis < 3; ++axis) matrix[axis][axis] = factors[axis];
    return matrix;
}

std::uint32_t SceneBuilder::material(const Vec3d& baseColor, const Vec3d& emission, Faces emitting) {
    return material(Material{"", baseColor, emission, emitting == Faces::both});
}

std::uint32_t SceneBuilder::material(const Material& material) {
    scene.materials.push_back(material);
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void SceneBuilder::mesh(Mesh mesh, const Mat4d& worldFromObject) {
    scene.instances.push_back({"", static_cast<std::uint32_t>(scene.meshes.size()), worldFromObject});
    scene.meshes.push_back(std::move(mesh));
}

void SceneBuilder::camera(const Vec3d& position, const Vec3d& target, double yfov) {
    const Vec3d backward = glm::normalize(position - target);
    const Vec3d up = std::abs(backward.y) < 0.999 ? Vec3d(0.0, 1.0, 0.0) : Vec3d(0.0, 0.0, -1.0);
    const Vec3d right = glm::normalize(glm::cross(up, backward));
    Camera camera;
    camera.position = position;
    camera.worldFromCamera = Mat3d(right, glm::cross(backward, right), backward);
    camera.yfov = yfov;
    scene.cameras.push_back(camera);
}

Mesh triangleMesh(const Vec3f& a, const Vec3f& b, const Vec3f& c, std::uint32_t material) {
    return {"", {a, b, c}, {}, {{0, 1, 2}}, material};
}

Mesh squareMesh(std::uint32_t material) {
    return {"", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}, material};
}

Mesh roomMesh(std::uint32_t material) {
    Mesh mesh;
    mesh.material = material;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.emplace_back(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    mesh.triangles = {{0, 6, 4}, {0, 2, 6}, {1, 7, 3}, {1, 5, 7}, {0, 5, 1}, {0, 4, 5},
                      {2, 7, 6}, {2, 3, 7}, {0, 3, 2}, {0, 1, 3}, {4, 7, 5}, {4, 6, 7}};
    return mesh;
}

Mesh blockMesh(std::uint32_t material) {
    Mesh mesh = roomMesh(material);
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    return mesh;
}

Mesh icosahedron() {
    const float g = (1.0f + std::sqrt(5.0f)) / 2.0f;
    Mesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return mesh;
}

Mesh subdivided(const Mesh& mesh) {
    Mesh finer;
    finer.positions = mesh.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, added] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(finer.positions.size()));
        if (added) finer.positions.push_back((finer.positions[a] + finer.positions[b]) * 0.5f);
        return entry->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const std::array<std::uint32_t, 3>& triangle :
             {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
            finer.triangles.push_back(triangle);
    }
    return finer;
}

Mesh icosphere(int levels, float radius) {
    Mesh mesh = icosahedron();
    for (int level = 0; level < levels; ++level) mesh = subdivided(mesh);
    for (Vec3f& position : mesh.positions) position = glm::normalize(position) * radius;
    return mesh;
}

RenderSettings stressSettings(std::uint32_t size, std::uint32_t samples) {
    RenderSettings settings;
    settings.width = size;
    settings.height = size;
    settings.sampleCount = samples;
    settings.seed = 1;
    return settings;
}

Scene cornellBox() {
    SceneBuilder builder;
    const std::uint32_t white = builder.material(Vec3d(0.73), Vec3d(0.0), Faces::front);
    const std::uint32_t red = builder.material({0.63, 0.065, 0.05}, Vec3d(0.0), Faces::front);
    const std::uint32_t green = builder.material({0.14, 0.45, 0.091}, Vec3d(0.0), Faces::front);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), {17.0, 12.0, 4.0}, Faces::front);
    const auto turned = [](double angle, const Vec3d& axis) { return glm::rotate(Mat4d(1.0), angle, axis); };
    const Vec3d x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0);
    builder.mesh(squareMesh(white), translation({0.0, -1.0, 0.0}) * turned(-0.5 * kPi, x));
    builder.mesh(squareMesh(white), translation({0.0, 1.0, 0.0}) * turned(0.5 * kPi, x));
    builder.mesh(squareMesh(white), translation({0.0, 0.0, -1.0}));
    builder.mesh(squareMesh(red), translation({-1.0, 0.0, 0.0}) * turned(0.5 * kPi, y));
    builder.mesh(squareMesh(green), translation({1.0, 0.0, 0.0}) * turned(-0.5 * kPi, y));
    builder.mesh(squareMesh(lamp), translation({0.0, 0.99, 0.0}) * turned(0.5 * kPi, x) * scaling({0.25, 0.2, 1.0}));
    builder.mesh(blockMesh(white), translation({-0.35, -0.4, -0.3}) * turned(0.3, y) * scaling({0.3, 0.6, 0.3}));
    builder.mesh(blockMesh(white), translation({0.33, -0.7, 0.35}) * turned(-0.28, y) * scaling(Vec3d(0.3)));
    builder.camera({0.0, 0.0, 4.9}, Vec3d(0.0), 0.5);
    return builder.scene;
}

Scene scaled(Scene scene, double factor) {
    const Mat4d scaling = isolux::scaling(Vec3d(factor));
    for (Instance& instance : scene.instances) instance.worldFromObject = scaling * instance.worldFromObject;
    for (Sphere& sphere : scene.spheres) {
        sphere.center *= factor;
        sphere.radius *= factor;
    }
    for (Camera& camera : scene.cameras) {
        camera.position *= factor;
        camera.ymag *= factor;
    }
    for (PunctualLight& light : scene.punctualLights) {
        light.position *= factor;
        if (light.kind != PunctualKind::directional) light.intensity *= factor * factor;
    }
    for (Material& material : scene.materials) {
        material.attenuationDistance *= factor;
        material.thickness *= factor;
    }
    return scene;
}

} // namespace isolux
