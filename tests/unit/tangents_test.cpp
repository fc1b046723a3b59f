// Tangents by MikkTSpace's definition: directions, mirrored and degenerate textures, and those that a file brings.
#include "scene/tangents.h"

#include "support/scenes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>

namespace isolux {
namespace {

/// Two triangles on the unit square in z = 0, facing +z, with the image upright: u = x, v = 1 - y.
Mesh square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, Vec3f(0.0f, 0.0f, 1.0f));
    mesh.uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

glm::vec4 tangentAt(const Mesh& mesh, std::size_t triangle, std::size_t corner) {
    return mesh.tangents.at(mesh.triangles.at(triangle).at(corner));
}

void expectNear(const glm::vec4& found, const glm::vec4& expected) {
    EXPECT_LT(glm::length(Vec3f(found) - Vec3f(expected)), 1e-6f) // a few roundings of numbers about 1 to float
        << found.x << " " << found.y << " " << found.z;
    EXPECT_EQ(found.w, expected.w);
}

TEST(Tangents, AnUprightImageHasItsRedRightAndItsGreenUp) {
    Mesh mesh = square();
    generateTangents(mesh, 0);
    ASSERT_EQ(mesh.positions.size(), 4u);
    for (const glm::vec4& tangent : mesh.tangents) {
        expectNear(tangent, {1, 0, 0, 1});
        EXPECT_GT((glm::cross(mesh.normals[0], Vec3f(tangent)) * tangent.w).y, 0.0f);
    }
}

TEST(Tangents, FollowTheTextureNotTheEdges) {
    Mesh mesh = square();
    for (auto& uv : mesh.uvs[0]) uv = {0.3f * uv.x + 0.3f * uv.y, 0.2f * uv.y}; // sheared: v stays along x alone
    generateTangents(mesh, 0);
    for (const glm::vec4& tangent : mesh.tangents) expectNear(tangent, {1, 0, 0, 1});
}

TEST(Tangents, TheSetIsChosen) {
    Mesh mesh = square();
    mesh.uvs.push_back({{0, 0}, {0, 1}, {1, 1}, {1, 0}}); // turned: u = y, v = x
    generateTangents(mesh, 1);
    for (const glm::vec4& tangent : mesh.tangents) expectNear(tangent, {0, 1, 0, 1});
}

TEST(Tangents, AMirroredTextureIsSplitAtItsSeam) {
    Mesh mesh = square(); // and a second one to the right, whose image runs back
    mesh.positions.insert(mesh.positions.end(), {{2, 0, 0}, {2, 1, 0}});
    mesh.normals.assign(6, Vec3f(0.0f, 0.0f, 1.0f));
    mesh.uvs[0].insert(mesh.uvs[0].end(), {{0, 1}, {0, 0}});
    mesh.colors = {glm::vec4(0.0f), glm::vec4(0.1f), glm::vec4(0.2f),
                   glm::vec4(0.3f), glm::vec4(0.4f), glm::vec4(0.5f)};
    mesh.triangles.insert(mesh.triangles.end(), {{1, 4, 5}, {1, 5, 2}});
    const Mesh before = mesh;
    generateTangents(mesh, 0);
    ASSERT_EQ(mesh.positions.size(), 8u) << "the two vertices of the seam are there twice";
    for (std::size_t triangle = 0; triangle < 4; ++triangle)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            expectNear(tangentAt(mesh, triangle, corner),
                       triangle < 2 ? glm::vec4(1, 0, 0, 1) : glm::vec4(-1, 0, 0, -1));
            const std::uint32_t old = before.triangles[triangle][corner];
            const std::uint32_t vertex = mesh.triangles[triangle][corner];
            EXPECT_EQ(mesh.positions[vertex], before.positions[old]);
            EXPECT_EQ(mesh.uvs[0][vertex], before.uvs[0][old]);
            EXPECT_EQ(mesh.colors[vertex], before.colors[old]);
        }
    EXPECT_EQ(mesh.normals.size(), 8u);
}

