#include "pack/packed_scene.h"

#include "accel/wide_bvh.h"
#include "core/error.h"
#include "pack/effective_materials.h"
#include "pack/packed_attributes.h"
#include "pack/unit_scale.h"
#include "scene/lights.h"
#include "scene/pixel_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace isolux {
namespace {

float asFloat(std::uint32_t bits) { return std::bit_cast<float>(bits); }

glm::vec4 word(const Vec3f& xyz, float w) { return {xyz, w}; }

/// The primitives in scene order with the boxes the BVH is built over.
struct Primitives {
    std::vector<shared::PrimitiveRecord> records;
    std::vector<Box3f> boxes;
};

class Packer {
public:
    Packer(const Scene& scene, const RenderSettings& settings, const SceneFeatures& features)
        : scene_(scene), settings_(settings), features_(features), materials_(effectiveMaterials(scene)),
          lights_(buildLightTable(scene, settings)) {
        packed_.space = chooseSpace(scene, settings);
        const double texel = scene.environment.map ? brightestTexel(*scene.environment.map) : 1.0;
        texelScale_ = scene.environment.map ? unitScale(texel) : 1.0;
        packed_.radianceScale = unitScale(typicalLight(texel));
    }

    PackedScene pack() {
        const std::size_t count = primitiveCount(scene_);
        if (count >= WideChild::kMaxFirst)
            throwBadInput(scene_.name, fmt::format("{} primitives are more than the {} this version can index", count,
                                                   WideChild::kMaxFirst - 1));
        for (const Instance& instance : scene_.instances) addInstance(instance);
        for (const Sphere& sphere : scene_.spheres) addSphere(sphere);
        const std::vector<std::uint32_t> order = arrange();
        packed_.primitives.reserve(order.size());
        for (const std::uint32_t id : order) packed_.primitives.push_back(primitives_.records[id]);
        addTables(order);
        return std::move(packed_);
    }

private:
    /// Between the brightest and the dimmest light, in logarithms: what either sends must stay in range. The brightest
    /// is at most kHeadroom above, so that its square has room to be summed.
    [[nodiscard]] double typicalLight(double environmentTexel) const {
        constexpr double kHeadroom = 0x1p30;
        double brightest = 0.0;
        double dimmest = std::numeric_limits<double>::infinity();
        const auto note = [&](double light) {
            if (!(light > 0.0)) return;
            brightest = std::max(brightest, light);
            dimmest = std::min(dimmest, light);
        };
        note(maxComponent(scene_.environment.radiance) * environmentTexel);
        for (const Material& material : materials_)
            note(maxComponent(material.unlit ? material.baseColor : material.emission));
        for (const PunctualLight& light : scene_.punctualLights)
            note(maxComponent(light.intensity) * intensityUnit(light));
        return brightest == 0.0 ? 0.0 : std::max(brightest / kHeadroom, std::sqrt(brightest) * std::sqrt(dimmest));
    }

    /// What a point sends falls off with the square of the distance, which device space measures in its own unit.
    [[nodiscard]] double intensityUnit(const PunctualLight& light) const {
        return light.kind == PunctualKind::directional ? 1.0 : packed_.space.scale * packed_.space.scale;
    }

    void addInstance(const Instance& instance) {
        beginObject();
        const std::uint32_t material = scene_.meshes[instance.mesh].material;
        for (const TriangleCorners& corners : deviceTriangles(scene_, instance, packed_.space))
            addTriangle(corners, material);
    }

    void beginObject() { packed_.firstOfObject.push_back(static_cast<std::uint32_t>(primitives_.records.size())); }

    void addTriangle(const TriangleCorners& p, std::uint32_t material) {
        const auto id = static_cast<std::uint32_t>(primitives_.records.size());
        primitives_.records.push_back({word(p[0], asFloat(material)), word(p[1], asFloat(lights_.lightOf[id])),
                                       word(p[2], asFloat(id | surfaceBits(material)))});
        Box3f box;
        for (const Vec3f& vertex : p) box.extend(vertex);
        primitives_.boxes.push_back(box);
    }

    /// What rays that meet a primitive must ask: whether the surface is there, and whether its back is. The latter of
    /// the material as the scene has it: a map that lets nothing through gives no back to cull.
    [[nodiscard]] std::uint32_t surfaceBits(std::uint32_t material) const {
        const bool covers = materials_[material].alphaMode == AlphaMode::opaque;
        const bool culled = settings_.backFaces == BackFaces::culled && scene_.materials[material].isSingleSided();
        return (covers ? 0u : shared::kAlphaBit) | (culled ? shared::kCulledBackBit : 0u);
    }

