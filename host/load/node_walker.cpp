#include "load/node_walker.h"

#include "load/context.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

namespace isolux {
namespace {

constexpr std::size_t kDeepestNode = 1024;
constexpr const char* kLights = "KHR_lights_punctual";

Vec3d toVec3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

Mat4d localTransform(const tinygltf::Node& node) {
    Mat4d matrix(1.0);
    if (node.matrix.size() == 16) {
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
        return matrix;
    }
    if (const auto& r = node.rotation; r.size() == 4)
        matrix = Mat4d(glm::mat3_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2]))));
    for (int axis = 0; axis < 3; ++axis)
        if (node.scale.size() == 3) matrix[axis] *= node.scale[static_cast<std::size_t>(axis)];
    if (node.translation.size() == 3) matrix[3] = glm::dvec4(toVec3(node.translation), 1.0);
    return matrix;
}

bool isFiniteMatrix(const Mat4d& matrix) {
    for (int column = 0; column < 4; ++column)
        if (!isFinite(Vec3d(matrix[column]))) return false;
    return true;
}

/// A unit vector without overflow or underflow on the way; zero if `v` is zero.
Vec3d direction(const Vec3d& v) {
    const double largest = maxComponent(glm::abs(v));
    return largest > 0.0 ? glm::normalize(v / largest) : Vec3d(0.0);
}

/// The factor by which a transform scales every length, if it is the same in all directions.
std::optional<double> uniformScale(const Mat3d& m) {
    constexpr double kTolerance = 1e-5;
    const double scale = std::cbrt(std::abs(glm::determinant(m)));
    if (!(scale > 0.0)) return std::nullopt;
    const Mat3d gram = glm::transpose(m / scale) * (m / scale);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(gram[column][row] - (row == column ? 1.0 : 0.0)) <= 2.0 * kTolerance)) return std::nullopt;
    return scale;
}

/// What of a camera does not depend on where it stands.
Camera toCamera(const tinygltf::Camera& source) {
    Camera camera;
    camera.name = source.name;
    if (source.type == "orthographic") {
        camera.projection = Projection::orthographic;
        camera.ymag = source.orthographic.ymag;
        camera.aspectRatio = source.orthographic.xmag / source.orthographic.ymag;
        return camera;
    }
    camera.yfov = source.perspective.yfov;
    if (source.perspective.aspectRatio > 0.0) camera.aspectRatio = source.perspective.aspectRatio;
    return camera;
}

/// What of a light does not depend on where it stands.
PunctualLight toLight(const tinygltf::Light& source) {
    // Cosines of cones that are narrow, or hardly apart, may be equal when rounded; the edge between them has a width.
    constexpr double kNarrowestEdge = 0x1p-52;
    PunctualLight light;
    light.name = source.name;
    light.kind = source.type == "point"  ? PunctualKind::point
                 : source.type == "spot" ? PunctualKind::spot
                                         : PunctualKind::directional;
    light.intensity = source.intensity * toVec3(source.color);
    if (light.kind == PunctualKind::spot) {
        light.cosInner = std::cos(source.spot.innerConeAngle);
        light.cosOuter = std::min(std::cos(source.spot.outerConeAngle), light.cosInner - kNarrowestEdge);
    }
    return light;
}

class NodeWalker {
public:
    NodeWalker(const Asset& asset, MaterialBuilder& materials, LoadContext& context, Scene& scene)
        : asset_(asset), materials_(materials), context_(context), scene_(scene),
          meshes_(asset, materials, context, scene.meshes) {}

    /// With a stack of its own: hierarchies may be deeper than the machine's.
    void walk(const std::vector<int>& roots) {
        std::vector<Visit> stack;
        push(stack, roots, Mat4d(1.0), 1);
        while (!stack.empty()) {
            const Visit visit = stack.back();
            stack.pop_back();
            const Mat4d world = visit.parent * localTransform(node(visit.node));
            place(visit, world);
            push(stack, node(visit.node).children, world, visit.depth + 1);
        }
    }

private:
    struct Visit {
        int node = 0;
        Mat4d parent{1.0};
        std::size_t depth = 0;
    };

    [[nodiscard]] const tinygltf::Node& node(int index) const {
        return asset_.model.nodes[static_cast<std::size_t>(index)];
    }
    [[nodiscard]] static std::string pointerTo(int index) { return fmt::format("/nodes/{}", index); }
    [[nodiscard]] std::string nameOf(int index) const {
        return node(index).name.empty() ? fmt::format("node {}", index) : node(index).name;
    }

