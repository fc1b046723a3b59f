// The matrices of image files against points whose place in the image is known.
#include "scene/camera_matrices.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

void expectNear(const Vec3d& actual, const Vec3d& expected) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], 1e-12);
}

Vec3d apply(const Mat4d& matrix, const Vec3d& point) {
    const glm::dvec4 transformed = matrix * glm::dvec4(point, 1.0);
    return Vec3d(transformed) / transformed.w;
}

/// Looks along +x of the world from (1, 2, 3), with +y up: right is +z.
Camera sidewaysCamera() {
    Camera camera;
    camera.position = Vec3d(1.0, 2.0, 3.0);
    camera.worldFromCamera = Mat3d(Vec3d(0, 0, 1), Vec3d(0, 1, 0), Vec3d(-1, 0, 0));
    camera.yfov = kPi / 2;
    camera.ymag = 4.0;
    return camera;
}

TEST(CameraMatrices, CameraSpaceIsLeftHandedWithZAhead) {
    const Mat4d matrix = cameraFromWorld(sidewaysCamera());
    expectNear(apply(matrix, Vec3d(1, 2, 3)), Vec3d(0));
    expectNear(apply(matrix, Vec3d(6, 2, 3)), Vec3d(0, 0, 5));
    expectNear(apply(matrix, Vec3d(1, 2, 4)), Vec3d(1, 0, 0));
    expectNear(apply(matrix, Vec3d(1, 4, 3)), Vec3d(0, 2, 0));
}

TEST(CameraMatrices, PerspectiveReachesTheCorners) {
    const Mat4d matrix = ndcFromWorld(sidewaysCamera(), 2.0);
    // At distance 10 half the height is 10 and half the width 20.
    expectNear(apply(matrix, Vec3d(11, 2, 3)), Vec3d(0.5, 0.5, 0.1));
    expectNear(apply(matrix, Vec3d(11, 12, -17)), Vec3d(0, 0, 0.1));
    expectNear(apply(matrix, Vec3d(11, -8, 23)), Vec3d(1, 1, 0.1));
}

TEST(CameraMatrices, OrthographicReachesTheCorners) {
    Camera camera = sidewaysCamera();
    camera.projection = Projection::orthographic;
    const Mat4d matrix = ndcFromWorld(camera, 2.0);
    expectNear(apply(matrix, Vec3d(11, 2, 3)), Vec3d(0.5, 0.5, 10));
    expectNear(apply(matrix, Vec3d(11, 6, -5)), Vec3d(0, 0, 10));
    expectNear(apply(matrix, Vec3d(-9, -2, 11)), Vec3d(1, 1, -10));
}

} // namespace
} // namespace isolux