    void addSphere(const Sphere& sphere) {
        const auto id = static_cast<std::uint32_t>(primitives_.records.size());
        beginObject();
        const Vec3f center(packed_.space.fromWorld(sphere.center));
        const auto radius = static_cast<float>(sphere.radius * packed_.space.scale);
        primitives_.records.push_back(
            {word(center, asFloat(sphere.material)), word({radius, 0.0f, 0.0f}, asFloat(lights_.lightOf[id])),
             word(Vec3f(0.0f), asFloat(id | shared::kSphereBit | surfaceBits(sphere.material)))});
        Box3f box;
        for (int axis = 0; axis < 3; ++axis) {
            box.lower[axis] = std::nextafter(center[axis] - radius, -std::numeric_limits<float>::infinity());
            box.upper[axis] = std::nextafter(center[axis] + radius, std::numeric_limits<float>::infinity());
        }
        primitives_.boxes.push_back(box);
    }

    /// The primitives in the order in which they are packed: that of the BVH's leaves, or of the scene without one.
    std::vector<std::uint32_t> arrange() {
        const IntersectionMethod& method = settings_.intersection;
        if (method.acceleration == Acceleration::none) {
            std::vector<std::uint32_t> order(primitives_.records.size());
            std::iota(order.begin(), order.end(), 0u);
            return order;
        }
        BvhOptions options;
        options.split = method.acceleration == Acceleration::meanSplit ? SplitMethod::mean : SplitMethod::surfaceArea;
        options.maxLeafSize = method.maxLeafSize;
        const Bvh bvh = buildBvh(primitives_.boxes, options);
        packed_.bvh = statistics(bvh);
        const WideBvh wide = buildWideBvh(bvh);
        addNodes(wide);
        return wide.primitives;
    }

    void addNodes(const WideBvh& wide) {
        // A constant of the kernel: in steps of 8, so that scenes share kernels.
        packed_.stackBound = (wide.stackBound + 7) / 8 * 8;
        packed_.nodes.reserve(wide.nodes.size());
        const auto pack4 = [](const std::array<std::uint8_t, 4>& q) {
            return std::uint32_t{q[0]} | std::uint32_t{q[1]} << 8 | std::uint32_t{q[2]} << 16 |
                   std::uint32_t{q[3]} << 24;
        };
        for (const WideNode& node : wide.nodes) {
            std::uint32_t exponents = 0;
            for (std::size_t axis = 0; axis < 3; ++axis)
                exponents |= static_cast<std::uint32_t>(node.exponent[axis] + 127) << (8 * axis);
            packed_.nodes.push_back(
                {word(node.origin, asFloat(exponents)),
                 {pack4(node.lower[0]), pack4(node.lower[1]), pack4(node.lower[2]), pack4(node.upper[0])},
                 {pack4(node.upper[1]), pack4(node.upper[2]), 0, 0},
                 {node.children[0].bits(), node.children[1].bits(), node.children[2].bits(), node.children[3].bits()}});
        }
    }

    void addTables(const std::vector<std::uint32_t>& order) {
        packed_.materialCount = static_cast<std::uint32_t>(scene_.materials.size());
        const MaterialPacker materials(scene_, materials_, {packed_.space.scale, packed_.radianceScale});
        materials.appendMaterials(tables_);
        packed_.lightCount = static_cast<std::uint32_t>(lights_.lights.size());
        packed_.lightOffset = tables_.next();
        std::vector<std::uint32_t> indexOfId(order.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) indexOfId[order[i]] = i;
        for (std::uint32_t light = 0; light < packed_.lightCount; ++light)
            tables_.append(lightRecord(light, indexOfId));
        if (lights_.environment != kNoLight)
            packed_.environmentPdf = lights_.samplesOf[lights_.environment] /
                                     (scene_.environment.map ? 1.0 : scene_.environment.solidAngle());
        packed_.lightSamples = lights_.sampleCount;
        packed_.samplesPerArea = lights_.samplesPerArea;
        packed_.areaLights = lights_.areaCount;
        packed_.punctualLights = lights_.punctualCount;
        packed_.lightBits = lights_.choice.bits;
        packed_.binOffset = tables_.next();
        for (const AliasTable::Bin& bin : lights_.choice.bins)
            tables_.append(shared::LightBinRecord{{bin.threshold, bin.alias, 0, 0}});
        packed_.filterOffset = tables_.next();
        if (settings_.filter.kind != PixelFilter::box) addFilter();
        packed_.textures = materials.appendTextures(tables_);
        if (features_.environmentMap && scene_.environment.map)
            packed_.environment = appendEnvironment(tables_, *scene_.environment.map, texelScale_);
        packed_.tables = tables_.take();
        PackedAttributes attributes = packAttributes(
            scene_, {features_.smoothNormals, features_.normalMaps, features_.vertexColors, materials.uvSets()}, order);
        packed_.attributes = std::move(attributes.words);
        packed_.attributeOffsets = attributes.offsets;
    }

