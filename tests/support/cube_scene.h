// A small glTF file for tests of the program, which they change as they need.
#pragma once

#include "support/program.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <fstream>

namespace isolux::test {

inline constexpr std::array<float, 24> kCubeCorners{-1, -1, -1, -1, -1, 1, -1, 1, -1, -1, 1, 1,
                                                    1,  -1, -1, 1,  -1, 1, 1,  1, -1, 1,  1, 1};
inline constexpr std::array<std::uint16_t, 36> kCubeTriangles{0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                                              2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};

/// A grey cube of edge 2 about the origin, its faces outwards, without a light. From z = 6 two cameras look at it:
/// "front view", perspective, node 1, and "front plan", orthographic, node 2. It loads without a warning.
[[nodiscard]] inline nlohmann::json cubeDocument() {
    return nlohmann::json::parse(R"({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "extensionsUsed": ["KHR_materials_specular", "KHR_lights_punctual"],
        "nodes": [{"name": "cube", "mesh": 0},
                  {"camera": 0, "translation": [0, 0, 6]}, {"camera": 1, "translation": [0, 0, 6]}],
        "cameras": [{"name": "front view", "type": "perspective",
                     "perspective": {"yfov": 0.8, "aspectRatio": 1.5, "znear": 0.1}},
                    {"name": "front plan", "type": "orthographic",
                     "orthographic": {"xmag": 3, "ymag": 2, "znear": 0.1, "zfar": 100}}],
        "meshes": [{"name": "cube",
                    "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"name": "clay",
                       "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0},
                       "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
        "buffers": [{"uri": "cube.bin", "byteLength": 168}],
        "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
                       "min": [-1, -1, -1], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]})");
}

/// Adds a light of this type ("point", "spot", "directional") in front of the cube, shining on it.
inline void addPunctualLight(nlohmann::json& document, const std::string& type) {
    nlohmann::json& lights = document["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back({{"type", type}, {"intensity", 100.0}});
    if (type == "spot") lights.back()["spot"] = nlohmann::json::object();
    document["scenes"][0]["nodes"].push_back(document["nodes"].size());
    document["nodes"].push_back(
        {{"translation", {0, 0, 5}}, {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
}

/// A test with a scene file in its folder.
class CubeSceneTest : public ProgramTest {
protected:
    CubeSceneTest() { writeScene(cubeDocument()); }

    void writeScene(const nlohmann::json& document) const {
        std::ofstream(file("cube.gltf")) << document.dump();
        std::ofstream bytes(file("cube.bin"), std::ios::binary);
        bytes.write(reinterpret_cast<const char*>(kCubeCorners.data()), sizeof(kCubeCorners));
        bytes.write(reinterpret_cast<const char*>(kCubeTriangles.data()), sizeof(kCubeTriangles));
    }

    /// The file's name as a shell's word.
    [[nodiscard]] std::string scene() const { return "'" + file("cube.gltf") + "'"; }
};

} // namespace isolux::test
