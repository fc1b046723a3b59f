// Builds small glTF files in memory for the loader's tests, and loads them from a folder of their own.
#pragma once

#include "core/error.h"
#include "load/gltf.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace isolux::load_test {

namespace fs = std::filesystem;
using nlohmann::json;

template <typename T> std::string bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string base64(const std::string& bytes) {
    constexpr const char* kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kAlphabet[(word >> (18 - 6 * k)) & 63u];
    }
    return text;
}

inline std::string dataUri(const std::string& bytes) { return "data:application/octet-stream;base64," + base64(bytes); }

inline std::string word(std::uint32_t value) { return bytesOf(std::vector<std::uint32_t>{value}); }

inline std::string chunk(std::string data, const std::string& type, char padding) {
    while (data.size() % 4 != 0) data += padding;
    return word(static_cast<std::uint32_t>(data.size())) + type + data;
}

inline std::string glb(const std::string& chunks) {
    return std::string("glTF") + word(2) + word(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

inline const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/// One triangle, without indices: accessor 0, mesh 0, node 0.
inline json triangleDocument() {
    return {{"asset", {{"version", "2.0"}}},
            {"buffers", {{{"byteLength", 36}, {"uri", dataUri(bytesOf(kTriangle))}}}},
            {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
            {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
            {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
            {"nodes", {{{"mesh", 0}}}},
            {"scenes", {{{"nodes", {0}}}}},
            {"scene", 0}};
}

/// Appends a buffer with one view and one accessor over all of it; returns the accessor.
inline std::size_t addAccessor(json& document, const std::string& bytes, json accessor) {
    document["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", dataUri(bytes)}});
    document["bufferViews"].push_back({{"buffer", document["buffers"].size() - 1}, {"byteLength", bytes.size()}});
    accessor["bufferView"] = document["bufferViews"].size() - 1;
    document["accessors"].push_back(std::move(accessor));
    return document["accessors"].size() - 1;
}

inline json scalars(int componentType, std::size_t count) {
    return {{"componentType", componentType}, {"count", count}, {"type", "SCALAR"}};
}

inline json vectors(int componentType, std::size_t count) {
    return {{"componentType", componentType}, {"count", count}, {"type", "VEC3"}};
}

inline json normalized(json accessor) {
    accessor["normalized"] = true;
    return accessor;
}

inline json& primitiveOf(json& document) { return document["meshes"][0]["primitives"][0]; }

inline bool mentions(const std::vector<std::string>& lines, const std::string& text) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

class LoadTest : public ::testing::Test {
protected:
    LoadTest() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() / (std::string("isolux_load_") + test->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "scene");
    }
    ~LoadTest() override { fs::remove_all(folder_); }

    /// A path in the scene's folder, with the given content.
    fs::path write(const std::string& name, const std::string& content) {
        const fs::path path = folder_ / "scene" / name;
        std::ofstream(path, std::ios::binary) << content;
        return path;
    }
    Scene load(const std::string& content) { return loadScene(write("scene.gltf", content)); }
    Scene load(const json& document) { return load(document.dump()); }

    /// What loading fails with; empty if it succeeds.
    std::string failure(const std::string& content) {
        try {
            (void)load(content);
            return {};
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::badInput);
            return error.what();
        }
    }
    std::string failure(const json& document) { return failure(document.dump()); }

    fs::path folder_;
};

#define EXPECT_MENTIONS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << text

} // namespace isolux::load_test