TEST(Tangents, CornersOfOneVertexAreAveragedByTheirAngles) {
    Mesh mesh; // about the origin: a right angle, and half of one
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, Vec3f(0.0f, 0.0f, 1.0f));
    mesh.uvs = {{{0, 0}, {1, 0}, {0, 1}, {-1, 1}}}; // u = x, v = y on both
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    generateTangents(mesh, 0);
    expectNear(mesh.tangents[0], {1, 0, 0, -1});
    mesh.uvs[0][3] = {-2, -1}; // u = 2 x, v = 2 x + y on the second: v stays and u grows along (1, -2)
    generateTangents(mesh, 0);
    const Vec3d second = glm::normalize(Vec3d(1.0, -2.0, 0.0));
    const Vec3d expected = glm::normalize(0.5 * kPi * Vec3d(1.0, 0.0, 0.0) + 0.25 * kPi * second);
    expectNear(mesh.tangents[0], glm::vec4(Vec3f(expected), -1.0f));
}

TEST(Tangents, VerticesAreOneHoweverTheyAreIndexed) {
    Mesh shared = square();
    shared.uvs[0][3] = {0.4f, 0.1f};
    Mesh apart;
    apart.uvs.resize(1);
    for (const auto& triangle : shared.triangles)
        for (const std::uint32_t vertex : triangle) {
            apart.positions.push_back(shared.positions[vertex]);
            apart.normals.push_back(shared.normals[vertex]);
            apart.uvs[0].push_back(shared.uvs[0][vertex]);
        }
    apart.triangles = {{0, 1, 2}, {3, 4, 5}};
    generateTangents(shared, 0);
    generateTangents(apart, 0);
    for (std::size_t triangle = 0; triangle < 2; ++triangle)
        for (std::size_t corner = 0; corner < 3; ++corner)
            EXPECT_EQ(tangentAt(shared, triangle, corner), tangentAt(apart, triangle, corner));
}

TEST(Tangents, TrianglesWithoutTextureFollowTheirNeighbours) {
    Mesh mesh = square();
    mesh.positions.emplace_back(2.0f, 0.5f, 0.0f);
    mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
    mesh.uvs[0].emplace_back(1.0f, 0.5f); // on the line through its neighbours' coordinates
    mesh.triangles.push_back({1, 4, 2});
    mesh.triangles.push_back({3, 3, 0}); // no triangle at all
    generateTangents(mesh, 0);
    ASSERT_EQ(mesh.positions.size(), 5u);
    for (std::size_t triangle = 0; triangle < 4; ++triangle)
        for (std::size_t corner = 0; corner < 3; ++corner) expectNear(tangentAt(mesh, triangle, corner), {1, 0, 0, 1});
}

TEST(Tangents, NothingThatIsNoNumberComesOut) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float number : {kNaN, kInfinity, 3e38f, 0.0f}) {
        Mesh mesh = square();
        mesh.uvs[0].assign(4, {number, number});
        mesh.uvs[0][2] = {-number, 1.0f};
        generateTangents(mesh, 0);
        for (const glm::vec4& tangent : mesh.tangents) {
            EXPECT_TRUE(isFinite(Vec3f(tangent))) << number;
            EXPECT_EQ(std::abs(tangent.w), 1.0f);
        }
    }
    Mesh empty;
    empty.uvs.resize(1);
    generateTangents(empty, 0);
    EXPECT_TRUE(empty.tangents.empty());
}

TEST(Tangents, FlatMeshesUseTheNormalsOfTheirTriangles) {
    Mesh mesh = square();
    mesh.normals.clear();
    mesh.positions[3].z = 1.0f; // folds the second triangle
    generateTangents(mesh, 0);
    ASSERT_EQ(mesh.positions.size(), 6u) << "the fold's vertices are there twice";
    EXPECT_TRUE(mesh.normals.empty());
    expectNear(tangentAt(mesh, 0, 0), {1, 0, 0, 1});
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vec3f normal = glm::normalize(Vec3f(1.0f, -1.0f, 1.0f));
        EXPECT_NEAR(glm::dot(normal, Vec3f(tangentAt(mesh, 1, corner))), 0.0f, 1e-6f);
    }
}

