// Which triangles lie at the same spot, found in scenes of a few and of many.
#include "load/gltf.h"
#include "pack/coincident.h"
#include "pack/scene_features.h"
#include "support/coincident.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace isolux {
namespace {

using namespace test;
using Triangles = std::vector<TriangleCorners>;

Coincidence outcome(const Triangles& triangles) { return findCoincident(triangles).outcome; }

/// Two triangles, a rectangle in the plane y = height, cut from its lowest corner to its highest.
void addRectangle(Triangles& triangles, const Vec2<float>& low, const Vec2<float>& high, float height = 0.0f) {
    const Vec3f a(low.x, height, low.y);
    const Vec3f b(high.x, height, low.y);
    const Vec3f c(high.x, height, high.y);
    const Vec3f d(low.x, height, high.y);
    triangles.push_back({a, c, b});
    triangles.push_back({a, d, c});
}

/// Turned so that no coordinate is a round number; rounded to float.
TriangleCorners turned(const TriangleCorners& triangle) {
    const Vec3d axis = glm::normalize(Vec3d(0.3, 0.5, 0.8));
    TriangleCorners result;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d p(triangle[i]);
        const double angle = 0.7; // Rodrigues
        result[i] = Vec3f(p * std::cos(angle) + glm::cross(axis, p) * std::sin(angle) +
                          axis * (glm::dot(axis, p) * (1.0 - std::cos(angle))));
    }
    return result;
}

Triangles turned(Triangles triangles) {
    for (TriangleCorners& triangle : triangles) triangle = turned(triangle);
    return triangles;
}

const TriangleCorners kPiece{Vec3f(-0.3f, 0.1f, 0.2f), Vec3f(0.5f, 0.25f, -0.4f), Vec3f(0.1f, -0.6f, 0.35f)};

TEST(CoincidentTriangles, NoneOfFew) {
    EXPECT_EQ(outcome({}), Coincidence::none);
    EXPECT_EQ(outcome({kPiece}), Coincidence::none);
    EXPECT_EQ(outcome({kPiece, turned(kPiece)}), Coincidence::none);
}

TEST(CoincidentTriangles, CopiesHoweverTurned) {
    const auto& [a, b, c] = kPiece;
    for (const TriangleCorners& copy : {kPiece, TriangleCorners{b, c, a}, TriangleCorners{a, c, b}}) {
        const CoincidentTriangles found = findCoincident(Triangles{turned(kPiece), kPiece, copy});
        EXPECT_EQ(found.outcome, Coincidence::found);
        EXPECT_EQ(found.pair, (std::array<std::uint32_t, 2>{1, 2}));
    }
}

TEST(CoincidentTriangles, TileInAFloor) {
    Triangles triangles;
    addRectangle(triangles, {-1, -1}, {1, 1});
    EXPECT_EQ(outcome(triangles), Coincidence::none);
    addRectangle(triangles, {0.3f, -0.2f}, {0.4f, -0.1f});
    EXPECT_EQ(outcome(triangles), Coincidence::found);
    EXPECT_EQ(outcome(turned(triangles)), Coincidence::found);
}

TEST(CoincidentTriangles, TileOverAFloor) {
    Triangles triangles;
    addRectangle(triangles, {-1, -1}, {1, 1});
    addRectangle(triangles, {0.3f, -0.2f}, {0.4f, -0.1f}, 1e-3f);
    EXPECT_EQ(outcome(triangles), Coincidence::none);
    EXPECT_EQ(outcome(turned(triangles)), Coincidence::none);
    triangles.resize(2);
    addRectangle(triangles, {0.3f, -0.2f}, {0.4f, -0.1f}, 1e-7f); // closer than the rounding of what lies askew
    EXPECT_EQ(outcome(triangles), Coincidence::found);
}

/// In one plane, with an edge or a corner in common, to the bit: level and askew.
TEST(CoincidentTriangles, NeighboursDoNotOverlap) {
    Triangles triangles;
    for (int x = -3; x < 3; ++x)
        for (int z = -3; z < 3; ++z)
            addRectangle(triangles, 0.3f * Vec2<float>(x, z), 0.3f * Vec2<float>(x + 1, z + 1), 0.1f);
    EXPECT_EQ(outcome(triangles), Coincidence::none);
    EXPECT_EQ(outcome(turned(triangles)), Coincidence::none);
}

