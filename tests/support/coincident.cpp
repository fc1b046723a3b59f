#include "support/coincident.h"

#include <glm/gtc/matrix_transform.hpp>

#include <utility>

namespace isolux::test {
namespace {

Mat4d askew() {
    const Mat4d moved = glm::translate(Mat4d(1.0), Vec3d(0.3, -0.7, 0.2));
    return glm::rotate(moved, 0.9, glm::normalize(Vec3d(0.3, 0.8, -0.5)));
}

/// [-1, 1]^2 times `size` at z = `height`, its front up; cut from corner to corner.
Mesh square(float size, float height, std::uint32_t material) {
    return {"square",
            {{-size, -size, height}, {size, -size, height}, {size, size, height}, {-size, size, height}},
            {},
            {{0, 1, 2}, {0, 2, 3}},
            material};
}

/// A camera over the origin of `world` that sees half of the square [-1, 1]^2 at z = 0, from a little aside.
Camera cameraAbove(const Mat4d& world) {
    Camera camera;
    camera.position = Vec3d(world * glm::dvec4(0.1, -0.05, 1.2, 1.0));
    camera.worldFromCamera = Mat3d(world);
    camera.yfov = 0.7;
    return camera;
}

class Builder {
public:
    Builder(const Mat4d& world, LitBy light) : world_(world) {
        scene_.name = "coincident";
        scene_.materials = {{"floor", kFloorAlbedo}, {"lamp", Vec3d(0.0), Vec3d(8.0), true}};
        scene_.cameras = {cameraAbove(world)};
        if (light == LitBy::environment) scene_.environment.radiance = Vec3d(1.0);
    }

    void add(Mesh mesh, Copies copies) {
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(copies); ++i)
            scene_.instances.push_back({mesh.name, static_cast<std::uint32_t>(scene_.meshes.size()), world_});
        scene_.meshes.push_back(std::move(mesh));
    }
    std::uint32_t material(Material material) {
        scene_.materials.push_back(std::move(material));
        return static_cast<std::uint32_t>(scene_.materials.size() - 1);
    }
    void light(LitBy light) {
        if (light == LitBy::lamp) add(square(0.3f, 1.7f, 1), Copies::one);
    }
    Scene take() { return std::move(scene_); }

private:
    Mat4d world_;
    Scene scene_;
};

Mesh slab(std::uint32_t material) {
    Mesh mesh;
    mesh.name = "slab";
    mesh.material = material;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back((i & 1) != 0 ? 0.4f : -0.4f, (i & 2) != 0 ? 0.4f : -0.4f,
                                    (i & 4) != 0 ? 0.5f : 0.2f);
    mesh.triangles = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

} // namespace

// What comes in one copy is first in scene order, so that lamps keep their places in it.

Scene floorScene(Copies copies, LitBy light, Lie lie) {
    Builder builder(lie == Lie::askew ? askew() : Mat4d(1.0), light);
    builder.light(light);
    builder.add(square(1.0f, 0.0f, 0), copies);
    return builder.take();
}

Scene tiledFloorScene(LitBy light) {
    Builder builder(Mat4d(1.0), light);
    builder.light(light);
    builder.add(square(1.0f, 0.0f, 0), Copies::one);
    Mesh tile = square(0.37f, 0.0f, 0);
    tile.triangles = {{3, 0, 1}, {3, 1, 2}};
    builder.add(std::move(tile), Copies::one);
    return builder.take();
}

Scene slabScene(Copies copies, LitBy light, double thickness) {
    Builder builder(askew(), light);
    builder.light(light);
    builder.add(square(1.0f, 0.0f, 0), Copies::one);
    Material glass;
    glass.name = "glass";
    glass.transmission = 1.0;
    glass.roughness = 0.0;
    glass.thickness = thickness;
    glass.attenuationColor = Vec3d(0.9, 0.6, 0.4);
    glass.attenuationDistance = 0.5;
    builder.add(slab(builder.material(glass)), copies);
    return builder.take();
}

} // namespace isolux::test
