#include "scene/scene.h"

#include "core/error.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

} // namespace
} // namespace isolux
