// Punctual lights, the environment, orthographic cameras and first hits: the device against the reference, path by
// path.
#include "device/paired_fixture.h"
#include "support/materials.h"
#include "support/methods.h"

#include "load/gltf.h"

namespace isolux::test {
namespace {

class Lights : public Paired {
protected:
    /// The Cornell spheres with their lamp switched off: three walls, a floor, two spheres, an open front.
    [[nodiscard]] static Scene darkRoom() {
        Scene scene = loadScene(projectScene("cornell_spheres"));
        for (Material& material : scene.materials) material.emission = Vec3d(0.0);
        return scene;
    }
};

TEST_F(Lights, EachPunctualKind) {
    for (const PunctualKind kind : {PunctualKind::point, PunctualKind::spot, PunctualKind::directional}) {
        Scene scene = darkRoom();
        scene.punctualLights = {punctualLight(kind, Vec3d(0.3, 1.7, 0.2), Vec3d(3.0, 2.0, 1.0))};
        SCOPED_TRACE(static_cast<int>(kind));
        expectAgreement(scene, imageSettings(96, 96, 16));
    }
}

TEST_F(Lights, Environment) {
    for (const EnvironmentExtent extent : {EnvironmentExtent::sphere, EnvironmentExtent::upperHalf}) {
        Scene scene = darkRoom();
        scene.environment = {Vec3d(0.9, 1.0, 1.2), extent};
        SCOPED_TRACE(static_cast<int>(extent));
        expectAgreement(scene, imageSettings(96, 96, 16));
    }
}

/// The device's scales must be numbers that it has, and so must what they multiply.
TEST_F(Lights, EnvironmentMapsOfAnyBrightness) {
    Scene scene = darkRoom();
    for (const double radiance : {1.0, 1e-30, 1e30}) {
        for (const float texel : {1e-40f, 1e-20f, 1e36f}) {
            if (!(radiance * texel < 1e37)) continue; // beyond what an image holds
            // The device's scale ends at 2^126: light of 1e-70 is 1e-32 there, and dim pixels of it are no normal
            // numbers, which drivers may take for 0.
            if (radiance * texel < 1e-60) continue;
            EnvironmentMap map = skyMap();
            for (Vec3f& t : map.texels) t = t / 30.0f * texel;
            scene.environment = {Vec3d(radiance), EnvironmentExtent::sphere,
                                 std::make_shared<EnvironmentMap>(std::move(map)), 0.2};
            SCOPED_TRACE(std::to_string(std::log10(radiance)) + " " + std::to_string(std::log10(texel)));
            expectAgreement(scene, imageSettings(24, 24, 8));
        }
    }
}

/// Every kind in one table, and a directional light from outside the room.
TEST_F(Lights, AllTogether) {
    Scene scene = mixedLightsScene();
    scene.environment.extent = EnvironmentExtent::upperHalf;
    expectAgreement(scene, imageSettings(96, 96, 16));
}

/// As a file brings them: sun, lamp, spot and sky, in perspective and as an orthographic plan.
TEST_F(Lights, Courtyard) {
    const Scene scene = loadScene(projectScene("courtyard"));
    RenderSettings settings = imageSettings(96, 72, 16);
    for (settings.camera = 0; settings.camera < 2; ++settings.camera) expectAgreement(scene, settings);
}

/// Nothing but environment: every pixel shows it, in either projection.
TEST_F(Lights, EnvironmentWithoutAnySurface) {
    Scene scene;
    scene.environment = {Vec3d(0.25, 0.5, 1.0), EnvironmentExtent::sphere};
    scene.cameras = {Camera{}};
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        scene.cameras[0].projection = projection;
        for (const PixelStatistics& pixel : render(scene, imageSettings(16, 16, 4)).pixels) {
            EXPECT_EQ(pixel.mean, Vec3d(0.25, 0.5, 1.0));
            EXPECT_EQ(pixel.hitCount, 4u);
        }
    }
}

TEST_F(Lights, OrthographicCamera) {
    Scene scene = loadScene(projectScene("cornell_spheres"));
    scene.cameras[0].projection = Projection::orthographic;
    scene.cameras[0].ymag = 1.1;
    scene.cameras[0].position = Vec3d(0.1, 1.0, 30.0);
    expectAgreement(scene, imageSettings(120, 96, 16));
}

/// Lamps set into the planes of walls: the wall does not block them.
TEST_F(Lights, InTheirSurfaces) {
    for (const Vec3d& position : {Vec3d(0.3, 2.0, 0.2), Vec3d(-1.0, 1.0, 0.0)}) {
        Scene scene = darkRoom();
        scene.punctualLights = {punctualLight(PunctualKind::point, position, Vec3d(2.0))};
        SCOPED_TRACE(testing::Message() << position.x << ' ' << position.y << ' ' << position.z);
        // Blocked by its own wall it would leave the room black, which is no agreement either.
        expectAgreement(scene, imageSettings(64, 64, 16));
    }
}

/// A point light's fall-off is in the world's unit, whatever the device's; a power of two must not change a bit.
TEST_F(Lights, FallOffFollowsTheWorldsScale) {
    Scene scene = darkRoom();
    scene.punctualLights = {punctualLight(PunctualKind::point, Vec3d(0.3, 1.7, 0.2), Vec3d(3.0))};
    const RenderSettings settings = imageSettings(48, 48, 8);
    const Film film = render(scene, settings);
    const double scale = 1024.0;
    Mat4d scaling(1.0);
    for (int axis = 0; axis < 3; ++axis) scaling[axis][axis] = scale;
    for (Instance& instance : scene.instances) instance.worldFromObject = scaling * instance.worldFromObject;
    for (Sphere& sphere : scene.spheres)
        sphere = {sphere.name, sphere.center * scale, sphere.radius * scale, sphere.material};
    scene.cameras[0].position *= scale;
    scene.punctualLights[0].position *= scale;
    scene.punctualLights[0].intensity *= scale * scale;
    EXPECT_EQ(differingPixels(film, render(scene, settings)), 0u);
}

TEST_F(Lights, LeavingKindsOutChangesNothing) {
    Scene punctual = darkRoom();
    punctual.punctualLights = {punctualLight(PunctualKind::spot, Vec3d(0.3, 1.7, 0.2), Vec3d(3.0)),
                               punctualLight(PunctualKind::point, Vec3d(-0.3, 1.0, 0.2), Vec3d(1.0))};
    Scene environment = darkRoom();
    environment.environment.radiance = Vec3d(1.0);
    for (const Scene& scene : {punctual, environment}) {
        const RenderSettings settings = imageSettings(40, 40, 16);
        RenderOptions options;
        options.features = moreFeatures(findFeatures(scene, settings));
        const Film full = render(scene, settings, options);
        EXPECT_FALSE(findFeatures(scene, settings) == *options.features);
        EXPECT_EQ(differingPixels(full, render(scene, settings)), 0u);
    }
}

class FirstHits : public Paired {
protected:
    /// What a sample's normal and depth may differ by, each component.
    struct Tolerance {
        double normal;
        double depth;
    };

