// Surfaces at the same spot on the device: they are as one, bit for bit, and as the reference has them.
#include "device/paired_fixture.h"

#include "support/coincident.h"

namespace isolux::test {
namespace {

RenderSettings shortPaths(LightSampling sampling) {
    RenderSettings settings = imageSettings(64, 64, 16);
    settings.lightSampling = sampling;
    settings.maxDepth = 12;
    return settings;
}

class Coincident : public Paired {
protected:
    void expectSameFilm(const Scene& doubled, const Scene& single, const RenderSettings& settings) {
        EXPECT_EQ(differingPixels(render(doubled, settings), render(single, settings)), 0u);
    }

    /// Under a white environment scattered rays that leave a floor find it whatever way they take: no variance.
    void expectAlbedo(const Scene& scene) {
        const Film film = render(scene, shortPaths(LightSampling::bsdf));
        for (const PixelStatistics& pixel : film.pixels) ASSERT_EQ(pixel.mean, kFloorAlbedo);
    }
};

TEST_F(Coincident, FloorsReflectAsOne) {
    for (const Lie lie : {Lie::level, Lie::askew})
        for (const Copies copies : {Copies::one, Copies::two, Copies::three})
            expectAlbedo(floorScene(copies, LitBy::environment, lie));
}

TEST_F(Coincident, TileInAFloorsPlaneReflectsAsTheFloor) { expectAlbedo(tiledFloorScene(LitBy::environment)); }

TEST_F(Coincident, FloorsAreTheSameFilmAsOne) {
    for (const LitBy light : {LitBy::environment, LitBy::lamp})
        for (const Lie lie : {Lie::level, Lie::askew})
            expectSameFilm(floorScene(Copies::three, light, lie), floorScene(Copies::one, light, lie),
                           shortPaths(LightSampling::mis));
}

TEST_F(Coincident, WithoutABvhToo) {
    RenderSettings settings = shortPaths(LightSampling::mis);
    settings.intersection.acceleration = Acceleration::none;
    expectSameFilm(floorScene(Copies::two, LitBy::lamp, Lie::level), floorScene(Copies::one, LitBy::lamp, Lie::level),
                   settings);
}

TEST_F(Coincident, GlassIsTheSameFilmAsOne) {
    for (const LitBy light : {LitBy::environment, LitBy::lamp})
        for (const double thickness : {0.0, 1.0})
            expectSameFilm(slabScene(Copies::two, light, thickness), slabScene(Copies::one, light, thickness),
                           shortPaths(LightSampling::mis));
}

TEST_F(Coincident, AgreesWithTheReference) {
    const RenderSettings settings = shortPaths(LightSampling::mis);
    for (const LitBy light : {LitBy::environment, LitBy::lamp}) {
        expectAgreement(floorScene(Copies::two, light, Lie::level), settings);
        expectAgreement(tiledFloorScene(light), settings);
        for (const double thickness : {0.0, 1.0})
            expectAgreement(slabScene(Copies::two, light, thickness), settings, 0.99);
    }
}

} // namespace
} // namespace isolux::test