/// A bumpy sheet of 2 n^2 triangles.
Mesh sheet(std::uint32_t n) {
    Mesh mesh;
    mesh.uvs.resize(1);
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(n);
            const float v = static_cast<float>(y) / static_cast<float>(n);
            mesh.positions.emplace_back(u, v, 0.05f * std::sin(20.0f * u) * std::cos(17.0f * v));
            mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
            mesh.uvs[0].emplace_back(u, 1.0f - v);
        }
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t i = y * (n + 1) + x;
            mesh.triangles.push_back({i, i + 1, i + n + 2});
            mesh.triangles.push_back({i, i + n + 2, i + n + 1});
        }
    return mesh;
}

TEST(Tangents, LargeMeshesTakeLittleMoreThanLinearTime) {
    Mesh mesh = sheet(300); // 180,000 triangles; all about one vertex, the worst for what is quadratic, are next
    generateTangents(mesh, 0);
    EXPECT_EQ(mesh.positions.size(), 301u * 301u);
    Mesh book; // pages that share one edge, half of them turned
    book.uvs.resize(1);
    constexpr std::uint32_t kPages = 100'000;
    for (std::uint32_t i = 0; i < kPages + 2; ++i) {
        book.positions.emplace_back(static_cast<float>(i), i == 1 ? 1.0f : 0.0f, 0.0f);
        book.uvs[0].emplace_back(static_cast<float>(i), i == 1 ? 1.0f : 0.0f);
    }
    book.normals.assign(book.positions.size(), Vec3f(0.0f, 0.0f, 1.0f));
    for (std::uint32_t i = 0; i < kPages; ++i) {
        if (i < kPages / 2)
            book.triangles.push_back({0, 1, i + 2});
        else
            book.triangles.push_back({1, 0, i + 2});
    }
    generateTangents(book, 0);
    EXPECT_EQ(book.tangents.size(), book.positions.size());
}

// --- The file that brings tangents ---

/// The parts of a binary glTF file that the test reads.
struct Glb {
    nlohmann::json json;
    std::vector<char> binary;

    template <typename Value> [[nodiscard]] std::vector<Value> values(const nlohmann::json& accessorIndex) const {
        const nlohmann::json& accessor = json["accessors"][accessorIndex.get<std::size_t>()];
        const nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        std::vector<Value> result(accessor["count"].get<std::size_t>());
        std::memcpy(result.data(), binary.data() + view["byteOffset"].get<std::size_t>(),
                    result.size() * sizeof(Value));
        return result;
    }
};

Glb readGlb(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof(length));
    const auto json = bytes.begin() + 20;
    return {nlohmann::json::parse(json, json + length), std::vector<char>(json + length + 8, bytes.end())};
}

TEST(Tangents, AgreeWithThoseOfAFile) {
    const std::optional<std::filesystem::path> shared = test::sharedFolder();
    if (!shared) {
        ASSERT_FALSE(test::inContinuousIntegration());
        GTEST_SKIP() << "needs the test scenes in ../shared";
    }
    const Glb glb = readGlb(*shared / "scenes/gltf/NormalTangentMirrorTest.glb");
    const nlohmann::json& primitive = glb.json["meshes"][0]["primitives"][0];
    const nlohmann::json& attributes = primitive["attributes"];
    Mesh mesh;
    mesh.positions = glb.values<Vec3f>(attributes["POSITION"]);
    mesh.normals = glb.values<Vec3f>(attributes["NORMAL"]);
    mesh.uvs = {glb.values<Vec2<float>>(attributes["TEXCOORD_0"])};
    const auto indices = glb.values<std::uint16_t>(primitive["indices"]);
    for (std::size_t i = 0; i < indices.size(); i += 3)
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    const std::vector<std::array<std::uint32_t, 3>> triangles = mesh.triangles;
    const auto expected = glb.values<glm::vec4>(attributes["TANGENT"]);
    generateTangents(mesh, 0);
    EXPECT_EQ(mesh.positions.size(), expected.size()) << "it is split where it must be";
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const glm::vec4 there = expected[triangles[i][corner]];
            const glm::vec4 here = tangentAt(mesh, i, corner);
            ASSERT_EQ(here.w, there.w) << i;
            // The exporter's float coordinates are exact to 2^-24, a thousandth apart at the least: directions to 1e-4,
            // cosines to 1e-8; the float product to some 1e-7.
            ASSERT_NEAR(glm::dot(Vec3f(there), Vec3f(here)), 1.0f, 1e-6f) << i;
        }
}

} // namespace
} // namespace isolux
