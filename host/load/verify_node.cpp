// Nodes and scenes: transforms, references, extras, and that the nodes form trees.
#include "load/context.h"
#include "load/verify_parts.h"

#include <fmt/format.h>

#include <cmath>

namespace isolux {
namespace {

using nlohmann::json;

json verifyMatrix(const JsonReader& matrix) {
    constexpr double kTolerance = 1e-6; // exporters round
    json result = matrix.numbers(16);
    for (std::size_t column = 0; column < 4; ++column) {
        json& last = result[4 * column + 3];
        const double affine = column == 3 ? 1.0 : 0.0;
        if (!(std::abs(last.get<double>() - affine) <= kTolerance))
            matrix.fail("is not affine: its last row (elements 3, 7, 11, 15) must be 0 0 0 1");
        last = affine;
    }
    return result;
}

json verifyRotation(const JsonReader& rotation) {
    json result = rotation.numbersBetween(4, -1.0 - 1e-3, 1.0 + 1e-3);
    double squared = 0.0;
    for (const json& component : result) squared += component.get<double>() * component.get<double>();
    if (std::abs(squared - 1.0) > 1e-2) rotation.fail("is not a unit quaternion");
    return result;
}

void verifyTransform(const JsonReader& node, json& result) {
    if (const std::optional<JsonReader> matrix = node.find("matrix")) {
        for (const std::string_view key : {"translation", "rotation", "scale"})
            if (node.find(key)) node.at(key).fail("stands beside a matrix; a node has either a matrix or these");
        result["matrix"] = verifyMatrix(*matrix);
    }
    if (node.find("translation")) result["translation"] = node.at("translation").numbers(3);
    if (node.find("rotation")) result["rotation"] = verifyRotation(node.at("rotation"));
    if (node.find("scale")) result["scale"] = node.at("scale").numbers(3);
}

/// extras {"sphere": {"radius": r, "material": m}}: an exact sphere at the node's origin.
void verifySphere(const JsonReader& node, const JsonReader& root, json& result) {
    const std::optional<JsonReader> sphere = findExtra(node, "sphere");
    if (!sphere) return;
    const double radius = sphere->at("radius").number();
    if (!(radius > 0.0)) sphere->at("radius").fail(fmt::format("is {} but must be positive", radius));
    result["extras"]["sphere"]["radius"] = radius;
    if (const std::optional<JsonReader> material = sphere->find("material"))
        result["extras"]["sphere"]["material"] = material->index(root.sizeOf("materials"), "materials");
}

/// extras {"cgl_hemisphere_light": {"radiance": [r, g, b]}}: constant radiance from the upper half of the directions.
void verifyHemisphereLight(const JsonReader& scene, json& result) {
    const std::optional<JsonReader> light = findExtra(scene, "cgl_hemisphere_light");
    if (!light) return;
    json& extra = result["extras"]["cgl_hemisphere_light"];
    extra["radiance"] = light->at("radiance").numbersBetween(3, 0.0, kLargestRadiance);
    if (light->find("up") && light->at("up").numbers(3) != json{0, 1, 0})
        light->at("up").fail("is not (0, 1, 0); turn the scene so that its sky is towards +y");
}

void warnOfNode(const JsonReader& node, const JsonReader& root) {
    if (const std::optional<JsonReader> skin = node.find("skin")) {
        (void)skin->index(root.sizeOf("skins"), "skins");
        skin->warn("skins are not supported; the mesh is rendered in its bind pose, at its node");
    }
}

/// node -> the reference that makes another node its parent; empty for roots.
std::vector<std::string> findParents(const JsonReader& root, std::vector<std::size_t>& parentOf) {
    const std::size_t count = parentOf.size();
    std::vector<std::string> pointers(count);
    for (std::size_t parent = 0; parent < count; ++parent) {
        const JsonReader node = root.at("nodes").element(parent);
        for (std::size_t i = 0; i < node.sizeOf("children"); ++i) {
            const JsonReader reference = node.at("children").element(i);
            const std::size_t child = reference.index(count, "nodes");
            if (!pointers[child].empty())
                reference.fail(
                    fmt::format("node {} already has a parent, by {}; a node has one parent", child, pointers[child]));
            pointers[child] = reference.pointer();
            parentOf[child] = parent;
        }
    }
    return pointers;
}

/// Walks from each node towards its root; a walk that meets itself is a cycle. Every node is walked over once.
void verifyNoCycles(const std::vector<std::size_t>& parentOf, const std::vector<std::string>& pointers,
                    const JsonReader& root) {
    std::vector<std::size_t> walkOf(parentOf.size(), 0);
    for (std::size_t start = 0; start < parentOf.size(); ++start) {
        std::size_t node = start;
        while (node < parentOf.size() && walkOf[node] == 0) {
            walkOf[node] = start + 1;
            node = parentOf[node];
        }
        if (node < parentOf.size() && walkOf[node] == start + 1)
            root.context().fail(pointers[node],
                                fmt::format("node {} is its own ancestor: the nodes form a cycle", node));
    }
}

} // namespace

json verifyNode(const JsonReader& node, const JsonReader& root) {
    json result = json::object();
    copyName(node, result);
    verifyTransform(node, result);
    if (const std::optional<JsonReader> mesh = node.find("mesh"))
        result["mesh"] = mesh->index(root.sizeOf("meshes"), "meshes");
    if (const std::optional<JsonReader> camera = node.find("camera"))
        result["camera"] = camera->index(root.sizeOf("cameras"), "cameras");
    for (std::size_t i = 0; i < node.sizeOf("children"); ++i)
        result["children"].push_back(node.at("children").element(i).index(root.sizeOf("nodes"), "nodes"));
    verifyLightOf(node, root, result);
    verifySphere(node, root, result);
    warnOfNode(node, root);
    return result;
}

json verifyScene(const JsonReader& scene, const JsonReader& root) {
    json result = json::object();
    copyName(scene, result);
    result["nodes"] = json::array();
    for (std::size_t i = 0; i < scene.sizeOf("nodes"); ++i)
        result["nodes"].push_back(scene.at("nodes").element(i).index(root.sizeOf("nodes"), "nodes"));
    verifyHemisphereLight(scene, result);
    return result;
}

void verifyHierarchy(const JsonReader& root) {
    const std::size_t nodeCount = root.sizeOf("nodes");
    std::vector<std::size_t> parentOf(nodeCount, nodeCount);
    const std::vector<std::string> pointers = findParents(root, parentOf);
    verifyNoCycles(parentOf, pointers, root);
    std::vector<std::size_t> listedBy(nodeCount, 0);
    for (std::size_t s = 0; s < root.sizeOf("scenes"); ++s) {
        const JsonReader scene = root.at("scenes").element(s);
        for (std::size_t i = 0; i < scene.sizeOf("nodes"); ++i) {
            const JsonReader reference = scene.at("nodes").element(i);
            const std::size_t node = reference.index(nodeCount, "nodes");
            if (!pointers[node].empty())
                reference.fail(fmt::format("node {} is no root: it is a child by {}", node, pointers[node]));
            if (listedBy[node] == s + 1) reference.fail(fmt::format("node {} is listed twice", node));
            listedBy[node] = s + 1;
        }
    }
}

} // namespace isolux
