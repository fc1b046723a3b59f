// The image is a function of scene, settings and sample range alone: not of dispatches, tiles, buffers or features.
#include "device/device_test.h"

#include "load/gltf.h"

#include <cmath>

namespace isolux::test {
namespace {

class Determinism : public DeviceTest {};

TEST_F(Determinism, DispatchesAndTilesDoNotChangeABit) {
    const Scene scene = loadScene(projectScene("cornell_spheres"));
    const RenderSettings settings = imageSettings(67, 45, 20); // no multiple of anything
    RenderOptions options;
    options.signatures = PathSignatures::on;
    const Film whole = render(scene, settings, options);
    // So short that paths are stopped in the middle of traversals, again and again.
    options.dispatchSeconds = 1e-6;
    EXPECT_EQ(differingPixels(whole, render(scene, settings, options)), 0u);
    options.dispatchSeconds = RenderOptions{}.dispatchSeconds;
    options.maxLanes = 256;
    EXPECT_EQ(differingPixels(whole, render(scene, settings, options)), 0u);
}

TEST_F(Determinism, HalvesAverageToTheWhole) {
    const Scene scene = loadScene(projectScene("cornell_box"));
    RenderSettings settings = imageSettings(48, 48, 64);
    const Film whole = render(scene, settings);
    settings.sampleCount = 32;
    Film joined = render(scene, settings);
    settings.firstSample = 32;
    const Film second = render(scene, settings);
    EXPECT_EQ(joined.rays + second.rays, whole.rays);
    for (std::size_t i = 0; i < joined.pixels.size(); ++i) {
        joined.pixels[i].merge(second.pixels[i]);
        EXPECT_EQ(joined.pixels[i].sampleCount, whole.pixels[i].sampleCount);
        EXPECT_EQ(joined.pixels[i].hitCount, whole.pixels[i].hitCount);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(joined.pixels[i].mean[c], whole.pixels[i].mean[c], 1e-12 * (1.0 + whole.pixels[i].mean[c]));
            EXPECT_NEAR(joined.pixels[i].variance()[c], whole.pixels[i].variance()[c],
                        1e-10 * (1.0 + whole.pixels[i].variance()[c]));
        }
    }
}

TEST_F(Determinism, TexelAndStorageBuffersGiveTheSameBits) {
    const Scene scene = loadScene(projectScene("cornell_spheres"));
    const RenderSettings settings = imageSettings(64, 64, 16);
    RenderOptions texels;
    texels.readPath = ReadPath::texelBuffers;
    RenderOptions storage;
    storage.readPath = ReadPath::storageBuffers;
    EXPECT_EQ(differingPixels(render(scene, settings, texels), render(scene, settings, storage)), 0u);
}

/// Everything on against what the scene needs, and every single feature that it does not need.
TEST_F(Determinism, LeavingOutWhatASceneDoesNotNeedChangesNothing) {
    Scene oneLight = furnaceScene(Vec3d(0.5), Vec3d(0.0));
    oneLight.materials.push_back({"bulb", Vec3d(0.0), Vec3d(5.0), false});
    oneLight.spheres = {{"bulb", Vec3d(0.2, 0.3, -0.5), 0.1, 1}};
    RenderSettings shallow = imageSettings(40, 40, 16);
    shallow.maxDepth = 3; // roulette cannot be reached
    const RenderSettings deep = imageSettings(40, 40, 16);
    const std::vector<std::pair<Scene, RenderSettings>> cases{{loadScene(projectScene("cornell_box")), deep},
                                                              {loadScene(projectScene("cornell_box")), shallow},
                                                              {loadScene(projectScene("cornell_spheres")), deep},
                                                              {loadScene(projectScene("furnace")), deep},
                                                              {oneLight, deep},
                                                              {furnaceScene(Vec3d(0.5), Vec3d(0.0)), shallow}};
    std::size_t leftOut = 0;
    for (const auto& [scene, settings] : cases) {
        const SceneFeatures needed = findFeatures(scene, settings);
        const SceneFeatures everything = moreFeatures(needed);
        leftOut += (needed == everything) ? 0 : 1;
        RenderOptions options;
        options.features = everything;
        const Film full = render(scene, settings, options);
        options.features = needed;
        EXPECT_EQ(differingPixels(full, render(scene, settings, options)), 0u) << scene.name;
    }
    EXPECT_EQ(leftOut, cases.size());
}

TEST_F(Determinism, ScalingByAPowerOfTwoChangesNothing) {
    Scene scene = loadScene(projectScene("cornell_box"));
    const RenderSettings settings = imageSettings(48, 48, 16);
    const Film film = render(scene, settings);
    for (const double scale : {std::ldexp(1.0, -30), std::ldexp(1.0, 30)}) {
        Scene scaled = scene;
        Mat4d scaling(1.0);
        for (int axis = 0; axis < 3; ++axis) scaling[axis][axis] = scale;
        for (Instance& instance : scaled.instances) instance.worldFromObject = scaling * instance.worldFromObject;
        for (Camera& camera : scaled.cameras) camera.position *= scale;
        EXPECT_EQ(differingPixels(film, render(scaled, settings)), 0u) << scale;
    }
}

/// Radiance in any unit: the same image times a power of two, its variance too, though single precision holds neither.
TEST_F(Determinism, ScalingLightByAPowerOfTwoChangesNothing) {
    Scene scene = loadScene(projectScene("courtyard"));
    const RenderSettings settings = imageSettings(48, 36, 16);
    const Film film = render(scene, settings);
    for (const int exponent : {-120, 120}) {
        const double factor = std::ldexp(1.0, exponent);
        Scene scaled = scene;
        scaled.environment.radiance *= factor;
        for (PunctualLight& light : scaled.punctualLights) light.intensity *= factor;
        Film other = render(scaled, settings);
        for (PixelStatistics& pixel : other.pixels) {
            pixel.mean /= factor;
            pixel.squaredDeviation /= factor * factor;
            pixel.luminanceSquaredDeviation /= factor * factor;
        }
        EXPECT_EQ(differingPixels(film, other), 0u) << exponent;
    }
}

TEST_F(Determinism, AnInterruptedRenderKeepsWholeTiles) {
    const Scene scene = loadScene(projectScene("cornell_box"));
    const RenderSettings settings = imageSettings(64, 64, 64);
    const Film whole = render(scene, settings);
    Film film(settings.width, settings.height);
    RenderOptions options;
    options.maxLanes = 1024;
    PathRenderer renderer(device_, scene, settings, options);
    renderer.render(film, [](double fraction) { return fraction > 0.4 ? Continue::no : Continue::yes; });
    EXPECT_GT(film.minSampleCount(), 0u);
    EXPECT_LT(film.minSampleCount(), settings.sampleCount);
    for (const PixelStatistics& pixel : film.pixels) EXPECT_EQ(pixel.sampleCount % SamplePlan::kLargestPass, 0u);
}

/// A time limit decides how many samples there are, and nothing else: every pixel has as many, at least one.
TEST_F(Determinism, ATimeLimitStopsAllPixelsAtTheSameSample) {
    const Scene scene = loadScene(projectScene("cornell_box"));
    RenderSettings settings = imageSettings(64, 64, 1u << 20);
    RenderOptions options;
    options.maxLanes = 1024;
    for (const double seconds : {0.0, 1.0}) {
        options.stopping.seconds = seconds;
        const Film film = render(scene, settings, options);
        EXPECT_GE(film.minSampleCount(), 1u);
        EXPECT_EQ(film.minSampleCount(), film.maxSampleCount());
        EXPECT_LT(film.maxSampleCount(), settings.sampleCount);
        if (seconds == 0.0) {
            EXPECT_EQ(film.maxSampleCount(), 1u);
        }
        // Batches differ in size, so that sums differ in rounding alone: 2^-24 of a sum of some tens of samples.
        settings.sampleCount = static_cast<std::uint32_t>(film.maxSampleCount());
        const Film whole = render(scene, settings);
        settings.sampleCount = 1u << 20;
        for (std::size_t i = 0; i < film.pixels.size(); ++i)
            EXPECT_NEAR(luminance(film.pixels[i].mean), luminance(whole.pixels[i].mean),
                        64 * 6e-8 * (1.0 + luminance(whole.pixels[i].mean)));
    }
}

} // namespace
} // namespace isolux::test