    /// The same camera rays on both sides: coverage and albedo to the last roundings, normal and depth to `tolerance`.
    void expectSameHits(const Scene& scene, const Tolerance& tolerance) {
        constexpr std::uint32_t kSamples = 20;
        const RenderSettings settings = imageSettings(64, 48, kSamples);
        RenderOptions options;
        options.aovs = Aovs::on;
        const Film film = render(scene, settings, options);
        const Film reference =
            renderReference(scene, settings, {Precision::doublePrecision, PathSignatures::off, Aovs::on}, {});
        ASSERT_EQ(film.aovs.size(), film.pixels.size());
        std::size_t otherObjects = 0;
        for (std::size_t i = 0; i < film.aovs.size(); ++i) {
            const PixelAovs& a = film.aovs[i];
            const PixelAovs& b = reference.aovs[i];
            if (!(a.objects == b.objects)) {
                ++otherObjects; // a ray that passes an edge within rounding, on one side or the other
                continue;
            }
            // A batch adds up 16 floats of at most 1: 15 roundings of at most 16 u.
            EXPECT_LT(maxComponent(glm::abs(a.albedo - b.albedo)), 16 * 16 * 6e-8);
            EXPECT_LT(maxComponent(glm::abs(a.normal - b.normal)), kSamples * tolerance.normal);
            EXPECT_NEAR(a.depth, b.depth, kSamples * tolerance.depth);
        }
        // Edges cover about one pixel in ten; rounding moves them by some 1e-6 of the image's width, 1e-4 pixels.
        EXPECT_LE(otherObjects, 2u);
    }

    /// In either projection; the perspective camera is 5 units of device space away from the farthest point.
    void expectSameHitsInBothProjections(Scene scene, const Tolerance& tolerance) {
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            scene.cameras[0].projection = projection;
            expectSameHits(scene, tolerance);
        }
    }
};

/// The ray's direction is off by some 4 u and its hit by that times the distance of 5, and where a wall is met at a
/// slope of 1 in 4 by four times as much along the axis: 80 u, beside the 22 u of the point and the difference itself.
/// Walls have their normals to a few u.
TEST_F(FirstHits, OfFlatSurfacesAreThoseOfTheReference) {
    expectSameHitsInBothProjections(loadScene(projectScene("cornell_box")), {16 * 6e-8, 128 * 6e-8});
}

/// Towards a sphere's outline the hit moves without bound: the sideways error of a ray, delta = 20 u, moves the normal
/// by at most sqrt(2 delta / radius) = 2.6e-3, and the depth by that times the radius.
TEST_F(FirstHits, OfSpheresAreThoseOfTheReference) {
    expectSameHitsInBothProjections(loadScene(projectScene("cornell_spheres")), {2.6e-3, 1.1e-3});
}

TEST_F(FirstHits, CostTheImageNotABit) {
    const Scene scene = loadScene(projectScene("cornell_spheres"));
    const RenderSettings settings = imageSettings(67, 45, 20);
    const Film without = render(scene, settings);
    RenderOptions options;
    options.aovs = Aovs::on;
    options.dispatchSeconds = 1e-6;
    const Film with = render(scene, settings, options);
    EXPECT_TRUE(without.aovs.empty());
    EXPECT_EQ(differingPixels(without, with), 0u);
    for (std::size_t i = 0; i < with.aovs.size(); ++i) EXPECT_EQ(with.aovs[i].hitCount(), with.pixels[i].hitCount);
}

} // namespace
} // namespace isolux::test