    void addFilter() {
        const FilterTable table = buildFilterTable(settings_.filter);
        const auto& q = table.quantiles;
        for (std::size_t cell = 0; cell < kFilterCells; cell += 2)
            tables_.append(shared::FilterCellsRecord{{q[cell], q[cell + 1], q[cell + 1], q[cell + 2]}});
    }

    shared::LightRecord lightRecord(std::uint32_t light, const std::vector<std::uint32_t>& indexOfId) const {
        const Light& source = lights_.lights[light];
        shared::LightRecord record = source.kind == LightKind::area       ? areaLight(source.index, indexOfId)
                                     : source.kind == LightKind::punctual ? punctualLight(source.index)
                                                                          : environmentLight();
        record.p1Samples.w = static_cast<float>(lights_.samplesOf[light]);
        return record;
    }

    shared::LightRecord areaLight(std::uint32_t id, const std::vector<std::uint32_t>& indexOfId) const {
        const shared::PrimitiveRecord& primitive = primitives_.records[id];
        const bool sphere = (std::bit_cast<std::uint32_t>(primitive.p2Id.w) & shared::kSphereBit) != 0;
        const Vec3d p0(primitive.p0Material);
        const Vec3d p1(primitive.p1Light);
        const Vec3d p2(primitive.p2Id);
        const double area = sphere ? 0.0 : 0.5 * glm::length(glm::cross(p1 - p0, p2 - p0));
        const Material& material = materials_[std::bit_cast<std::uint32_t>(primitive.p0Material.w)];
        const bool covers = material.alphaMode == AlphaMode::opaque;
        const std::uint32_t kind = (sphere ? shared::kLightSphere : shared::kLightTriangle) |
                                   (material.doubleSided ? shared::kLightTwoSidedBit : 0u) |
                                   (material.map(MapSlot::emission).present() ? shared::kLightMappedBit : 0u) |
                                   (covers ? 0u : shared::kLightCoverageBit);
        return {word(Vec3f(p0), asFloat(indexOfId[id])), word(Vec3f(p1), 0.0f),
                word(Vec3f(p2), static_cast<float>(area)), word(radiance(material.emission), asFloat(kind))};
    }

    shared::LightRecord punctualLight(std::uint32_t index) const {
        const PunctualLight& light = scene_.punctualLights[index];
        const bool directional = light.kind == PunctualKind::directional;
        const std::uint32_t kind = directional                        ? shared::kLightDirectional
                                   : light.kind == PunctualKind::spot ? shared::kLightSpot
                                                                      : shared::kLightPoint;
        const Vec3f sent = radiance(light.intensity * intensityUnit(light));
        const Vec3f position(directional ? Vec3d(0.0) : packed_.space.fromWorld(light.position));
        constexpr float kFarthestLight = 1e18f; // its square must stay in single precision's range
        if (!isFinite(sent) || !(maxComponent(glm::abs(position)) < kFarthestLight) ||
            (luminance(sent) == 0.0f && luminance(light.intensity) > 0.0))
            throwBadInput(fmt::format("light '{}'", light.name),
                          "single precision cannot hold its intensity or position in a scene of this size; use "
                          "--backend reference");
        return {word(position, asFloat(shared::kNone)),
                word(Vec3f(light.direction), 0.0f),
                {static_cast<float>(1.0 - light.cosOuter), static_cast<float>(1.0 / (light.cosInner - light.cosOuter)),
                 0.0f, 0.0f},
                word(sent, asFloat(kind))};
    }

    shared::LightRecord environmentLight() const {
        const float range = scene_.environment.extent == EnvironmentExtent::sphere ? 2.0f : 1.0f;
        return {word(Vec3f(0.0f), asFloat(shared::kNone)),
                glm::vec4(0.0f),
                {range, 0.0f, 0.0f, 0.0f},
                word(radiance(scene_.environment.radiance / texelScale_), asFloat(shared::kLightEnvironment))};
    }

    [[nodiscard]] Vec3f radiance(const Vec3d& inWorld) const { return Vec3f(inWorld * packed_.radianceScale); }

