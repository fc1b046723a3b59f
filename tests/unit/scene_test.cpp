#include "scene/scene.h"

#include "core/error.h"
#include "scene/render_settings.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace isolux {
namespace {

Scene boxScaledBy(double scale) {
    Scene scene = test::furnaceScene(Vec3d(0.5), Vec3d(1.0));
    Mat4d transform(scale);
    transform[3][3] = 1.0;
    scene.instances[0].worldFromObject = transform;
    return scene;
}

TEST(Scene, CountsPrimitivesAndBounds) {
    Scene scene = boxScaledBy(2.0);
    scene.spheres.push_back({"ball", Vec3d(5.0, 0.0, 0.0), 1.0, 0});
    EXPECT_EQ(primitiveCount(scene), 13u);
    EXPECT_EQ(worldBounds(scene).lower, Vec3d(-2.0));
    EXPECT_EQ(worldBounds(scene).upper, Vec3d(6.0, 2.0, 2.0));
    EXPECT_TRUE(worldBounds(Scene{}).empty());
}

TEST(Scene, MovedAsAWhole) {
    Scene scene = boxScaledBy(2.0);
    scene.spheres.push_back({"ball", Vec3d(5.0, 0.0, 0.0), 1.0, 0});
    scene.punctualLights.push_back({"lamp", PunctualKind::point, Vec3d(1.0, 2.0, 3.0)});
    const Vec3d by(0.5, -2.0, 8.0);
    const Scene elsewhere = moved(scene, by);
    EXPECT_EQ(worldBounds(elsewhere).lower, worldBounds(scene).lower + by);
    EXPECT_EQ(worldBounds(elsewhere).upper, worldBounds(scene).upper + by);
    EXPECT_EQ(elsewhere.cameras[0].position, scene.cameras[0].position + by);
    EXPECT_EQ(elsewhere.punctualLights[0].position, Vec3d(1.5, 0.0, 11.0));
    EXPECT_EQ(elsewhere.spheres[0].center, Vec3d(5.5, -2.0, 8.0));
}

TEST(Scene, AFramedCameraSeesEverything) {
    for (const double scale : {1e-9, 1.0, 1e9}) {
        const Scene scene = boxScaledBy(scale);
        const Camera camera = frameScene(scene);
        const Mat3d cameraFromWorld = glm::transpose(camera.worldFromCamera);
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3d point(((corner & 1) != 0 ? scale : -scale), ((corner & 2) != 0 ? scale : -scale),
                              ((corner & 4) != 0 ? scale : -scale));
            const Vec3d seen = cameraFromWorld * (point - camera.position);
            ASSERT_LT(seen.z, 0.0);
            EXPECT_LE(std::abs(seen.y / seen.z), std::tan(0.5 * camera.yfov));
            EXPECT_LE(std::abs(seen.x / seen.z), std::tan(0.5 * camera.yfov));
        }
    }
}

