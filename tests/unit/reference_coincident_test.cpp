// Surfaces at the same spot in the reference: they are as one, and reflect what one of them reflects.
#include "support/coincident.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

RenderSettings shortPaths(LightSampling sampling) {
    RenderSettings settings = smallSettings(16);
    settings.lightSampling = sampling;
    settings.maxDepth = 12;
    return settings;
}

class CoincidentInReference : public ::testing::TestWithParam<Precision> {
protected:
    static void expectAlbedo(const Scene& scene) {
        const Film film = render(scene, shortPaths(LightSampling::bsdf), {GetParam()});
        for (const PixelStatistics& pixel : film.pixels) ASSERT_EQ(pixel.mean, kFloorAlbedo);
    }
    static void expectSameFilm(const Scene& doubled, const Scene& single) {
        const RenderSettings settings = shortPaths(LightSampling::mis);
        const Film a = render(doubled, settings, {GetParam()});
        const Film b = render(single, settings, {GetParam()});
        for (std::size_t i = 0; i < a.pixels.size(); ++i) ASSERT_TRUE(a.pixels[i] == b.pixels[i]) << "pixel " << i;
    }
};

INSTANTIATE_TEST_SUITE_P(Precisions, CoincidentInReference,
                         ::testing::Values(Precision::singlePrecision, Precision::doublePrecision));

TEST_P(CoincidentInReference, FloorsReflectAsOne) {
    for (const Lie lie : {Lie::level, Lie::askew})
        for (const Copies copies : {Copies::one, Copies::two, Copies::three})
            expectAlbedo(floorScene(copies, LitBy::environment, lie));
    expectAlbedo(tiledFloorScene(LitBy::environment));
}

TEST_P(CoincidentInReference, CopiesAreTheSameFilmAsOne) {
    for (const LitBy light : {LitBy::environment, LitBy::lamp}) {
        for (const Lie lie : {Lie::level, Lie::askew})
            expectSameFilm(floorScene(Copies::three, light, lie), floorScene(Copies::one, light, lie));
        for (const double thickness : {0.0, 1.0})
            expectSameFilm(slabScene(Copies::two, light, thickness), slabScene(Copies::one, light, thickness));
    }
}

} // namespace
} // namespace isolux
