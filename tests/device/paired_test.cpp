// The device against the double reference on the same random numbers.
#include "device/paired_fixture.h"

#include "load/gltf.h"

#include <cmath>

namespace isolux::test {
namespace {

/// 256 x 256, less where another driver has done that.
RenderSettings pairedImage() {
    const std::uint32_t edge = workShare() < 1.0 ? 96 : 256;
    return imageSettings(edge, edge, 16);
}

TEST_F(Paired, CornellBox) { expectAgreement(loadScene(projectScene("cornell_box")), pairedImage()); }

TEST_F(Paired, CornellSpheres) { expectAgreement(loadScene(projectScene("cornell_spheres")), pairedImage()); }

TEST_F(Paired, Furnace) { expectAgreement(loadScene(projectScene("furnace")), imageSettings(64, 64, 32)); }

/// Bounces between bumps amplify rounding from one to the next: fewer pixels agree to 1e-3, each explained.
TEST_F(Paired, Blob) { expectAgreement(loadScene(blobScene()), imageSettings(128, 96, 16), 0.99); }

TEST_F(Paired, DepthsAndSampleRanges) {
    const Scene scene = loadScene(projectScene("cornell_spheres"));
    for (const std::uint32_t depth : {0u, 1u, 2u, 5u}) {
        RenderSettings settings = imageSettings(48, 64, 20);
        settings.maxDepth = depth;
        settings.firstSample = 1000;
        settings.seed = 0x123456789abcdefull;
        const PairedDifferences differences = compare(scene, settings);
        SCOPED_TRACE(toText(differences));
        EXPECT_EQ(differences.unexplained, 0u) << "depth " << depth;
        EXPECT_GT(differences.litPixels, 0u);
    }
}

/// Spheres that emit: seen from outside and, the camera being inside the largest, from inside; one lit from both faces.
TEST_F(Paired, SphereLights) {
    Scene scene = furnaceScene(Vec3d(0.6, 0.4, 0.2), Vec3d(0.0));
    scene.materials.push_back({"bulb", Vec3d(0.3), Vec3d(9.0, 5.0, 1.0), false});
    scene.materials.push_back({"shell", Vec3d(0.5), Vec3d(0.2, 0.3, 0.4), true});
    scene.spheres = {{"small", Vec3d(-0.5, 0.4, -0.6), 0.01, 1},
                     {"large", Vec3d(0.5, -0.4, -0.5), 0.35, 1},
                     {"around the camera", scene.cameras[0].position, 0.25, 2}};
    expectAgreement(scene, imageSettings(96, 96, 16));
    scene.spheres.pop_back();
    expectAgreement(scene, imageSettings(96, 96, 16));
}

/// Emissive triangles without area, with an area that float cannot square, or that collapses where the scene is large:
/// none may turn into another light or give a NaN.
TEST_F(Paired, DegenerateTriangles) {
    Scene scene = furnaceScene(Vec3d(0.5, 0.4, 0.3), Vec3d(0.0));
    scene.materials.push_back({"lamp", Vec3d(0.2), Vec3d(40.0), true});
    Mesh lamp;
    lamp.name = "lamp";
    lamp.material = 1;
    lamp.positions = {{0, 0.9f, 0}, {0.3f, 0.9f, 0}, {0, 0.9f, 0.3f}, {0.6f, 0.9f, 0}, {0.9f, 0.5f, 0.7f}};
    lamp.triangles = {{0, 1, 2}, {0, 1, 3}, {4, 4, 4}, {0, 1, 1}};
    Mesh crumb = lamp;
    crumb.triangles = {{0, 1, 2}};
    scene.meshes.push_back(lamp);
    scene.meshes.push_back(crumb);
    scene.instances.push_back({"lamp", 1, Mat4d(1.0)});
    for (const double size : {1e-3, 1e-7, 1e-12, 1e-20}) {
        Mat4d transform(size);
        transform[3] = glm::dvec4(0.31, -0.41, -0.53, 1.0);
        scene.instances.push_back({"crumb", 2, transform});
    }
    expectAgreement(scene, imageSettings(64, 64, 32));
}

/// Faces square to the axis of a camera far away lie in the very plane that the scene ends with: rays start before it.
TEST_F(Paired, FarFaceSquareToTheCamera) {
    Scene scene;
    scene.name = "a poster far away";
    scene.materials.push_back({"white", Vec3d(0.5)});
    Mesh square;
    square.name = "square";
    square.positions = {{-1, -1, 0.3f}, {1, -1, 0.3f}, {1, 1, 0.3f}, {-1, 1, 0.3f}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back(square);
    scene.instances.push_back({"square", 0, Mat4d(1.0)});
    scene.environment.radiance = Vec3d(1.0);
    for (const double distance : {20.0, 100.0, 1e5}) {
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            Camera camera;
            camera.projection = projection;
            camera.position = Vec3d(0.0, 0.0, distance);
            camera.yfov = 2.0 * std::atan(1.5 / distance);
            camera.ymag = 1.5;
            scene.cameras = {camera};
            SCOPED_TRACE(distance);
            expectAgreement(scene, imageSettings(24, 24, 8));
        }
    }
}

/// Mirrored, rotated and sheared instances of a smooth mesh, shared between them.
TEST_F(Paired, InstancesWithNegativeScale) {
    Scene scene = loadScene(projectScene("cornell_spheres"));
    Mesh mesh;
    mesh.name = "smooth tetrahedron";
    mesh.positions = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
    for (const Vec3f& position : mesh.positions) mesh.normals.push_back(glm::normalize(position));
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    mesh.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back({"lamp", Vec3d(0.7, 0.6, 0.5), Vec3d(1.5), false});
    const auto meshIndex = static_cast<std::uint32_t>(scene.meshes.size());
    scene.meshes.push_back(mesh);
    const Vec3d center = worldBounds(scene).center();
    const double size = 0.08 * maxComponent(worldBounds(scene).extent());
    for (const Vec3d scale : {Vec3d(1, 1, 1), Vec3d(-1, 1, 1), Vec3d(-1, -0.5, -2)}) {
        Mat4d transform(1.0);
        for (int axis = 0; axis < 3; ++axis) transform[axis][axis] = size * scale[axis];
        transform[1][0] = 0.3 * size; // a shear
        transform[3] = glm::dvec4(center + Vec3d(scale.x + scale.z, scale.y, 0.0) * (1.5 * size), 1.0);
        scene.instances.push_back({"tetrahedron", meshIndex, transform});
    }
    expectAgreement(scene, imageSettings(128, 128, 16));
}

} // namespace
} // namespace isolux::test