TEST(Scene, ValidationRefusesWhatCannotBeComputed) {
    EXPECT_NO_THROW(validate(boxScaledBy(1.0)));
    EXPECT_NO_THROW(validate(boxScaledBy(1e25)));
    EXPECT_NO_THROW(validate(boxScaledBy(1e-25)));
    EXPECT_NO_THROW(validate(boxScaledBy(0.0)));
    for (const double scale :
         {1e40, 1e300, 1e-40, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(validate(boxScaledBy(scale)), Error) << scale;
    Scene scene = boxScaledBy(1.0);
    scene.meshes[0].positions[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(validate(scene), Error);
    scene = boxScaledBy(1.0);
    scene.meshes[0].triangles[2][1] = 8;
    EXPECT_THROW(validate(scene), Error);
    scene = boxScaledBy(1.0);
    scene.materials[0].baseColor.x = 1.5;
    EXPECT_THROW(validate(scene), Error);
    scene = boxScaledBy(1.0);
    scene.spheres.push_back({"ball", Vec3d(0.0), 0.0, 0});
    EXPECT_THROW(validate(scene), Error);
}

/// A point light of intensity 1 at the origin.
PunctualLight pointLight() {
    PunctualLight light;
    light.name = "bulb";
    return light;
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The message with which a box lit by `light` is refused; empty if it is not.
std::string refusal(const PunctualLight& light) {
    Scene scene = boxScaledBy(1.0);
    scene.punctualLights = {light};
    try {
        validate(scene);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(Scene, ValidationRefusesBadLights) {
    PunctualLight light = pointLight();
    EXPECT_EQ(refusal(light), "");
    for (const double number : {-1.0, kNaN, kInfinity}) {
        light = pointLight();
        light.intensity.y = number;
        EXPECT_NE(refusal(light).find("bulb"), std::string::npos) << number;
    }
    light = pointLight();
    light.position.z = kNaN;
    EXPECT_NE(refusal(light), "");
    for (const Vec3d& direction : {Vec3d(0.0), Vec3d(0.0, 0.0, 2.0), Vec3d(kNaN, 0.0, 1.0)}) {
        light = pointLight();
        light.kind = PunctualKind::directional;
        light.direction = direction;
        EXPECT_NE(refusal(light), "");
    }
    for (const double cosOuter : {0.5, 0.75, kNaN}) {
        light = pointLight();
        light.kind = PunctualKind::spot;
        light.cosInner = 0.5;
        light.cosOuter = cosOuter;
        EXPECT_NE(refusal(light), "") << cosOuter;
    }
    light.cosOuter = 0.4999;
    EXPECT_EQ(refusal(light), "");
}

TEST(Scene, ValidationRefusesBadCameras) {
    Scene scene = boxScaledBy(1.0);
    Camera& camera = scene.cameras[0];
    for (const double yfov : {0.0, -1.0, kPi, kNaN}) {
        camera.yfov = yfov;
        EXPECT_THROW(validate(scene), Error) << yfov;
    }
    camera.projection = Projection::orthographic;
    camera.yfov = 0.0; // of no concern to this one
    EXPECT_NO_THROW(validate(scene));
    for (const double ymag : {0.0, -1.0, kNaN, kInfinity}) {
        camera.ymag = ymag;
        EXPECT_THROW(validate(scene), Error) << ymag;
    }
    camera = Camera{};
    camera.position.x = kInfinity;
    EXPECT_THROW(validate(scene), Error);
}

TEST(Scene, ValidationRefusesBadEnvironments) {
    Scene scene;
    scene.environment.radiance = {1.0, 0.0, 2.0};
    EXPECT_NO_THROW(validate(scene)) << "nothing but an environment is a scene";
    for (const double number : {-1.0, kNaN, kInfinity}) {
        scene.environment.radiance.z = number;
        EXPECT_THROW(validate(scene), Error) << number;
    }
}

TEST(Scene, SpotsFadeWithTheSquareBetweenTheirCones) {
    PunctualLight light = pointLight();
    light.cosInner = 0.75;
    light.cosOuter = 0.5;
    for (const double inside : {1.0, 0.8, 0.75}) EXPECT_EQ(spotAttenuation(light, inside), 1.0);
    for (const double outside : {-1.0, 0.0, 0.49, 0.5}) EXPECT_EQ(spotAttenuation(light, outside), 0.0);
    EXPECT_EQ(spotAttenuation(light, 0.625), 0.25);
    EXPECT_EQ(spotAttenuation(light, 0.6875f), 0.5625f);
}

TEST(Scene, AnEnvironmentEmitsIfAnyChannelDoes) {
    EXPECT_FALSE(Environment{}.emits());
    EXPECT_TRUE((Environment{Vec3d(0.0, 0.0, 1e-30), EnvironmentExtent::upperHalf}.emits()));
    EXPECT_EQ((Environment{Vec3d(1.0), EnvironmentExtent::upperHalf}.solidAngle()), 2.0 * kPi);
    EXPECT_EQ((Environment{Vec3d(1.0), EnvironmentExtent::sphere}.solidAngle()), 4.0 * kPi);
}

// --- Settings ---

RenderSettings counting(BounceSelection bounces, LightPart light, Integrator integrator, std::uint32_t maxDepth) {
    RenderSettings settings;
    settings.bounces = bounces;
    settings.light = light;
    settings.integrator = integrator;
    settings.maxDepth = maxDepth;
    return settings;
}

void expectRange(const RenderSettings& settings, std::uint32_t first, std::uint32_t last) {
    const BounceRange range = countedBounces(settings);
    EXPECT_EQ(range.first, first);
    EXPECT_EQ(range.last, last);
}

TEST(RenderSettings, CountedBouncesFollowEveryChoice) {
    using enum BounceSelection;
    constexpr std::uint32_t kMany = kUnlimitedDepth;
    expectRange({}, 0, kMany);
    expectRange(counting(accumulate, LightPart::all, Integrator::path, 3), 0, 3);
    expectRange(counting(last, LightPart::all, Integrator::path, 3), 3, 3);
    expectRange(counting(last, LightPart::all, Integrator::path, 0), 0, 0);
    expectRange(counting(accumulate, LightPart::direct, Integrator::path, kMany), 0, 1);
    expectRange(counting(accumulate, LightPart::direct, Integrator::path, 0), 0, 0);
    expectRange(counting(accumulate, LightPart::indirect, Integrator::path, kMany), 2, kMany);
    expectRange(counting(last, LightPart::indirect, Integrator::path, 5), 5, 5);
    expectRange(counting(accumulate, LightPart::all, Integrator::direct, kMany), 0, 1);
}

TEST(RenderSettings, NoBounceCountsWhereChoicesExcludeEachOther) {
    using enum BounceSelection;
    for (const RenderSettings& settings : {counting(last, LightPart::direct, Integrator::path, 2),
                                           counting(accumulate, LightPart::indirect, Integrator::direct, 9),
                                           counting(accumulate, LightPart::indirect, Integrator::path, 1)}) {
        const BounceRange range = countedBounces(settings);
        EXPECT_GT(range.first, range.last);
    }
}

TEST(RenderSettings, DirectLightAndIndirectLightAreAllLight) {
    const BounceRange direct = countedBounces(counting({}, LightPart::direct, Integrator::path, 7));
    const BounceRange indirect = countedBounces(counting({}, LightPart::indirect, Integrator::path, 7));
    EXPECT_EQ(direct.first, 0u);
    EXPECT_EQ(direct.last + 1, indirect.first);
    EXPECT_EQ(indirect.last, 7u);
}

} // namespace
} // namespace isolux
