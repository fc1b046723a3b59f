// The layers of an image: what each holds, and that files keep all of them.
#include "film_fixture.h"

#include "film/cryptomatte.h"
#include "film/layers.h"

#include <cmath>

namespace isolux {
namespace {

using namespace film_test;

const LayerSet kAll{Layer::variance, Layer::samples, Layer::albedo,  Layer::normal,
                    Layer::depth,    Layer::object,  Layer::material};

TEST(Layers, AreReadFromAList) {
    EXPECT_EQ(parseLayers("all"), kAll);
    EXPECT_EQ(parseLayers("none"), LayerSet());
    EXPECT_EQ(parseLayers("albedo"), LayerSet{Layer::albedo});
    EXPECT_EQ(parseLayers("depth,object,depth"), (LayerSet{Layer::object, Layer::depth}));
    EXPECT_EQ(parseLayers("variance,samples,albedo,normal,depth,object,material"), kAll);
}

TEST(Layers, UnknownWordsAreNamed) {
    for (const char* list : {"depth,albeto", "", "depth,", ",depth", "depth albedo", "all,depth", "Depth"})
        expectMentions(errorOf(ExitCode::badInput, [&] { (void)parseLayers(list); }),
                       "variance, samples, albedo, normal, depth, object, material, or all or none alone");
    expectMentions(errorOf(ExitCode::badInput, [] { (void)parseLayers("depth,albeto"); }), "\"albeto\"");
}

TEST(Layers, SomeNeedFirstHits) {
    EXPECT_FALSE(needsAovs({}));
    EXPECT_FALSE(needsAovs({Layer::variance, Layer::samples}));
    for (const Layer layer : {Layer::albedo, Layer::normal, Layer::depth, Layer::object, Layer::material})
        EXPECT_TRUE(needsAovs({Layer::samples, layer}));
}

/// Pixel 0: four samples, of which two meet "ball" and one meets an object without a name. Pixel 1: four that meet
/// nothing. Pixel 2: none at all.
Film threePixels() {
    Film film(3, 1);
    film.keepAovs();
    for (int sample = 0; sample < 4; ++sample) {
        film.pixels[0].add({1.0, 2.0, 3.0});
        film.pixels[1].add({0.0, 0.0, 0.0});
    }
    film.pixels[0].hitCount = 3;
    film.aovs[0].add({{0.5, 0.25, 1.0}, {0.0, 0.0, 1.0}, 2.0, 1});
    film.aovs[0].add({{0.5, 0.25, 1.0}, {0.0, 1.0, 0.0}, 3.0, 1});
    film.aovs[0].add({{1.0, 1.0, 1.0}, {0.0, 0.0, -1.0}, 7.0, 2});
    return film;
}

ObjectNames threeNames() { return {{"floor", "ball", ""}, {"paint", "paint", ""}}; }

/// The value of a channel that must be there.
float channelValue(const Image& image, std::size_t pixel, std::string_view name) {
    const auto channel = image.channel(name);
    EXPECT_TRUE(channel) << name;
    return channel ? image.value(pixel, *channel) : NAN;
}

void expectPixel(const Image& image, std::size_t pixel, const std::vector<std::pair<const char*, float>>& expected) {
    for (const auto& [name, value] : expected) EXPECT_EQ(channelValue(image, pixel, name), value) << name;
}

TEST(ImageFromFilm, LeavesOutWhatIsNotAskedFor) {
    const Image image = imageFromFilm(threePixels(), {}, {}, {});
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(image.metadata.size(), 1u);
    const Image depth = imageFromFilm(threePixels(), {Layer::samples, Layer::depth}, {}, {});
    EXPECT_EQ(depth.channels, (std::vector<std::string>{"R", "G", "B", "A", "Z", "samples.Y"}));
}

TEST(ImageFromFilm, HoldsEveryLayer) {
    const Image image = imageFromFilm(threePixels(), kAll, threeNames(), {});
    EXPECT_EQ(image.channels.size(), 24u);
    expectPixel(image, 0, {{"R", 1.0f}, {"G", 2.0f}, {"B", 3.0f}, {"A", 0.75f}, {"samples.Y", 4.0f}, {"Z", 4.0f}});
    expectPixel(image, 0, {{"albedo.R", 0.5f}, {"albedo.G", 0.375f}, {"albedo.B", 0.75f}});
    expectPixel(image, 0, {{"normal.X", 0.0f}, {"normal.Y", 0.25f}, {"normal.Z", 0.0f}});
    for (const std::size_t pixel : {1, 2}) {
        for (std::size_t c = 0; c < image.channels.size(); ++c) {
            const float expected = image.channels[c] == "Z"                         ? INFINITY
                                   : image.channels[c] == "samples.Y" && pixel == 1 ? 4.0f
                                                                                    : 0.0f;
            EXPECT_EQ(image.value(pixel, c), expected) << image.channels[c] << " of " << pixel;
        }
    }
}

TEST(ImageFromFilm, HoldsObjectsAndMaterials) {
    const Image image = imageFromFilm(threePixels(), kAll, threeNames(), {});
    expectPixel(image, 0,
                {{"CryptoObject00.R", cryptomatteId("ball")},
                 {"CryptoObject00.G", 0.5f},
                 {"CryptoObject00.B", cryptomatteId("object 2")},
                 {"CryptoObject00.A", 0.25f},
                 {"CryptoMaterial00.R", cryptomatteId("paint")},
                 {"CryptoMaterial00.G", 0.5f},
                 {"CryptoMaterial00.B", cryptomatteId("material of object 2")},
                 {"CryptoMaterial00.A", 0.25f}});
    expectMentions(*metadataText(image.metadata, "cryptomatte/3ae39a5/manifest"), "\"object 2\"");
    expectMentions(*metadataText(image.metadata, "cryptomatte/3ae39a5/manifest"), "\"floor\"");
    expectMentions(*metadataText(image.metadata, "cryptomatte/be359d6/manifest"), "\"paint\"");
}

TEST(ImageFromFilm, NamesObjectsThatHaveNone) {
    const Image image = imageFromFilm(threePixels(), {Layer::object}, {}, {});
    EXPECT_EQ(channelValue(image, 0, "CryptoObject00.R"), cryptomatteId("object 1"));
}

/// A pixel of seven objects: four layers of two ranks, the last rank empty; nothing is dropped.
Film sevenObjects() {
    Film film(1, 1);
    film.keepAovs();
    for (std::uint32_t object = 0; object < 7; ++object) {
        for (std::uint32_t sample = 0; sample <= object; ++sample) {
            film.pixels[0].add(Vec3d(0.5));
            film.aovs[0].add({Vec3d(1.0), {0.0, 1.0, 0.0}, 1.0, object});
        }
    }
    return film;
}

TEST(ImageFromFilm, DropsNoObject) {
    const Image image = imageFromFilm(sevenObjects(), {Layer::object}, {}, {});
    EXPECT_EQ(image.channels.size(), 4u + 16u);
    EXPECT_EQ(channelValue(image, 0, "CryptoObject00.R"), cryptomatteId("object 6"));
    EXPECT_EQ(channelValue(image, 0, "CryptoObject00.G"), 7.0f / 28.0f);
    EXPECT_EQ(channelValue(image, 0, "CryptoObject03.R"), cryptomatteId("object 0"));
    EXPECT_EQ(channelValue(image, 0, "CryptoObject03.G"), 1.0f / 28.0f);
    EXPECT_EQ(channelValue(image, 0, "CryptoObject03.B"), 0.0f);
    EXPECT_EQ(channelValue(image, 0, "CryptoObject03.A"), 0.0f);
}

// --- Files ---

/// Ids are bit patterns: one bit less and no name is found.
TEST_F(ImageFile, ExrKeepsEveryLayerToTheBit) {
    Film film = makeFilm(24, 16, 4);
    film.keepAovs();
    std::mt19937 engine(5);
    for (PixelAovs& pixel : film.aovs) {
        for (int sample = 0; sample < 4; ++sample)
            pixel.add({Vec3d(0.5), {0.0, 1.0, 0.0}, 0.1 * sample, static_cast<std::uint32_t>(engine() % 40)});
    }
    const Image written = imageFromFilm(film, kAll, {}, {});
    EXPECT_EQ(written.channels.size(), 32u);
    writeImage(path("a.exr"), written);
    const Image read = readImage(path("a.exr"));
    EXPECT_EQ(read.channels.size(), written.channels.size());
    for (std::size_t c = 0; c < written.channels.size(); ++c) {
        for (std::size_t pixel = 0; pixel < written.pixelCount(); ++pixel)
            ASSERT_EQ(channelValue(read, pixel, written.channels[c]), written.value(pixel, c)) << written.channels[c];
    }
    for (const auto& [name, value] : written.metadata) EXPECT_EQ(read.metadata.at(name), value) << name;
}

TEST_F(ImageFile, ManyChannelsAreWrittenWholeOrNotAtAll) {
    Film film(1, 1);
    film.keepAovs();
    for (std::uint32_t object = 0; object < 600; ++object) film.aovs[0].addCoverage(object, 1);
    film.pixels[0].sampleCount = 600;
    const Image image = imageFromFilm(film, kAll, {}, {});
    EXPECT_EQ(image.channels.size(), 16u + 2u * 4u * kMostLayers) << "objects and materials, four channels a layer";
    writeImage(path("a.exr"), image);
    EXPECT_EQ(channelValue(readImage(path("a.exr")), 0, "CryptoObject15.A"), 1.0f / 600.0f);
    const std::string before = readBytes(path("a.exr"));
    {
        const FileSizeLimit limit(2000);
        expectMentions(errorOf(ExitCode::failure, [&] { writeImage(path("a.exr"), image); }), "too large");
    }
    EXPECT_EQ(readBytes(path("a.exr")), before);
    EXPECT_EQ(fileCount(), 1u);
}

/// What decodes channels that a file does not have would mislead.
TEST_F(ImageFile, PngLeavesOutWhatDecodesItsMissingLayers) {
    writeImage(path("a.png"), imageFromFilm(threePixels(), kAll, threeNames(), {{"isolux/seed", std::int64_t{1}}}));
    const Metadata metadata = readImage(path("a.png")).metadata;
    EXPECT_TRUE(metadata.contains("isolux/seed"));
    for (const auto& entry : metadata) EXPECT_FALSE(entry.first.starts_with("cryptomatte")) << entry.first;
}

TEST_F(ImageFile, ExrKeepsMatricesUnderTheNamesGiven) {
    Mat4d cameraFromWorld(1.0);
    cameraFromWorld[1][0] = 0.25;                           // column 1, row 0
    cameraFromWorld[3] = glm::dvec4(10.0, 20.0, 30.0, 1.0); // the translation
    Image image = onePixel(1, 2, 3);
    for (const char* name : {"worldToCamera", "worldToNDC", "isolux/other"})
        image.metadata[name] = matrixMetadata(cameraFromWorld);
    const MetadataMatrix expected{1, 0, 0, 0, 0.25f, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1};
    EXPECT_EQ(image.metadata["worldToCamera"], MetadataValue(expected)) << "row vectors: the last row translates";
    writeImage(path("a.exr"), image);
    const Metadata read = readImage(path("a.exr")).metadata;
    for (const auto& [name, value] : image.metadata) {
        ASSERT_TRUE(read.contains(name)) << name;
        EXPECT_EQ(read.at(name), value) << name;
    }
    EXPECT_EQ(metadataText(read, "worldToCamera"), "1 0 0 0 0.25 1 0 0 0 0 1 0 10 20 30 1");
    EXPECT_EQ(metadataUnsigned(read, "worldToCamera"), std::nullopt);
}

} // namespace
} // namespace isolux
