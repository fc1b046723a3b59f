// Every scene of the collection beside the checkout renders: without a fault, and not black.
#include "core/log.h"
#include "load/gltf.h"
#include "support/render.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace isolux::test {
namespace {

TEST(SeedScenes, AllRender) {
    const auto shared = sharedFolder();
    if (!shared && !inContinuousIntegration()) GTEST_SKIP() << "../shared is not here";
    ASSERT_TRUE(shared) << "../shared is missing";
    setVerbosity(Verbosity::quiet);
    const Device device({});
    RenderSettings settings;
    settings.width = 64;
    settings.height = 48;
    settings.sampleCount = 4;
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*shared / "scenes" / "seed")) {
        if (entry.path().extension() != ".glb") continue;
        ++count;
        const Scene scene = loadScene(entry.path());
        SCOPED_TRACE(entry.path());
        const Film film = renderOnDevice(device, scene, settings);
        EXPECT_EQ(film.minSampleCount(), settings.sampleCount);
        std::size_t lit = 0;
        for (const PixelStatistics& pixel : film.pixels) lit += luminance(pixel.mean) > 0.0 ? 1 : 0;
        EXPECT_GT(lit, film.pixels.size() / 20);
    }
    EXPECT_EQ(count, 21);
}

} // namespace
} // namespace isolux::test