/// Corners in the middle of a neighbour's edge: no overlap where they are exactly on it; askew rounding decides, and an
/// overlap by its last bit counts.
TEST(CoincidentTriangles, CornersOnEdges) {
    Triangles triangles;
    addRectangle(triangles, {-1, -1}, {1, 0});
    addRectangle(triangles, {-1, 0}, {0.125f, 1});
    addRectangle(triangles, {0.125f, 0}, {1, 1});
    EXPECT_EQ(outcome(triangles), Coincidence::none);
    triangles[2][0].z = triangles[3][0].z = triangles[2][2].z = -1e-7f;
    EXPECT_EQ(outcome(triangles), Coincidence::found);
}

/// Two rectangles that overlap in a strip, each rounded in a place of its own.
TEST(CoincidentTriangles, OverlapAskew) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-0.5f, 0.5f);
    for (int i = 0; i < 200; ++i) {
        Triangles triangles;
        const Vec2<float> low(place(random) - 0.6f, place(random) - 0.6f);
        addRectangle(triangles, low, low + 0.5f, place(random));
        const float height = triangles[0][0].y;
        addRectangle(triangles, low + 0.49f, low + 0.9f, height);
        EXPECT_EQ(outcome(turned(triangles)), Coincidence::found) << i;
        triangles.resize(2);
        addRectangle(triangles, low + 0.51f, low + 0.9f, height);
        EXPECT_EQ(outcome(turned(triangles)), Coincidence::none) << i;
    }
}

/// A small and a large triangle of a plane: found although the small one's own plane misses most of the large one.
TEST(CoincidentTriangles, CrumbInAPlane) {
    for (const float size : {1e-2f, 1e-4f, 1e-6f}) {
        Triangles triangles;
        addRectangle(triangles, {-1, -1}, {1, 1}, 0.25f);
        addRectangle(triangles, Vec2<float>(0.3f, 0.1f), Vec2<float>(0.3f + size, 0.1f + size), 0.25f);
        EXPECT_EQ(outcome(turned(triangles)), Coincidence::found) << size;
    }
}

TEST(CoincidentTriangles, Needles) {
    const TriangleCorners needle{Vec3f(-0.5f, 0, 0), Vec3f(0.5f, 0, 0), Vec3f(0.1f, 0, 1e-6f)};
    const TriangleCorners beside{Vec3f(-0.5f, 0, 0), Vec3f(0.5f, 0, 0), Vec3f(0.1f, 0, -0.5f)};
    const TriangleCorners beneath{Vec3f(-0.5f, 0, 0), Vec3f(0.5f, 0, 0), Vec3f(0.1f, 0, 0.5f)};
    const TriangleCorners upright{Vec3f(-0.5f, 0, 0), Vec3f(0.5f, 0, 0), Vec3f(0.1f, 0.5f, 0)};
    EXPECT_EQ(outcome({needle, beside}), Coincidence::none);
    EXPECT_EQ(outcome({needle, upright}), Coincidence::none);
    EXPECT_EQ(outcome({needle, beneath}), Coincidence::found);
    EXPECT_EQ(outcome({turned(needle), turned(beneath)}), Coincidence::found);
    EXPECT_EQ(outcome({needle, needle}), Coincidence::found);
}

/// No ray meets them.
TEST(CoincidentTriangles, WithoutAreaNoneCounts) {
    const auto& [a, b, c] = kPiece;
    for (const TriangleCorners& empty : {TriangleCorners{a, a, b}, TriangleCorners{a, b, b}, TriangleCorners{c, a, c},
                                         TriangleCorners{a, a, a}, TriangleCorners{a, Vec3f(0.0f), -a}})
        EXPECT_EQ(outcome({empty, kPiece, empty}), Coincidence::none);
}

/// The faces of a thin box are found to be apart down to what rounding leaves of its thickness.
TEST(CoincidentTriangles, SheetsApart) {
    for (const float apart : {1e-2f, 1e-4f}) {
        Triangles triangles;
        addRectangle(triangles, {-1, -1}, {1, 1}, 0.5f);
        addRectangle(triangles, {-1, -1}, {1, 1}, 0.5f + apart);
        EXPECT_EQ(outcome(turned(triangles)), Coincidence::none) << apart;
    }
}

