// One renderer for many seeds, and what a caller sees of a render on the way: passes, and a way to end it.
#include "device/device_test.h"

#include "load/gltf.h"

#include <vector>

namespace isolux::test {
namespace {

class Seeds : public DeviceTest {};

TEST_F(Seeds, AreThoseOfARendererOfTheirOwn) {
    const Scene scene = loadScene(projectScene("cornell_spheres"));
    RenderSettings settings = imageSettings(24, 16, 20);
    PathRenderer renderer(device_, scene, settings, {});
    for (const std::uint64_t seed : {std::uint64_t{3}, std::uint64_t{5} << 32 | 1, std::uint64_t{0}}) {
        settings.seed = seed;
        Film film(settings.width, settings.height);
        renderer.setSeed(seed);
        renderer.render(film, [](double) { return Continue::yes; });
        EXPECT_EQ(differingPixels(film, render(scene, settings)), 0u) << seed;
    }
}

TEST_F(Seeds, CallersSeeEveryPassAndMayEndTheRender) {
    const Scene scene = loadScene(projectScene("cornell_spheres"));
    const RenderSettings settings = imageSettings(24, 16, 200);
    std::vector<std::uint64_t> seen;
    RenderOptions options;
    options.firstPasses = FirstPasses::growing;
    options.pass = [&](const Film& film) {
        seen.push_back(film.minSampleCount());
        EXPECT_EQ(film.minSampleCount(), film.maxSampleCount());
        return seen.back() < 64 ? Continue::yes : Continue::no;
    };
    const Film film = render(scene, settings, options);
    EXPECT_EQ(seen, (std::vector<std::uint64_t>{1, 2, 4, 8, 16, 32, 48, 64}));
    // The same samples in passes of other sizes: their sums, up to 16 of them in single precision, round differently.
    const Film whole = render(scene, imageSettings(24, 16, 64));
    EXPECT_EQ(film.rays, whole.rays);
    for (std::size_t i = 0; i < film.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(film.pixels[i].mean[c], whole.pixels[i].mean[c], 32 * 0x1p-24 * whole.pixels[i].mean[c]);
}

} // namespace
} // namespace isolux::test
