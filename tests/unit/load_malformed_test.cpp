// The glTF loader refuses malformed documents, naming file and JSON pointer.
#include "unit/load_fixture.h"

#include <functional>
#include <limits>

namespace isolux::load_test {
namespace {

struct Malformed {
    const char* expected; ///< part of the message
    std::function<void(json&)> damage;
};

/// Sets what `pointer` names.
std::function<void(json&)> set(const std::string& pointer, json value) {
    return [=](json& document) { document[json::json_pointer(pointer)] = value; };
}

void floats(json& document, std::vector<float> values) { document["buffers"][0]["uri"] = dataUri(bytesOf(values)); }

TEST_F(LoadTest, MalformedDocumentsAreRefusedByPointer) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::uint64_t huge = std::uint64_t{1} << 62;
    const std::vector<Malformed> cases = {
        {"/asset: is missing", [](json& d) { d.erase("asset"); }},
        {"/asset/version: glTF 3.0", set("/asset/version", "3.0")},
        {"/asset/version: must be a string", set("/asset/version", 2.0)},
        {"/asset/minVersion", set("/asset/minVersion", "2.9")},
        {"/extensionsRequired/1: the file requires KHR_draco_mesh_compression",
         set("/extensionsRequired", {"KHR_materials_specular", "KHR_draco_mesh_compression"})},
        {"/scene: refers to scenes 4, but there are only 1", set("/scene", 4)},
        {"/scene: must be a non-negative integer, not -1", set("/scene", -1)},
        {"/scenes/0/nodes/0: must be a non-negative integer, not 0.5", set("/scenes/0/nodes/0", 0.5)},
        {"/scenes/0/nodes: must be an array, not object", set("/scenes/0/nodes", json::object())},
        {"/scenes/0/nodes/1: node 0 is listed twice", set("/scenes/0/nodes", {0, 0})},
        {"/nodes: must be an array", set("/nodes", "x")},
        {"/nodes/0: must be an object, not null", set("/nodes/0", nullptr)},
        {"/nodes/0/mesh: refers to meshes 1", set("/nodes/0/mesh", 1)},
        {"/nodes/0/camera: refers to cameras 0", set("/nodes/0/camera", 0)},
        {"/nodes/0/name: must be a string", set("/nodes/0/name", 7)},
        {"/nodes/0/children/0: node 0 is its own ancestor", set("/nodes/0/children", {0})},
        {"/nodes/0/scale: must have 3 numbers", set("/nodes/0/scale", {1, 2})},
        {"/nodes/0/rotation: is not a unit quaternion", set("/nodes/0/rotation", {0, 0, 0, 0})},
        {"/nodes/0/matrix: must have 16", set("/nodes/0/matrix", {1})},
        {"/nodes/0: its transform to the world is not finite",
         [](json& d) {
             d["nodes"] = {{{"mesh", 0}, {"scale", {1e300, 1, 1}}}, {{"children", {0}}, {"scale", {1e300, 1, 1}}}};
             d["scenes"][0]["nodes"] = {1};
         }},
        {"units from the origin", set("/nodes/0/translation", {1e30, 0, 0})},
        {"/nodes/0/extras/sphere/radius: is 0", set("/nodes/0/extras", {{"sphere", {{"radius", 0}}}})},
        {"/nodes/0/extras/sphere/radius: is missing", set("/nodes/0/extras", {{"sphere", json::object()}})},
        {"/nodes/0/extras/sphere: must be an object", set("/nodes/0/extras", {{"sphere", 1}})},
        {"/nodes/0/extras/sphere/material", set("/nodes/0/extras", {{"sphere", {{"radius", 1}, {"material", 0}}}})},
        {"/nodes/0: its sphere would become an ellipsoid",
         set("/nodes/0", {{"extras", {{"sphere", {{"radius", 1}}}}}, {"scale", {1, 1, 1.001}}})},
        {"/meshes/0/primitives: is missing", set("/meshes/0", json::object())},
        {"/meshes/0/primitives/0/mode: is 7", set("/meshes/0/primitives/0/mode", 7)},
        {"/meshes/0/primitives/0/material: refers to materials 0", set("/meshes/0/primitives/0/material", 0)},
        {"/meshes/0/primitives/0/indices: refers to an accessor", set("/meshes/0/primitives/0/indices", 0)},
        {"/meshes/0/primitives/0/attributes/POSITION: refers to accessors 9",
         set("/meshes/0/primitives/0/attributes/POSITION", 9)},
        {"/meshes/0/primitives/0/attributes/NORMAL: has 2 elements but POSITION has 3",
         [](json& d) {
             d["accessors"].push_back(d["accessors"][0]);
             d["accessors"][1]["count"] = 2;
             primitiveOf(d)["attributes"]["NORMAL"] = 1;
         }},
        {"/accessors/0/componentType: 5130", set("/accessors/0/componentType", 5130)},
        {"/accessors/0/type: is no accessor type", set("/accessors/0/type", "VEC9")},
        {"/accessors/0/count: is 0", set("/accessors/0/count", 0)},
        {"/accessors/0: its 4294967295 elements", set("/accessors/0/count", 4294967295u)},
        {"/accessors/0/count: is 4611686018427387904", set("/accessors/0/count", huge)},
        {"/accessors/0: its 3 elements of 12 bytes from byte 18446744073709551608",
         set("/accessors/0/byteOffset", ~std::uint64_t{7})},
        {"/accessors/0: its data is not aligned",
         [](json& d) {
             d["accessors"][0]["byteOffset"] = 2;
             d["accessors"][0]["count"] = 2;
         }},
        {"/accessors/0: its elements of 12 bytes overlap", set("/bufferViews/0/byteStride", 8)},
        {"/bufferViews/0/byteStride: must be a multiple of 4", set("/bufferViews/0/byteStride", 14)},
        {"/bufferViews/0: its 36 bytes from byte 9223372036854775807",
         set("/bufferViews/0/byteOffset", std::numeric_limits<std::int64_t>::max())},
        {"/bufferViews/0/buffer: refers to buffers 3", set("/bufferViews/0/buffer", 3)},
        {"/buffers/0/byteLength: is 40 but there are only 36", set("/buffers/0/byteLength", 40)},
        {"/buffers/0: has no uri", [](json& d) { d["buffers"][0].erase("uri"); }},
        {"/buffers/0/uri: character 4 of its base64", set("/buffers/0/uri", "data:;base64,AAAA!AAA")},
        {"/buffers/0/uri: is a data: URI that is not base64", set("/buffers/0/uri", "data:,abc;base64,")},
        {"/accessors/0: element 1 is not finite (nan",
         [=](json& d) {
             floats(d, {0, 0, 0, nan, 0, 0, 0, 1, 0});
         }},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor/1: is 1.5",
         set("/materials", {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1.5, 1, 1}}}}}})},
        {"/materials/0/emissiveFactor: must have 3", set("/materials", {{{"emissiveFactor", {1, 1}}}})},
        {"/materials/0/doubleSided: must be true or false", set("/materials", {{{"doubleSided", 1}}})},
        {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength: is -1",
         set("/materials", {{{"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", -1}}}}}}})},
        {"/materials/0/normalTexture/index: refers to textures 0",
         set("/materials", {{{"normalTexture", {{"index", 0}}}}})},
        {"/cameras/0/type: must be perspective", set("/cameras", {{{"type", "oblique"}}})},
        {"/cameras/0/perspective: is missing", set("/cameras", {{{"type", "perspective"}}})},
        {"/cameras/0/perspective/yfov: is 0 but",
         set("/cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 1}}}}})},
        {"/cameras/0/perspective/yfov: is 4 but",
         set("/cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 1}}}}})},
    };
    for (const Malformed& malformed : cases) {
        json document = triangleDocument();
        malformed.damage(document);
        EXPECT_MENTIONS(failure(document), malformed.expected);
    }
}

TEST_F(LoadTest, BadIndicesAndNormalsAreNamedByElement) {
    json document = triangleDocument();
    primitiveOf(document)["indices"] =
        addAccessor(document, bytesOf<std::uint32_t>({0, 1, 0xFFFFFFFFu}), scalars(5125, 3));
    EXPECT_MENTIONS(failure(document), "/accessors/1: element 2 is 4294967295, which restarts primitives");
    document = triangleDocument();
    primitiveOf(document)["indices"] = addAccessor(document, bytesOf<std::uint32_t>({0, 1, 3}), scalars(5125, 3));
    EXPECT_MENTIONS(failure(document), "/accessors/1: element 2 is 3, but the primitive has only 3 vertices");
    document = triangleDocument();
    const std::string infinite = bytesOf(std::vector<float>(9, std::numeric_limits<float>::infinity()));
    primitiveOf(document)["attributes"]["NORMAL"] = addAccessor(document, infinite, document["accessors"][0]);
    EXPECT_MENTIONS(failure(document), "/accessors/1: element 0 is not finite (inf");
}

TEST_F(LoadTest, NodesMustFormTrees) {
    json document = triangleDocument();
    document["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    EXPECT_MENTIONS(failure(document), "/nodes/1/children/0: node 2 already has a parent, by /nodes/0/children/0");
    document["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
    EXPECT_MENTIONS(failure(document), "the nodes form a cycle");
    document["nodes"] = {{{"mesh", 0}}, {{"children", {0}}}};
    EXPECT_MENTIONS(failure(document), "/scenes/0/nodes/0: node 0 is no root");
}

TEST_F(LoadTest, DeepHierarchiesAreRefused) {
    json document = triangleDocument();
    const auto chain = [&](int length) {
        document["nodes"] = json::array();
        for (int i = 0; i + 1 < length; ++i) document["nodes"].push_back({{"children", {i + 1}}});
        document["nodes"].push_back({{"mesh", 0}});
    };
    chain(1000);
    EXPECT_EQ(load(document).instances.size(), 1u);
    chain(100000);
    EXPECT_MENTIONS(failure(document), "/nodes/1024: is nested more than 1024 nodes deep");
}

} // namespace
} // namespace isolux::load_test
