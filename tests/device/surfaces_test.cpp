// Every part of the surface model, the device against the double reference on the same random numbers.
#include "device/paired_fixture.h"
#include "support/materials.h"
#include "support/methods.h"

#include <set>

namespace isolux::test {
namespace {

RenderSettings smallImage(std::uint32_t samples) {
    return workShare() < 1.0 ? imageSettings(24, 24, samples) : imageSettings(64, 64, samples);
}

class Surfaces : public Paired, public ::testing::WithParamInterface<SurfaceCase> {};

/// Mirrors, lenses and bumps magnify rounding from bounce to bounce: fewer pixels agree to 1e-3, each explained.
TEST_P(Surfaces, AgreeWithTheReference) {
    validate(GetParam().scene);
    RenderSettings settings = smallImage(20);
    settings.backFaces = GetParam().backFaces;
    expectAgreement(GetParam().scene, settings, 0.98);
}

/// With more compiled in, the same bits. Drivers that repeat what another has done take two cases.
TEST_P(Surfaces, MoreCompiledInChangesNoBit) {
    const std::set<std::string> enough{"Mirror", "AlphaMask"};
    if (workShare() < 1.0 && !enough.contains(GetParam().name)) return;
    RenderSettings settings = imageSettings(24, 24, 8);
    settings.backFaces = GetParam().backFaces;
    const SceneFeatures needed = findFeatures(GetParam().scene, settings);
    RenderOptions options;
    options.features = moreFeatures(needed);
    EXPECT_NE(*options.features, needed);
    EXPECT_EQ(differingPixels(render(GetParam().scene, settings), render(GetParam().scene, settings, options)), 0u);
}

/// That the case tests something: without culling its shell keeps the sky off.
TEST_F(Paired, CulledBacksLetLightIn) {
    const Scene scene = surfaceScene("CulledBacks");
    RenderSettings settings = imageSettings(24, 24, 8);
    const Film shown = render(scene, settings);
    settings.backFaces = BackFaces::culled;
    const Film culled = render(scene, settings);
    EXPECT_GT(differingPixels(shown, culled), culled.pixels.size() / 2);
}

INSTANTIATE_TEST_SUITE_P(All, Surfaces, ::testing::ValuesIn(surfaceCases()),
                         [](const auto& tested) { return tested.param.name; });

/// Every way of finding light, where every lobe, map and light is.
class MethodsOnEverySurface : public Paired, public ::testing::WithParamInterface<Method> {};

TEST_P(MethodsOnEverySurface, AgreeWithTheReference) {
    RenderSettings settings = smallImage(20);
    GetParam().apply(settings);
    expectAgreement(surfaceScene("Everything"), settings, 0.98);
}

std::vector<Method> methodsThatScatter() {
    const std::set<std::string> names{"Hemisphere", "Bsdf",    "LightSampling", "FourLightSamples",
                                      "Sobol",      "Ambient", "Normals"};
    std::vector<Method> methods = allMethods();
    std::erase_if(methods, [&](const Method& method) { return !names.contains(method.name); });
    return methods;
}

INSTANTIATE_TEST_SUITE_P(All, MethodsOnEverySurface, ::testing::ValuesIn(methodsThatScatter()),
                         [](const auto& tested) { return tested.param.name; });

/// What a path keeps of a rough surface, glass and the solid it is in outlives a dispatch.
TEST_F(Paired, DispatchesChangeNoBitOnEverySurface) {
    const Scene scene = surfaceScene("Everything");
    RenderOptions options;
    options.signatures = PathSignatures::on;
    for (const std::uint32_t lightSamples : {1u, 3u}) {
        RenderSettings settings = imageSettings(16, 12, 18);
        settings.lightSamples = lightSamples;
        options.dispatchSeconds = RenderOptions{}.dispatchSeconds;
        const Film whole = render(scene, settings, options);
        options.dispatchSeconds = 1e-6;
        EXPECT_EQ(differingPixels(whole, render(scene, settings, options)), 0u) << lightSamples;
    }
}

} // namespace
} // namespace isolux::test