    const Scene& scene_;
    const RenderSettings& settings_;
    const SceneFeatures& features_;
    std::vector<Material> materials_; ///< the effective ones
    LightTable lights_;
    double texelScale_ = 1.0; ///< of the environment map
    Primitives primitives_;
    Tables tables_;
    PackedScene packed_;
};

struct DeviceLens {
    float radius = 0.0f;
    float inverseFocus = 0.0f;
};

DeviceLens packLens(const DeviceSpace& space, const ThinLens& lens) {
    if (lens.isPinhole()) return {};
    constexpr double kLargest = 1e18; // its square must stay in single precision's range
    const double radius = 0.5 * lens.aperture * space.scale;
    const double inverseFocus = 1.0 / (lens.focus * space.scale);
    if (!(std::max({radius, inverseFocus, radius * inverseFocus}) < kLargest))
        throwBadInput("--aperture", "single precision cannot hold the lens or its focus in a scene of this size; use "
                                    "--backend reference");
    return {static_cast<float>(radius), static_cast<float>(inverseFocus)};
}

/// RenderParameters::methods, lengths in device space.
glm::vec4 packMethods(const DeviceSpace& space, const RenderSettings& settings) {
    constexpr double kLargest = std::numeric_limits<float>::max(); // stands for "endless" on the device
    const DeviceLens lens = packLens(space, settings.lens);
    return {lens.radius, lens.inverseFocus, static_cast<float>(1.0 - settings.roulette.termination),
            static_cast<float>(std::min(settings.ambientDistance * space.scale, kLargest))};
}

} // namespace

PackedScene packScene(const Scene& scene, const RenderSettings& settings, const SceneFeatures& features) {
    return Packer(scene, settings, features).pack();
}

shared::RenderParameters packParameters(const PackedScene& packed, const Scene& scene, const RenderSettings& settings) {
    if (settings.camera >= scene.cameras.size())
        throwBadInput(scene.name, fmt::format("it has no camera {}", settings.camera));
    const Camera& camera = scene.cameras[settings.camera];
    const bool orthographic = camera.projection == Projection::orthographic;
    const double halfHeight = orthographic ? camera.ymag * packed.space.scale : std::tan(0.5 * camera.yfov);
    const double aspect = static_cast<double>(settings.width) / static_cast<double>(settings.height);
    shared::RenderParameters parameters{};
    const Vec3d forward = -camera.worldFromCamera[2];
    const double start = startDistance(scene, camera, packed.space);
    parameters.cameraPosition =
        word(Vec3f(packed.space.fromWorld(camera.position) + forward * start), orthographic ? 1.0f : 0.0f);
    parameters.cameraRight = word(Vec3f(camera.worldFromCamera[0] * (halfHeight * aspect)), 0.0f);
    parameters.cameraUp = word(Vec3f(camera.worldFromCamera[1] * halfHeight), 0.0f);
    parameters.cameraForward = word(Vec3f(forward), static_cast<float>(start));
    parameters.lensRight = word(Vec3f(camera.worldFromCamera[0]), 0.0f);
    parameters.lensUp = word(Vec3f(camera.worldFromCamera[1]), 0.0f);
    parameters.methods = packMethods(packed.space, settings);
    const Environment& environment = scene.environment;
    parameters.environment = word(Vec3f(environment.radiance * (packed.radianceScale / packed.environment.texelScale)),
                                  static_cast<float>(packed.environmentPdf));
    parameters.environmentLimits.x = environment.extent == EnvironmentExtent::sphere ? -2.0f : 0.0f;
    parameters.environmentLimits.y = static_cast<float>(environment.rotation - std::floor(environment.rotation));
    parameters.environmentLimits.z = static_cast<float>(packed.radianceScale);
    const PackedEnvironment& map = packed.environment;
    parameters.environmentMap = {map.texels, map.bins, map.width, map.height};
    parameters.imageSeed = {settings.width, settings.height, static_cast<std::uint32_t>(settings.seed),
                            static_cast<std::uint32_t>(settings.seed >> 32)};
    const BounceRange bounces = countedBounces(settings);
    parameters.depthLights = {bounces.last, settings.roulette.start, packed.lightBits, packed.lightCount};
    parameters.lightSamples = {packed.lightSamples, packed.samplesPerArea, packed.areaLights, packed.punctualLights};
    parameters.tableOffsets = {0, packed.lightOffset, packed.binOffset, packed.filterOffset};
    parameters.sceneCounts = {static_cast<std::uint32_t>(packed.nodes.size()),
                              static_cast<std::uint32_t>(packed.primitives.size()), packed.materialCount, 0};
    parameters.textureOffsets = {packed.textures.records, packed.textures.srgb8, packed.textures.srgb16,
                                 packed.textures.albedos};
    parameters.attributeOffsets = packed.attributeOffsets;
    parameters.sampling = {bounces.first, cellBitsOf(settings), map.bits, 0};
    return parameters;
}

} // namespace isolux
