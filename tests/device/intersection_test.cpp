// The device's traversal: against testing every primitive, and against rays that try to slip through.
#include "device/device_test.h"

#include "load/gltf.h"
#include "pack/packed_scene.h"
#include "render/ray_query.h"

#include "shared/interface.h"

#include <bit>
#include <random>

namespace isolux::test {
namespace {

using Rays = std::vector<shared::RayRecord>;
using Hits = std::vector<shared::HitRecord>;

class Intersection : public DeviceTest {
protected:
    Hits trace(const PackedScene& scene, const Rays& rays, RayMethod method, ReadPath path = ReadPath::automatic) {
        return RayQuery(device_, scene, method, path).trace(rays);
    }
};

class RayMaker {
public:
    explicit RayMaker(const PackedScene& scene) : scene_(scene) {}

    /// All kinds in turn: between random points in and around the scene, along axes, in the planes of boxes, from and
    /// to vertices, of very different lengths.
    Rays make(std::size_t count) {
        Rays rays;
        rays.reserve(count);
        while (rays.size() < count) rays.push_back(next(rays.size() % 6));
        return rays;
    }

    shared::RayRecord towards(const Vec3f& origin, const Vec3f& target, float length = 1.0f) const {
        return {{origin, 3e38f}, {(target - origin) * length, 0.0f}};
    }

    Vec3f vertex() {
        const shared::PrimitiveRecord& primitive = scene_.primitives[index()];
        const std::array corners{Vec3f(primitive.p0Material), Vec3f(primitive.p1Light), Vec3f(primitive.p2Id)};
        return isSphere(primitive) ? corners[0] : corners[random_() % 3];
    }

    Vec3f edgePoint() {
        const shared::PrimitiveRecord& primitive = scene_.primitives[index()];
        const std::array corners{Vec3f(primitive.p0Material), Vec3f(primitive.p1Light), Vec3f(primitive.p2Id)};
        if (isSphere(primitive)) return corners[0];
        const std::size_t i = random_() % 3;
        return glm::mix(corners[i], corners[(i + 1) % 3], unit());
    }

    Vec3f point(float size) { return size * Vec3f(2.0f * unit() - 1.0f, 2.0f * unit() - 1.0f, 2.0f * unit() - 1.0f); }

private:
    shared::RayRecord next(std::size_t kind) {
        const Vec3f origin = point(kind == 1 ? 3.0f : 1.0f);
        switch (kind) {
        case 0:
        case 1: return towards(origin, point(1.0f));
        case 2: { // along an axis, with zeros of either sign
            Vec3f direction(random_() % 2 == 0 ? 0.0f : -0.0f);
            direction[static_cast<int>(random_() % 3)] = random_() % 2 == 0 ? 1.0f : -1.0f;
            return {{origin, 3e38f}, {direction, 0.0f}};
        }
        case 3: { // in the plane of a vertex
            Vec3f direction = point(1.0f);
            const int axis = static_cast<int>(random_() % 3);
            direction[axis] = 0.0f;
            Vec3f start = origin;
            start[axis] = vertex()[axis];
            return {{start, 3e38f}, {direction, 0.0f}};
        }
        case 4: return towards(origin, vertex(), std::ldexp(1.0f, static_cast<int>(random_() % 40) - 20));
        default: return towards(edgePoint(), point(1.0f));
        }
    }

    static bool isSphere(const shared::PrimitiveRecord& primitive) {
        return (std::bit_cast<std::uint32_t>(primitive.p2Id.w) & shared::kSphereBit) != 0;
    }
    std::size_t index() { return random_() % scene_.primitives.size(); }
    float unit() { return std::uniform_real_distribution<float>(0.0f, 1.0f)(random_); }

    const PackedScene& scene_;
    std::mt19937 random_{42};
};

struct Disagreement {
    std::size_t count = 0;
    std::size_t hits = 0;
    std::size_t unfinished = 0;
};

/// The nearest distances must be the same to the last bit, and of several primitives at it the same is named.
Disagreement disagreement(const Hits& a, const Hits& b) {
    Disagreement result;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool hitA = a[i].primitive.x != shared::kNone;
        if (hitA) ++result.hits;
        if (a[i].primitive.y == 0 || b[i].primitive.y == 0) ++result.unfinished;
        if (a[i].primitive.x != b[i].primitive.x || (hitA && a[i].distance.x != b[i].distance.x)) ++result.count;
    }
    return result;
}

class BvhAgainstBruteForce : public Intersection {
protected:
    void expectSameHits(const std::filesystem::path& file, double totalTests) {
        const PackedScene scene = packScene(loadScene(file));
        const double rayCount = std::min(1e6, totalTests / static_cast<double>(scene.primitives.size()));
        const auto count = static_cast<std::size_t>(std::max(100.0, rayCount * workShare()));
        const Rays rays = RayMaker(scene).make(count);
        const Disagreement result =
            disagreement(trace(scene, rays, RayMethod::bvh), trace(scene, rays, RayMethod::bruteForce));
        EXPECT_EQ(result.count, 0u) << file << ": of " << count << " rays, " << result.hits << " hits";
        EXPECT_EQ(result.unfinished, 0u) << file;
        EXPECT_GT(result.hits, count / 20) << file;
    }
};

constexpr double kAllTests = 2e9;

TEST_F(BvhAgainstBruteForce, CornellBox) { expectSameHits(projectScene("cornell_box"), kAllTests); }
TEST_F(BvhAgainstBruteForce, CornellSpheres) { expectSameHits(projectScene("cornell_spheres"), kAllTests); }
TEST_F(BvhAgainstBruteForce, Furnace) { expectSameHits(projectScene("furnace"), kAllTests); }
TEST_F(BvhAgainstBruteForce, Blob) { expectSameHits(blobScene(), kAllTests); }

/// Needs the collection of scenes beside the checkout. A fiftieth of the tests, all of them with --long.
TEST_F(BvhAgainstBruteForce, SeedScenes) {
    const auto folder = sharedFolder();
    if (!folder && inContinuousIntegration()) FAIL() << "../shared is missing";
    if (!folder) GTEST_SKIP() << "needs the scenes of ../shared, which are not part of the project";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder / "scenes" / "seed"))
        if (entry.path().extension() == ".glb") expectSameHits(entry.path(), longTests() ? kAllTests : kAllTests / 50);
}

TEST_F(Intersection, StorageBuffersFindTheSame) {
    const PackedScene scene = packScene(loadScene(projectScene("cornell_spheres")));
    const Rays rays = RayMaker(scene).make(20'000);
    const Hits texels = trace(scene, rays, RayMethod::bvh, ReadPath::texelBuffers);
    EXPECT_EQ(disagreement(texels, trace(scene, rays, RayMethod::bvh, ReadPath::storageBuffers)).count, 0u);
}

/// From inside the blob's closed room every ray must hit something, also those aimed at edges and vertices.
TEST_F(Intersection, ClosedMeshesAreWatertight) {
    const PackedScene scene = packScene(loadScene(blobScene()));
    RayMaker maker(scene);
    Rays rays;
    const int count = static_cast<int>(1e6 * workShare());
    for (int i = 0; i < count; ++i) {
        const Vec3f origin = maker.point(0.3f);
        rays.push_back(maker.towards(origin, i % 2 == 0 ? maker.vertex() : maker.edgePoint()));
    }
    std::size_t escaped = 0;
    for (const shared::HitRecord& hit : trace(scene, rays, RayMethod::bvh))
        if (hit.primitive.x == shared::kNone) ++escaped;
    EXPECT_EQ(escaped, 0u);
}

} // namespace
} // namespace isolux::test