/// Every pair against the search in a tree: scattered triangles, of which in half of the cases two overlap in a plane.
TEST(CoincidentTriangles, FindsTheOneAmongMany) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-1.0f, 1.0f);
    const auto point = [&](float size) { return size * Vec3f(place(random), place(random), place(random)); };
    for (int i = 0; i < 50; ++i) {
        Triangles triangles;
        for (int k = 0; k < 1000; ++k) {
            const Vec3f center = point(0.8f);
            triangles.push_back({center + point(0.1f), center + point(0.1f), center + point(0.1f)});
        }
        EXPECT_EQ(outcome(triangles), Coincidence::none);
        const auto from = static_cast<std::uint32_t>(random() % 1000);
        const auto& [a, b, c] = triangles[from];
        triangles.push_back({0.5f * (a + b), 0.5f * (b + c), 0.5f * (c + a)});
        const CoincidentTriangles found = findCoincident(triangles);
        EXPECT_EQ(found.outcome, Coincidence::found);
        EXPECT_EQ(found.pair, (std::array<std::uint32_t, 2>{from, 1000}));
    }
}

/// However many lie at one spot, and where very many only touch, the search ends soon.
TEST(CoincidentTriangles, WorstCasesEndSoon) {
    EXPECT_EQ(outcome(Triangles(200000, kPiece)), Coincidence::found);
    Triangles fan; // all boxes overlap, no triangles do
    constexpr int kBlades = 20000;
    for (int i = 0; i < kBlades; ++i) {
        const auto angle = static_cast<float>(i) * (2.0f * 3.14159f / kBlades);
        const Vec3f out(std::cos(angle), 0.0f, std::sin(angle));
        fan.push_back({Vec3f(0, -1, 0), Vec3f(0, 1, 0), out});
    }
    EXPECT_NE(outcome(fan), Coincidence::found);
}

bool needsCoincident(const Scene& scene) { return findFeatures(scene, {}).coincident; }

TEST(CoincidentTriangles, OfScenes) {
    for (const Lie lie : {Lie::level, Lie::askew}) {
        EXPECT_FALSE(needsCoincident(floorScene(Copies::one, LitBy::environment, lie)));
        EXPECT_TRUE(needsCoincident(floorScene(Copies::two, LitBy::environment, lie)));
    }
    EXPECT_TRUE(needsCoincident(tiledFloorScene(LitBy::environment)));
    EXPECT_FALSE(needsCoincident(slabScene(Copies::one, LitBy::lamp, 1.0)));
    EXPECT_TRUE(needsCoincident(slabScene(Copies::two, LitBy::lamp, 1.0)));
    for (const char* name : {"cornell_box", "cornell_spheres", "furnace"})
        EXPECT_FALSE(needsCoincident(loadScene(projectScene(name)))) << name;
}

TEST(CoincidentTriangles, ExplainsWhich) {
    const auto reasonOf = [](const Scene& scene) {
        for (const FeatureNote& note : explainFeatures(scene, {}))
            if (note.name == "coincident") return note.reason;
        return std::string();
    };
    EXPECT_EQ(reasonOf(floorScene(Copies::one, LitBy::environment, Lie::askew)), "no two triangles overlap in a plane");
    EXPECT_EQ(reasonOf(floorScene(Copies::two, LitBy::environment, Lie::askew)),
              "triangles 0 and 2 lie at the same spot");
}

/// The unit of length decides nothing.
TEST(CoincidentTriangles, ScaledScenes) {
    for (const double scale : {0x1p-30, 0x1p30})
        for (const Copies copies : {Copies::one, Copies::two}) {
            Scene scene = floorScene(copies, LitBy::environment, Lie::askew);
            Mat4d scaling(1.0);
            for (int axis = 0; axis < 3; ++axis) scaling[axis][axis] = scale;
            for (Instance& instance : scene.instances) instance.worldFromObject = scaling * instance.worldFromObject;
            for (Camera& camera : scene.cameras) camera.position *= scale;
            EXPECT_EQ(needsCoincident(scene), copies == Copies::two) << scale;
        }
}

} // namespace
} // namespace isolux
