#include "load/gltf.h"

#include "core/error.h"
#include "load/container.h"
#include "load/context.h"
#include "load/node_walker.h"
#include "load/texture_builder.h"
#include "load/verify.h"
#include "scene/textures.h"

#include <fmt/format.h>

#include <numeric>

namespace isolux {
namespace {

namespace fs = std::filesystem;

/// Light tables hold at most 2^28 lights; vertices are bounded so that a walk over all of them ends in seconds.
constexpr std::uint64_t kMostPrimitives = std::uint64_t{1} << 28;
constexpr std::uint64_t kMostVertices = std::uint64_t{1} << 30;
/// What the lengths in the header of a .glb can express.
constexpr std::uintmax_t kLargestFile = 0xFFFFFFFFu;
/// Squares of lengths must stay within single precision.
constexpr double kFarthest = 1e18;

/// The scene to render, if the file lists scenes: the default one, else the first.
const tinygltf::Scene* chosenScene(const tinygltf::Model& model) {
    if (model.scenes.empty()) return nullptr;
    return &model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))];
}

/// The roots of the chosen scene; without scenes all nodes without a parent.
std::vector<int> rootNodes(const tinygltf::Model& model) {
    if (const tinygltf::Scene* scene = chosenScene(model)) return scene->nodes;
    std::vector<char> isChild(model.nodes.size(), 0);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) isChild[static_cast<std::size_t>(child)] = 1;
    std::vector<int> roots;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        if (!isChild[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

std::string sceneName(const tinygltf::Model& model, const fs::path& file) {
    const tinygltf::Scene* scene = chosenScene(model);
    return scene != nullptr && !scene->name.empty() ? scene->name : file.stem().string();
}

/// The extra "cgl_hemisphere_light" of the chosen scene, a sky above y = 0.
Environment toEnvironment(const tinygltf::Model& model) {
    const tinygltf::Scene* scene = chosenScene(model);
    if (scene == nullptr || !scene->extras.Has("cgl_hemisphere_light")) return {};
    const tinygltf::Value& radiance = scene->extras.Get("cgl_hemisphere_light").Get("radiance");
    Environment environment;
    environment.extent = EnvironmentExtent::upperHalf;
    for (int channel = 0; channel < 3; ++channel)
        environment.radiance[channel] = radiance.Get(channel).GetNumberAsDouble();
    return environment;
}

void checkSize(const Scene& scene, const LoadContext& context) {
    std::uint64_t vertices = 0;
    for (const Instance& instance : scene.instances) vertices += scene.meshes[instance.mesh].positions.size();
    const std::uint64_t primitives = primitiveCount(scene);
    if (primitives > kMostPrimitives || vertices > kMostVertices)
        context.fail(
            "", fmt::format("its instances amount to {} primitives and {} vertices; at most {} and {} are supported",
                            primitives, vertices, kMostPrimitives, kMostVertices));
    Box3d bounds = worldBounds(scene);
    for (const Camera& camera : scene.cameras) bounds.extend(camera.position);
    for (const PunctualLight& light : scene.punctualLights) bounds.extend(light.position);
    const double farthest =
        bounds.empty() ? 0.0 : maxComponent(glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper)));
    if (!(farthest <= kFarthest))
        context.fail("", fmt::format("it reaches {:g} units from the origin; scale it down to at most {:g}", farthest,
                                     kFarthest));
}

/// All but textures: their images are read when it is known which are needed.
Scene buildScene(const Asset& asset, MaterialBuilder& materials, const fs::path& file, LoadContext& context) {
    Scene scene;
    scene.name = sceneName(asset.model, file);
    scene.environment = toEnvironment(asset.model);
    walkNodes(asset, rootNodes(asset.model), materials, context, scene);
    scene.materials = materials.materials();
    checkSize(scene, context);
    if (primitiveCount(scene) == 0 && !scene.environment.emits()) context.warn("", "the scene has nothing to render");
    if (scene.cameras.empty()) scene.cameras.push_back(frameScene(scene));
    return scene;
}

/// A normal map that is the same everywhere, and within what 8 bits can tell of straight up, says nothing: 8 bits have
/// no zero.
void removeFlatNormalMaps(Scene& scene) {
    for (Material& material : scene.materials) {
        TextureMap& map = material.maps[static_cast<std::size_t>(MapSlot::normal)];
        if (!map.present()) continue;
        const std::optional<glm::dvec4> value = constantValue(scene, map, MapSlot::normal);
        constexpr double kHalfStep = 0.5000001 / 255.0;
        if (value && std::abs(value->x - 0.5) <= kHalfStep && std::abs(value->y - 0.5) <= kHalfStep && value->z > 0.5)
            map = {};
    }
}

/// The scene's own checks know no file.
void requireValid(const Scene& scene, const LoadContext& context) {
    try {
        validate(scene);
    } catch (const Error& error) {
        context.fail("", error.what());
    }
}

} // namespace

Scene loadScene(const fs::path& file) {
    const LoadContext context(file.string());
    return loadSceneFromBytes(readRegularFile(file, {context, "", kLargestFile}), file);
}

Scene loadSceneFromBytes(ByteSpan bytes, const fs::path& file, const LoadLimits& limits) {
    LoadContext context(file.string(), limits);
    ContentHash hash;
    hash.add(bytes);
    const Container container = splitContainer(bytes, context);
    const nlohmann::json document = parseJson(container.json, context);
    const JsonReader root(document, "", context);
    const nlohmann::json verified = verifyDocument(root);
    MaterialBuilder materials(verifyMaterials(root));
    const std::vector<FileTexture> textures = verifyTextures(root);
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    Asset asset;
    asset.buffers = readBuffers(root, {folder, container.binary}, hash);
    const EncodedImages images = readImages(root, asset.buffers, folder, hash);
    asset.model = parseModel(verified, context);
    Scene scene = buildScene(asset, materials, file, context);
    buildTextures(scene, textures, images.images);
    removeFlatNormalMaps(scene);
    scene.warnings = context.warnings();
    scene.contentHash = hash.hexadecimal();
    requireValid(scene, context);
    return scene;
}

} // namespace isolux
