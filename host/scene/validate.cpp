// What both renderers rely on in a scene, checked once.
#include "core/error.h"
#include "scene/scene.h"

#include <fmt/format.h>

namespace isolux {
namespace {

constexpr double kLargest = 1e30; // coordinates

bool inUnitRange(double number) { return number >= 0.0 && number <= 1.0; } // NaN is not

bool inUnitRange(const Vec3d& v) { return inUnitRange(v.x) && inUnitRange(v.y) && inUnitRange(v.z); }

bool notNegative(const Vec3d& v) { return v.x >= 0.0 && v.y >= 0.0 && v.z >= 0.0; }

void validateImage(const TextureImage& image) {
    const std::string where = fmt::format("image '{}'", image.name);
    if (image.width == 0 || image.height == 0) throwBadInput(where, "it has no pixels");
    if (image.texels8.empty() == image.texels16.empty())
        throwBadInput(where, "its texels must have either 8 or 16 bits a channel");
    const std::uint64_t count = std::uint64_t{image.width} * image.height;
    const std::size_t texels = std::max(image.texels8.size(), image.texels16.size());
    if (texels != count)
        throwBadInput(where, fmt::format("{} x {} pixels have {} texels", image.width, image.height, texels));
}

void validateTextures(const Scene& scene) {
    for (const TextureImage& image : scene.images) validateImage(image);
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        if (scene.textures[i].image >= scene.images.size())
            throwBadInput(fmt::format("texture {}", i), "its image does not exist");
}

void validateMap(const TextureMap& map, const std::string& where, std::size_t textureCount) {
    if (!map.present()) return;
    if (map.texture >= textureCount) throwBadInput(where, fmt::format("its texture {} does not exist", map.texture));
    bool finite = std::isfinite(map.offset.x) && std::isfinite(map.offset.y);
    for (int column = 0; column < 2; ++column)
        for (int row = 0; row < 2; ++row) finite = finite && std::isfinite(map.uvFromMesh[column][row]);
    if (!finite) throwBadInput(where, "the transform of its texture coordinates is not finite");
}

void validateFactors(const Material& material, const std::string& where) {
    const auto require = [&](bool holds, const char* message) {
        if (!holds) throwBadInput(where, message);
    };
    require(inUnitRange(material.metallic), "metallic must lie in [0, 1]");
    require(inUnitRange(material.roughness), "roughness must lie in [0, 1]");
    require(inUnitRange(material.specular), "specular must lie in [0, 1]");
    require(inUnitRange(material.transmission), "transmission must lie in [0, 1]");
    require(inUnitRange(material.alpha), "alpha must lie in [0, 1]");
    require(inUnitRange(material.attenuationColor), "the attenuation colour must lie in [0, 1]");
    require(notNegative(material.specularColor), "the specular colour must not be negative");
    require(material.ior >= 1.0, "the index of refraction must be at least 1");
    require(material.thickness >= 0.0, "thickness must not be negative");
    require(material.attenuationDistance > 0.0, "the attenuation distance must be positive"); // it may be infinite
    require(material.alphaCutoff >= 0.0, "the alpha cutoff must not be negative");
    require(std::abs(material.normalScale) <= kLargestNormalScale, "the scale of the normal map is too large");
}

bool hasFiniteFactors(const Material& material) {
    return isFinite(material.baseColor) && isFinite(material.emission) && isFinite(material.specularColor) &&
           std::isfinite(material.ior) && std::isfinite(material.thickness) && std::isfinite(material.alphaCutoff) &&
           std::isfinite(material.normalScale);
}

void validateMaterial(const Material& material, std::size_t textureCount) {
    const std::string where = fmt::format("material '{}'", material.name);
    if (!hasFiniteFactors(material)) throwBadInput(where, "a factor is not finite");
    if (!inUnitRange(material.baseColor)) throwBadInput(where, "base colour must lie in [0, 1]");
    if (!notNegative(material.emission)) throwBadInput(where, "emission must not be negative");
    validateFactors(material, where);
    for (const TextureMap& map : material.maps) validateMap(map, where, textureCount);
}

/// An attribute has one entry a position, or none.
template <typename Attribute>
void validateCount(const Mesh& mesh, const std::vector<Attribute>& attribute, const char* name) {
    if (!attribute.empty() && attribute.size() != mesh.positions.size())
        throwBadInput(fmt::format("mesh '{}'", mesh.name),
                      fmt::format("it has another number of {} than positions", name));
}

void validateColors(const Mesh& mesh, const std::string& where) {
    validateCount(mesh, mesh.colors, "colours");
    for (std::size_t i = 0; i < mesh.colors.size(); ++i)
        if (!inUnitRange(Vec3d(mesh.colors[i])) || !inUnitRange(mesh.colors[i].w))
            throwBadInput(where, fmt::format("colour {} must lie in [0, 1]", i));
}

void validateTangents(const Mesh& mesh, const std::string& where) {
    validateCount(mesh, mesh.tangents, "tangents");
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i)
        if (!isFinite(Vec3f(mesh.tangents[i])) || std::abs(mesh.tangents[i].w) != 1.0f)
            throwBadInput(where, fmt::format("tangent {} is not finite or its sign is not 1 or -1", i));
}

/// What the maps of its material need of a mesh.
void validateMapped(const Mesh& mesh, const Material& material, const std::string& where) {
    if (mesh.triangles.empty()) return;
    for (const TextureMap& map : material.maps)
        if (map.present() && (map.uvSet >= mesh.uvs.size() || mesh.uvs[map.uvSet].empty()))
            throwBadInput(where, fmt::format("it has no texture coordinates {}, which material '{}' needs", map.uvSet,
                                             material.name));
    if (material.map(MapSlot::normal).present() && mesh.tangents.empty())
        throwBadInput(where,
                      fmt::format("it has no tangents, which the normal map of material '{}' needs", material.name));
}

void validateMesh(const Mesh& mesh, const std::vector<Material>& materials) {
    const std::string where = fmt::format("mesh '{}'", mesh.name);
    if (mesh.material >= materials.size()) throwBadInput(where, "its material does not exist");
    validateCount(mesh, mesh.normals, "normals");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (!isFinite(mesh.positions[i])) throwBadInput(where, fmt::format("position {} is not finite", i));
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t index : triangle)
            if (index >= mesh.positions.size()) throwBadInput(where, fmt::format("index {} is out of range", index));
    for (const auto& uvs : mesh.uvs) validateCount(mesh, uvs, "texture coordinates");
    validateColors(mesh, where);
    validateTangents(mesh, where);
    validateMapped(mesh, materials[mesh.material], where);
}

