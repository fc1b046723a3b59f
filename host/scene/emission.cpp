#include "scene/emission.h"

#include "scene/environment_table.h"
#include "scene/textures.h"

#include <algorithm>

namespace isolux {
namespace {

constexpr std::uint64_t kFewestLookups = 16; // a triangle
constexpr std::uint64_t kMostLookups = 1024;
constexpr std::uint64_t kAllLookups = std::uint64_t{1} << 24;

/// Area in texels of a triangle with these coordinates of the mesh.
double coveredTexels(const Scene& scene, const TextureMap& map, const std::array<Vec2d, 3>& uvs) {
    const TextureImage& image = scene.images[scene.textures[map.texture].image];
    const Vec2d a = map.uvFromMesh * (uvs[1] - uvs[0]);
    const Vec2d b = map.uvFromMesh * (uvs[2] - uvs[0]);
    return 0.5 * std::abs(a.x * b.y - a.y * b.x) * image.width * image.height;
}

/// A triangle is divided into n^2 alike; the least n for as many lookups as texels, within the limits.
int divisions(double texels, std::uint64_t mostLookups) {
    const double wanted = std::sqrt(std::clamp(texels, double(kFewestLookups), double(kMostLookups)));
    const double allowed = std::floor(std::sqrt(static_cast<double>(mostLookups)));
    // In this order, so that coordinates that are no numbers take the most.
    return static_cast<int>(std::min(allowed, std::ceil(wanted)));
}

} // namespace

MeanEmission::MeanEmission(const Scene& scene) : scene_(scene) {
    for (const Material& material : scene.materials) {
        Surface surface;
        if (material.emits()) surface.emission = material.emission;
        const TextureMap& map = material.map(MapSlot::emission);
        if (material.emits() && map.present()) {
            const std::optional<glm::dvec4> constant = constantValue(scene, map, MapSlot::emission);
            surface.varies = !constant;
            if (constant) surface.emission *= Vec3d(*constant);
        }
        surfaces_.push_back(surface);
    }
    std::uint64_t triangles = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (surfaces_[mesh.material].varies) triangles += mesh.triangles.size();
    }
    mostLookups_ = std::clamp(kAllLookups / std::max<std::uint64_t>(triangles, 1), kFewestLookups, kMostLookups);
}

Vec3d MeanEmission::ofTriangle(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) const {
    const Surface& surface = surfaces_[mesh.material];
    if (!surface.varies) return surface.emission;
    const TextureMap& map = scene_.materials[mesh.material].map(MapSlot::emission);
    std::array<Vec2d, 3> uvs;
    for (int i = 0; i < 3; ++i) uvs[i] = Vec2d(mesh.uvs[map.uvSet][triangle[i]]);
    return surface.emission * meanOfMap(map, uvs);
}

Vec3d MeanEmission::ofSphere(std::uint32_t material) const {
    const Surface& surface = surfaces_[material];
    if (!surface.varies) return surface.emission;
    const TextureMap& map = scene_.materials[material].map(MapSlot::emission);
    return surface.emission * Vec3d(nearestValue(scene_, map, MapSlot::emission, Vec2d(0.0)));
}

Vec3d MeanEmission::meanOfMap(const TextureMap& map, const std::array<Vec2d, 3>& uvs) const {
    const int n = divisions(coveredTexels(scene_, map, uvs), mostLookups_);
    const Vec2d a = (uvs[1] - uvs[0]) / static_cast<double>(n);
    const Vec2d b = (uvs[2] - uvs[0]) / static_cast<double>(n);
    Vec3d sum(0.0);
    const auto add = [&](double i, double j) {
        sum += Vec3d(nearestValue(scene_, map, MapSlot::emission, uvs[0] + i * a + j * b));
    };
    // At the centres of the parts: those that stand as the whole does, and those between them.
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
            add(i + 1.0 / 3.0, j + 1.0 / 3.0);
            if (i + j < n - 1) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
        }
    return sum / static_cast<double>(n * n);
}

double environmentFlux(const Environment& environment) {
    if (!environment.map) return environment.solidAngle() * luminance(environment.radiance);
    const EnvironmentMap& map = *environment.map;
    double flux = 0.0;
    for (std::uint32_t row = 0; row < map.height; ++row) {
        Vec3d sum(0.0);
        for (std::size_t i = 0; i < map.width; ++i) sum += Vec3d(map.texels[std::size_t{row} * map.width + i]);
        flux += cellSolidAngle(map, row) * luminance(environment.radiance * sum);
    }
    return flux;
}

} // namespace isolux
