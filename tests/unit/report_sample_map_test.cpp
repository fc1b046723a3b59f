// Maps of samples: the ramp from none to the most, the counts and the scale beside it, as files keep them.
#include "film_fixture.h"
#include "report/heatmap.h"
#include "report/sample_map.h"

namespace isolux {
namespace {

using namespace film_test;

/// A row of pixels that took 0, 1, ... width - 1 samples.
Film rampFilm(std::uint32_t width) {
    Film film(width, 1);
    for (std::uint32_t x = 0; x < width; ++x) film.pixels[x].sampleCount = x;
    return film;
}

TEST(SampleMap, RunsFromNoneToTheMost) {
    const Image map = sampleMap(rampFilm(65), 64);
    EXPECT_EQ(map.channels, (std::vector<std::string>{"R", "G", "B", "samples.Y"}));
    for (std::uint32_t x = 0; x < 65; ++x) {
        const Vec3f expected(rampColor(Ramp::sequential, x / 64.0));
        for (int c = 0; c < 3; ++c) EXPECT_EQ(map.value(x, static_cast<std::size_t>(c)), expected[c]) << x;
        EXPECT_EQ(map.value(x, 3), static_cast<float>(x));
    }
    EXPECT_EQ(metadataUnsigned(map.metadata, "isolux/sampleMapMax"), 64u);
}

TEST(SampleMap, NoSamplesAreDarkWhateverTheMost) {
    for (const std::uint64_t most : {0u, 1u}) {
        const Image map = sampleMap(Film(1, 1), most);
        EXPECT_EQ(map.value(0, 0), static_cast<float>(rampColor(Ramp::sequential, 0.0).x));
    }
}

TEST_F(ImageFile, SampleMapsSayTheirScaleInEveryFormatThatCan) {
    for (const char* name : {"map.png", "map.exr"}) {
        writeImage(path(name), sampleMap(rampFilm(9), 8));
        const Image read = readImage(path(name));
        EXPECT_EQ(metadataUnsigned(read.metadata, "isolux/sampleMapMax"), 8u) << name;
        EXPECT_NEAR(read.value(8, 1), rampColor(Ramp::sequential, 1.0).y, 0.01) << name;
    }
}

} // namespace
} // namespace isolux