void validateCamera(const Camera& camera) {
    const std::string where = fmt::format("camera '{}'", camera.name);
    const bool finite = isFinite(camera.position) && std::isfinite(camera.yfov) && std::isfinite(camera.ymag);
    if (!finite) throwBadInput(where, "a number is not finite");
    if (camera.projection == Projection::perspective && !(camera.yfov > 0.0 && camera.yfov < kPi))
        throwBadInput(where, "its field of view must lie between 0 and 180 degrees");
    if (camera.projection == Projection::orthographic && !(camera.ymag > 0.0))
        throwBadInput(where, "its magnification must be positive");
}

void validatePunctualLight(const PunctualLight& light) {
    const std::string where = fmt::format("light '{}'", light.name);
    const bool finite = isFinite(light.position) && isFinite(light.direction) && isFinite(light.intensity);
    if (!finite) throwBadInput(where, "a number is not finite");
    if (maxComponent(glm::abs(light.position)) > kLargest) throwBadInput(where, "its position is beyond 1e30");
    if (glm::any(glm::lessThan(light.intensity, Vec3d(0.0)))) throwBadInput(where, "intensity must not be negative");
    if (!(std::abs(glm::length(light.direction) - 1.0) < 1e-6)) throwBadInput(where, "its direction has no length");
    const bool cones = light.cosOuter >= -1.0 && light.cosOuter < light.cosInner && light.cosInner <= 1.0;
    if (light.kind == PunctualKind::spot && !cones)
        throwBadInput(where, "its inner cone must be narrower than its outer one");
}

void validateEnvironmentMap(const EnvironmentMap& map) {
    const std::string where = fmt::format("environment map '{}'", map.name);
    if (map.width == 0 || map.height == 0) throwBadInput(where, "it has no pixels");
    if (map.texels.size() != std::uint64_t{map.width} * map.height)
        throwBadInput(where, fmt::format("{} x {} pixels have {} texels", map.width, map.height, map.texels.size()));
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        if (!isFinite(map.texels[i]) || !notNegative(Vec3d(map.texels[i])))
            throwBadInput(where, fmt::format("the texel at column {}, row {} is negative or not finite", i % map.width,
                                             i / map.width));
}

void validateEnvironment(const Environment& environment) {
    if (!isFinite(environment.radiance)) throwBadInput("environment", "its radiance is not finite");
    if (!notNegative(environment.radiance)) throwBadInput("environment", "its radiance must not be negative");
    if (!std::isfinite(environment.rotation)) throwBadInput("environment", "its rotation is not finite");
    if (!environment.map) return;
    if (environment.extent == EnvironmentExtent::upperHalf)
        throwBadInput("environment", "a map covers the whole sphere, not its upper half");
    validateEnvironmentMap(*environment.map);
}

/// What both renderers may compute with: squares and areas stay far inside double's range.
void validateBounds(const Scene& scene) {
    constexpr double kSmallest = 1e-30;
    const Box3d bounds = worldBounds(scene);
    if (primitiveCount(scene) == 0) return;
    const Vec3d farthest = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
    // Written so that NaN fails: a transform may overflow though its entries and the positions are finite.
    if (!(maxComponent(farthest) <= kLargest))
        throwBadInput("scene", "a transformed position is beyond 1e30 or not finite");
    const double extent = maxComponent(bounds.extent());
    if (extent != 0.0 && !(extent >= kSmallest)) throwBadInput("scene", "it is smaller than 1e-30; scale it up");
}

void validatePlacements(const Scene& scene) {
    for (const Instance& instance : scene.instances) {
        if (instance.mesh >= scene.meshes.size())
            throwBadInput(fmt::format("node '{}'", instance.name), "its mesh does not exist");
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                if (!std::isfinite(instance.worldFromObject[column][row]))
                    throwBadInput(fmt::format("node '{}'", instance.name), "its transform is not finite");
    }
    for (const Sphere& sphere : scene.spheres) {
        const std::string where = fmt::format("sphere '{}'", sphere.name);
        if (sphere.material >= scene.materials.size()) throwBadInput(where, "its material does not exist");
        if (!isFinite(sphere.center) || !std::isfinite(sphere.radius) || sphere.radius <= 0.0)
            throwBadInput(where, "its centre must be finite and its radius positive");
    }
}

} // namespace

void validate(const Scene& scene) {
    validateTextures(scene);
    for (const Material& material : scene.materials) validateMaterial(material, scene.textures.size());
    for (const Mesh& mesh : scene.meshes) validateMesh(mesh, scene.materials);
    validatePlacements(scene);
    for (const Camera& camera : scene.cameras) validateCamera(camera);
    for (const PunctualLight& light : scene.punctualLights) validatePunctualLight(light);
    validateEnvironment(scene.environment);
    validateBounds(scene);
}

} // namespace isolux