    static void push(std::vector<Visit>& stack, const std::vector<int>& nodes, const Mat4d& parent, std::size_t depth) {
        for (auto child = nodes.rbegin(); child != nodes.rend(); ++child) stack.push_back({*child, parent, depth});
    }

    void place(const Visit& visit, const Mat4d& world) {
        const tinygltf::Node& source = node(visit.node);
        if (visit.depth > kDeepestNode)
            context_.fail(pointerTo(visit.node), fmt::format("is nested more than {} nodes deep", kDeepestNode));
        if (!isFiniteMatrix(world)) context_.fail(pointerTo(visit.node), "its transform to the world is not finite");
        if (source.camera >= 0) placeCamera(visit.node, world);
        if (source.extensions.contains(kLights)) placeLight(visit.node, world);
        if (source.extras.Has("sphere"))
            placeSphere(visit.node, world);
        else if (source.mesh >= 0)
            placeMesh(visit.node, world);
    }

    void placeMesh(int index, const Mat4d& world) {
        for (const std::uint32_t mesh : meshes_.meshesOf(static_cast<std::size_t>(node(index).mesh)))
            scene_.instances.push_back({nameOf(index), mesh, world});
    }

    void placeSphere(int index, const Mat4d& world) {
        const tinygltf::Value& sphere = node(index).extras.Get("sphere");
        const std::optional<double> scale = uniformScale(Mat3d(world));
        if (!scale)
            context_.fail(pointerTo(index),
                          "its sphere would become an ellipsoid or a point, which is not supported; scale "
                          "the node and its parents by the same non-zero factor along every axis");
        const double radius = sphere.Get("radius").GetNumberAsDouble() * *scale;
        if (!std::isfinite(radius) || !(radius > 0.0))
            context_.fail(pointerTo(index), fmt::format("its sphere's radius in the world is {}", radius));
        scene_.spheres.push_back({nameOf(index), Vec3d(world[3]), radius, sphereMaterial(index)});
    }

    /// The stand-in mesh's material comes first, so that what other programs show stays in step.
    std::uint32_t sphereMaterial(int index) {
        const tinygltf::Node& source = node(index);
        if (source.mesh >= 0) {
            const auto& primitives = asset_.model.meshes[static_cast<std::size_t>(source.mesh)].primitives;
            return materials_.indexOf(primitives.empty() ? -1 : primitives.front().material);
        }
        const tinygltf::Value& sphere = source.extras.Get("sphere");
        return materials_.indexOf(sphere.Has("material") ? sphere.Get("material").GetNumberAsInt() : -1);
    }

    /// A camera's scale is ignored (glTF 2.0, 3.10.1): the viewing direction and the upright plane are kept.
    void placeCamera(int index, const Mat4d& world) {
        const tinygltf::Camera& source = asset_.model.cameras[static_cast<std::size_t>(node(index).camera)];
        const Vec3d backward = direction(Vec3d(world[2]));
        const Vec3d right = direction(glm::cross(direction(Vec3d(world[1])), backward));
        if (right == Vec3d(0.0)) context_.fail(pointerTo(index), "its camera has no direction: a scale is zero");
        Camera camera = toCamera(source);
        if (camera.name.empty()) camera.name = node(index).name;
        if (camera.name.empty()) camera.name = fmt::format("camera {}", scene_.cameras.size());
        camera.position = Vec3d(world[3]);
        camera.worldFromCamera = Mat3d(right, glm::cross(backward, right), backward);
        scene_.cameras.push_back(std::move(camera));
    }

    /// Scale does not change a light (KHR_lights_punctual): it takes the node's origin, and shines along its -z.
    void placeLight(int index, const Mat4d& world) {
        const tinygltf::Value& reference = node(index).extensions.at(kLights).Get("light");
        PunctualLight light = toLight(asset_.model.lights[static_cast<std::size_t>(reference.GetNumberAsInt())]);
        if (light.name.empty()) light.name = nameOf(index);
        light.position = Vec3d(world[3]);
        if (light.kind != PunctualKind::point) light.direction = -direction(Vec3d(world[2]));
        if (light.direction == Vec3d(0.0))
            context_.warn(pointerTo(index), "its light has no direction, for a scale is zero; left out");
        else
            scene_.punctualLights.push_back(std::move(light));
    }

    const Asset& asset_;
    MaterialBuilder& materials_;
    LoadContext& context_;
    Scene& scene_;
    MeshBuilder meshes_;
};

} // namespace

void walkNodes(const Asset& asset, const std::vector<int>& roots, MaterialBuilder& materials, LoadContext& context,
               Scene& scene) {
    NodeWalker(asset, materials, context, scene).walk(roots);
}

} // namespace isolux
