// Film statistics and image files: what is written is what is read, and no failure costs the file that was there.
#include "film_fixture.h"

#include "core/log.h"
#include "core/srgb.h"

#include <spdlog/sinks/ostream_sink.h>

#include <cmath>
#include <memory>
#include <span>
#include <sstream>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace isolux {
namespace {

using namespace film_test;

// --- Statistics ---

double twoPassVariance(const std::vector<double>& values) {
    long double sum = 0.0L;
    for (const double value : values) sum += value;
    const long double center = sum / static_cast<long double>(values.size());
    long double squares = 0.0L;
    for (const double value : values) squares += (value - center) * (value - center);
    return static_cast<double>(squares / static_cast<long double>(values.size() - 1));
}

/// Values whose spread is 1e-9 of their mean: sums of squares would lose it all.
std::vector<double> nastyValues(std::size_t count) {
    std::mt19937 engine(3);
    std::normal_distribution<double> noise(1e6, 1e-3);
    std::vector<double> values(count);
    for (double& value : values) value = noise(engine);
    return values;
}

PixelStatistics accumulate(std::span<const double> values) {
    PixelStatistics pixel;
    for (const double value : values) pixel.add(Vec3d(value, 2.0 * value, 0.5 * value));
    return pixel;
}

TEST(PixelStatistics, VarianceOfNastyValuesMatchesTwoPasses) {
    const std::vector<double> values = nastyValues(10000);
    const PixelStatistics pixel = accumulate(values);
    const double expected = twoPassVariance(values);
    EXPECT_NEAR(pixel.mean.x, 1e6, 1e-4);
    EXPECT_NEAR(pixel.variance().x / expected, 1.0, 1e-6);
    EXPECT_NEAR(pixel.variance().y / expected, 4.0, 4e-6);
    const double scale = 0.2126 + 2.0 * 0.7152 + 0.5 * 0.0722;
    EXPECT_NEAR(pixel.luminanceVariance() / expected, scale * scale, 4e-6);
}

TEST(PixelStatistics, MergedPartsEqualTheWhole) {
    const std::vector<double> values = nastyValues(9999);
    const std::span<const double> all(values);
    const PixelStatistics whole = accumulate(all);
    for (const std::size_t split : {std::size_t{0}, std::size_t{1}, std::size_t{5000}, std::size_t{9999}}) {
        PixelStatistics merged = accumulate(all.first(split));
        merged.merge(accumulate(all.subspan(split)));
        EXPECT_EQ(merged.sampleCount, whole.sampleCount);
        EXPECT_NEAR(merged.mean.x, whole.mean.x, 1e-8);
        EXPECT_NEAR(merged.variance().x / whole.variance().x, 1.0, 1e-6);
        EXPECT_NEAR(merged.luminanceVariance() / whole.luminanceVariance(), 1.0, 1e-6);
    }
}

TEST(PixelStatistics, FewerThanTwoSamplesHaveNoVariance) {
    PixelStatistics pixel;
    EXPECT_EQ(pixel.variance(), Vec3d(0.0));
    pixel.add(Vec3d(3.0));
    EXPECT_EQ(pixel.variance(), Vec3d(0.0));
    EXPECT_EQ(pixel.luminanceVariance(), 0.0);
}

// --- Images of films ---

TEST(ImageFromFilm, HoldsMeanCoverageVarianceAndCount) {
    Film film(2, 1);
    film.pixels[0].add({1.0, 2.0, 3.0});
    film.pixels[0].add({3.0, 2.0, 5.0});
    film.pixels[0].hitCount = 1;
    const Image image = imageFromFilm(film, {{"isolux/seed", std::int64_t{5}}});
    const std::vector<std::string> names{"R",          "G",          "B",          "A",        "variance.R",
                                         "variance.G", "variance.B", "variance.Y", "samples.Y"};
    EXPECT_EQ(image.channels, names);
    const double varianceY = 2.0 * std::pow(0.2126 + 0.0722, 2.0);
    const std::vector<float> expected{2.0f, 2.0f, 4.0f, 0.5f, 2.0f, 0.0f, 2.0f, static_cast<float>(varianceY), 2.0f};
    for (std::size_t c = 0; c < expected.size(); ++c) {
        EXPECT_FLOAT_EQ(image.value(0, c), expected[c]) << names[c];
        EXPECT_EQ(image.value(1, c), 0.0f) << names[c] << " of a pixel without samples";
    }
    EXPECT_EQ(metadataUnsigned(image.metadata, "isolux/seed"), 5u);
    EXPECT_EQ(metadataUnsigned(image.metadata, "isolux/sampleCount"), 2u);
}

TEST(Metadata, UnsignedNumbersSurviveAnySize) {
    const std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
    const Metadata metadata{
        {"small", unsignedMetadata(7)}, {"large", unsignedMetadata(largest)}, {"word", "7x"}, {"half", 0.5}};
    EXPECT_EQ(metadataUnsigned(metadata, "small"), 7u);
    EXPECT_EQ(metadataUnsigned(metadata, "large"), largest);
    EXPECT_EQ(metadataUnsigned(metadata, "word"), std::nullopt);
    EXPECT_EQ(metadataUnsigned(metadata, "half"), std::nullopt);
    EXPECT_EQ(metadataUnsigned(metadata, "none"), std::nullopt);
    EXPECT_EQ(metadataText(metadata, "half"), "0.5");
    EXPECT_EQ(metadataText(metadata, "large"), "18446744073709551615");
}

// --- EXR ---

TEST_F(ImageFile, ExrKeepsEveryChannelToTheBit) {
    const Image written = imageFromFilm(makeFilm(13, 7, 5), {});
    writeImage(path("a.exr"), written);
    const Image read = readImage(path("a.exr"));
    ASSERT_EQ(read.width, 13u);
    ASSERT_EQ(read.height, 7u);
    ASSERT_EQ(read.channels.size(), written.channels.size());
    for (std::size_t c = 0; c < written.channels.size(); ++c) {
        const auto found = read.channel(written.channels[c]);
        ASSERT_TRUE(found) << written.channels[c];
        for (std::size_t pixel = 0; pixel < written.pixelCount(); ++pixel) {
            ASSERT_EQ(read.value(pixel, *found), written.value(pixel, c)) << written.channels[c] << " of " << pixel;
        }
    }
    EXPECT_EQ(fileCount(), 1u);
}

TEST_F(ImageFile, ExrKeepsRgbaFirst) {
    writeImage(path("a.exr"), imageFromFilm(makeFilm(2, 2, 2), {}));
    const std::vector<std::string> channels = readImage(path("a.exr")).channels;
    ASSERT_GE(channels.size(), 4u);
    EXPECT_EQ(std::vector<std::string>(channels.begin(), channels.begin() + 4),
              (std::vector<std::string>{"R", "G", "B", "A"}));
}

TEST_F(ImageFile, ExrKeepsNonFiniteAndNegativeValues) {
    writeImage(path("a.exr"), onePixel(NAN, INFINITY, -1.5f));
    const Image read = readImage(path("a.exr"));
    EXPECT_TRUE(std::isnan(read.value(0, *read.channel("R"))));
    EXPECT_EQ(read.value(0, *read.channel("G")), INFINITY);
    EXPECT_EQ(read.value(0, *read.channel("B")), -1.5f);
}

TEST_F(ImageFile, ExrKeepsMetadataAndItsTypes) {
    Image image = onePixel(1, 2, 3);
    image.metadata = {{"samplesPerPixel", std::int64_t{64}},
                      {"renderTimeSeconds", 1.0 / 3.0},
                      {"isolux/seed", unsignedMetadata(std::numeric_limits<std::uint64_t>::max())},
                      {"isolux/sampleFirst", std::int64_t{1} << 40},
                      {"isolux/sampleCount", std::int64_t{-3}},
                      {"isolux/sceneHash", "0123456789abcdef"},
                      {"isolux/options", "--spp 64 \"a b\" \xC3\xA9"},
                      {"isolux/aNameOfMoreThanThirtyOneCharacters", "long"}};
    writeImage(path("a.exr"), image);
    const Metadata read = readImage(path("a.exr")).metadata;
    Metadata expected = image.metadata;
    expected["isolux/sampleFirst"] = "1099511627776"; // EXR integers have 32 bits
    for (const auto& [name, value] : expected) {
        ASSERT_TRUE(read.contains(name)) << name;
        EXPECT_EQ(read.at(name), value) << name;
    }
    EXPECT_EQ(metadataUnsigned(read, "isolux/sampleFirst"), std::uint64_t{1} << 40);
    EXPECT_FALSE(read.contains("compression"));
}

TEST_F(ImageFile, ReadMetadataCanBeWrittenAgain) {
    Image image = onePixel(1, 2, 3);
    image.metadata = {{"isolux/seed", std::int64_t{1}}};
    writeImage(path("a.exr"), image);
    const Image first = readImage(path("a.exr"));
    writeImage(path("b.exr"), first);
    EXPECT_EQ(readImage(path("b.exr")).metadata, first.metadata);
}

// --- PNG and HDR ---

TEST(Srgb, IsContinuousAndInvertible) {
    EXPECT_DOUBLE_EQ(srgbFromLinear(0.0), 0.0);
    EXPECT_DOUBLE_EQ(srgbFromLinear(1.0), 1.0);
    EXPECT_DOUBLE_EQ(linearFromSrgb(0.04045), 0.04045 / 12.92);
    EXPECT_NEAR(linearFromSrgb(std::nextafter(0.04045, 1.0)), 0.04045 / 12.92, 1e-7);
    EXPECT_NEAR(srgbFromLinear(0.18), 0.46135612950044164, 1e-12);
    for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(srgbFromLinear(linearFromSrgb(i / 1000.0)), i / 1000.0, 1e-7);
}

TEST_F(ImageFile, PngKeepsEveryCode) {
    Image image = makeImage(256, 1, {"R", "G", "B"});
    for (std::size_t i = 0; i < 256; ++i) {
        const double encoded = static_cast<double>(i) / 255.0; // codes 10 and 11 lie on either side of 0.04045
        for (std::size_t c = 0; c < 3; ++c) image.values[3 * i + c] = static_cast<float>(linearFromSrgb(encoded));
    }
    writeImage(path("a.png"), image);
    const Image read = readImage(path("a.png"));
    EXPECT_EQ(read.channels, image.channels);
    for (std::size_t i = 0; i < read.values.size(); ++i) EXPECT_FLOAT_EQ(read.values[i], image.values[i]) << i / 3;
    EXPECT_FLOAT_EQ(read.values[3 * 10], static_cast<float>(10.0 / 255.0 / 12.92));
    EXPECT_FLOAT_EQ(read.values[3 * 11], static_cast<float>(std::pow((11.0 / 255.0 + 0.055) / 1.055, 2.4)));
}

TEST_F(ImageFile, PngClampsWhatEightBitsCannotHold) {
    Image image = makeImage(2, 1, {"R", "G", "B"});
    image.values = {-1.0f, 2.0f, INFINITY, NAN, -INFINITY, 0.5f};
    writeImage(path("a.png"), image);
    const Image read = readImage(path("a.png"));
    const std::vector<float> expected{0.0f, 1.0f, 1.0f, 0.0f, 0.0f};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(read.values[i], expected[i]) << i;
    EXPECT_NEAR(read.values[5], 0.5f, 0.005f);
}

TEST_F(ImageFile, PngKeepsAssociatedAlpha) {
    Image image = makeImage(3, 1, {"R", "G", "B", "A"});
    const float gray = static_cast<float>(linearFromSrgb(128.0 / 255.0));
    image.values = {gray, gray, gray, 1.0f, 0.2f * gray, 0.2f * gray, 0.2f * gray, 0.2f, 0.0f, 0.0f, 0.0f, 0.0f};
    writeImage(path("a.png"), image);
    const Image read = readImage(path("a.png"));
    EXPECT_EQ(read.channels, image.channels);
    for (std::size_t i = 0; i < read.values.size(); ++i) EXPECT_NEAR(read.values[i], image.values[i], 1e-6) << i;
}

TEST_F(ImageFile, PngLeavesOutAlphaThatHidesNothing) {
    Image opaque = makeImage(1, 1, {"R", "G", "B", "A"});
    opaque.values = {0.5f, 0.5f, 0.5f, 1.0f};
    writeImage(path("opaque.png"), opaque);
    EXPECT_EQ(readImage(path("opaque.png")).channels.size(), 3u);
    Image background = makeImage(2, 1, {"R", "G", "B", "A"}); // an environment that the camera sees
    background.values = {0.5f, 0.5f, 0.5f, 0.5f, 0.25f, 0.25f, 0.25f, 0.0f};
    writeImage(path("background.png"), background);
    const Image read = readImage(path("background.png"));
    EXPECT_EQ(read.channels.size(), 3u);
    EXPECT_NEAR(read.values[0], 0.5f, 0.005f);
    EXPECT_NEAR(read.values[3], 0.25f, 0.005f);
}

TEST_F(ImageFile, HdrRoundsWithoutBias) {
    Image image = makeImage(64, 64, {"R", "G", "B", "A"});
    std::mt19937 engine(11);
    std::uniform_real_distribution<float> value(0.5f, 4.0f);
    for (float& v : image.values) v = value(engine);
    writeImage(path("a.hdr"), image);
    const Image read = readImage(path("a.hdr"));
    ASSERT_EQ(read.channels.size(), 3u);
    double relative = 0.0;
    for (std::size_t i = 0; i < 64 * 64 * 3; ++i) {
        const double expected = double{image.values[i / 3 * 4 + i % 3]};
        EXPECT_NEAR(double{read.values[i]}, expected, 4.0 / 256.0);
        relative += double{read.values[i]} / expected - 1.0;
    }
    EXPECT_NEAR(relative / (64 * 64 * 3), 0.0, 3e-4);
}

TEST_F(ImageFile, HdrHoldsBlackAndWhatIsNoNumber) {
    Image image = makeImage(2, 1, {"R", "G", "B"});
    image.values = {0.0f, 0.0f, 0.0f, NAN, -1.0f, INFINITY};
    writeImage(path("a.hdr"), image);
    const Image read = readImage(path("a.hdr"));
    for (const std::size_t i : {0, 1, 2, 3, 4}) EXPECT_EQ(read.values[i], 0.0f) << i;
    EXPECT_GT(read.values[5], 1e38f);
}

/// From what rounds to nothing to the largest: the error is half a step of eight bits of the largest channel, at most
/// 2^-9 of a power of two that it reaches half of.
TEST_F(ImageFile, HdrKeepsItsPrecisionOverTheWholeRange) {
    Image image = makeImage(400, 1, {"R", "G", "B"});
    for (std::size_t i = 0; i < 400; ++i) {
        const double largest = 1e-30 * std::pow(1.6e68, static_cast<double>(i) / 399.0);
        for (std::size_t c = 0; c < 3; ++c)
            image.values[3 * i + c] = std::min(1.6e38f, static_cast<float>(largest / std::exp2(c)));
    }
    writeImage(path("a.hdr"), image);
    const Image read = readImage(path("a.hdr"));
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        const double largest = double{image.values[i / 3 * 3]};
        EXPECT_NEAR(double{read.values[i]}, double{image.values[i]}, largest / 256.0) << i;
    }
}

/// What is logged while this object lives.
class CapturedLog {
public:
    CapturedLog() {
        spdlog::set_default_logger(
            std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(messages_)));
    }
    ~CapturedLog() { spdlog::set_default_logger(before_); }
    CapturedLog(const CapturedLog&) = delete;
    CapturedLog& operator=(const CapturedLog&) = delete;

    [[nodiscard]] std::string text() const { return messages_.str(); }

private:
    std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
    std::ostringstream messages_;
};

TEST_F(ImageFile, HdrSaysWhatItClamped) {
    const CapturedLog log;
    writeImage(path("a.hdr"), onePixel(1, 2, 3));
    EXPECT_EQ(log.text(), "");
    Image image = makeImage(4, 1, {"R", "G", "B"});
    image.values = {1, 1, 1, NAN, 1, 1, 1, 2e38f, INFINITY, 1, 1, -1};
    writeImage(path("a.hdr"), image);
    expectMentions(log.text(), "a.hdr: 3 pixels");
}

// --- Failures ---

TEST_F(ImageFile, ExtensionsAreCheckedInAnyCase) {
    writeImage(path("a.EXR"), onePixel(1, 2, 3));
    EXPECT_EQ(readImage(path("a.EXR")).values.size(), 3u);
    EXPECT_NO_THROW(checkImagePath(path("b.Png")));
    for (const char* name : {"a.jpg", "a", "a.exr.txt", ".exr"}) {
        expectMentions(errorOf(ExitCode::badInput, [&] { checkImagePath(path(name)); }), "use .exr, .png or .hdr");
        errorOf(ExitCode::badInput, [&] { writeImage(path(name), onePixel(1, 2, 3)); });
    }
}

TEST_F(ImageFile, PathsAreCheckedEarly) {
    fs::create_directory(path("folder.exr"));
    EXPECT_NO_THROW(checkImagePath(path("a.exr")));
    expectMentions(errorOf(ExitCode::badInput, [&] { checkImagePath(path("folder.exr")); }), "is a folder");
    expectMentions(errorOf(ExitCode::badInput, [&] { checkImagePath(path("none/a.exr")); }), "does not exist");
    expectMentions(errorOf(ExitCode::badInput, [&] { checkImagePath("/proc/a.exr"); }), "cannot be written");
    EXPECT_EQ(fileCount(), 1u) << "the check leaves nothing behind";
}

TEST_F(ImageFile, CheckingAPathLeavesTheFileThere) {
    writeImage(path("a.exr"), onePixel(1, 2, 3));
    const std::string before = readBytes(path("a.exr"));
    checkImagePath(path("a.exr"));
    EXPECT_EQ(readBytes(path("a.exr")), before);
}

TEST_F(ImageFile, FailedWritesLeaveNoTemporaryFile) {
    fs::create_directory(path("folder.exr"));
    std::ofstream(path("folder.exr") / "kept") << "kept";
    expectMentions(errorOf(ExitCode::failure, [&] { writeImage(path("folder.exr"), onePixel(1, 2, 3)); }),
                   "folder.exr");
    EXPECT_TRUE(fs::exists(path("folder.exr") / "kept"));
    EXPECT_EQ(fileCount(), 1u);
    errorOf(ExitCode::failure, [&] { writeImage(path("none/a.exr"), onePixel(1, 2, 3)); });
    errorOf(ExitCode::failure, [&] { writeImage(path("empty.exr"), makeImage(0, 0, {"R", "G", "B"})); });
    errorOf(ExitCode::failure, [&] { writeImage(path("gray.png"), makeImage(1, 1, {"Y"})); });
    EXPECT_EQ(fileCount(), 1u);
}

TEST_F(ImageFile, AFullDiskCostsNothingThatWasThere) {
    const Image image = imageFromFilm(makeFilm(64, 48, 4), {});
    for (const char* name : {"a.exr", "a.png", "a.hdr"}) {
        writeImage(path(name), onePixel(1, 2, 3));
        const std::string before = readBytes(path(name));
        std::string message;
        {
            const FileSizeLimit limit(1000);
            message = errorOf(ExitCode::failure, [&] { writeImage(path(name), image); });
        }
        expectMentions(message, name);
        expectMentions(message, "too large");
        EXPECT_EQ(readBytes(path(name)), before) << name;
    }
    EXPECT_EQ(fileCount(), 3u);
}

TEST_F(ImageFile, UnreadableInputIsNamed) {
    expectMentions(errorOf(ExitCode::badInput, [&] { (void)readImage(path("none.exr")); }), "no such file");
    std::ofstream(path("text.exr")) << "This is no image, whatever its name says.";
    expectMentions(errorOf(ExitCode::badInput, [&] { (void)readImage(path("text.exr")); }), "not an image");
    fs::create_directory(path("folder.exr"));
    expectMentions(errorOf(ExitCode::badInput, [&] { (void)readImage(path("folder.exr")); }), "is a folder");
    errorOf(ExitCode::badInput, [&] { (void)readImage("/dev/null"); });
}

/// OpenImageIO 2.4 leaks a string where libpng jumps out of it: not ours to find.
#if defined(__SANITIZE_ADDRESS__)
using IgnoreLeaks = __lsan::ScopedDisabler;
#else
struct IgnoreLeaks {};
#endif

TEST_F(ImageFile, TruncatedFilesAreRefused) {
    const Image image = imageFromFilm(makeFilm(64, 48, 4), {});
    for (const char* name : {"a.exr", "a.png"}) {
        writeImage(path(name), image);
        fs::resize_file(path(name), fs::file_size(path(name)) / 2);
        [[maybe_unused]] const IgnoreLeaks ignoreLeaks;
        expectMentions(errorOf(ExitCode::badInput, [&] { (void)readImage(path(name)); }), name);
    }
}

/// A PNG header that promises 65535 x 65535 pixels of 16-bit RGBA; the checksum is right.
TEST_F(ImageFile, HugeImagesAreRefusedBeforeTheyAreDecoded) {
    const unsigned char header[] = {0x89, 'P',  'N',  'G', 13,  10, 26, 10,  0,   0,   0,   13,   'I',  'H',  'D',
                                    'R',  0,    0,    255, 255, 0,  0,  255, 255, 16,  6,   0,    0,    0,    0xE6,
                                    0x95, 0x05, 0x13, 0,   0,   0,  0,  'I', 'D', 'A', 'T', 0x35, 0xAF, 0x06, 0x1E};
    std::ofstream(path("huge.png"), std::ios::binary).write(reinterpret_cast<const char*>(header), sizeof header);
    const std::string message = errorOf(ExitCode::badInput, [&] { (void)readImage(path("huge.png")); });
    expectMentions(message, "huge.png");
    expectMentions(message, "limit");
}

/// What a ray met of object `object`, at a depth that tells hits apart.
FirstHit firstHit(std::uint32_t object, double depth) {
    return {Vec3d(0.25, 0.5, 0.75), Vec3d(0.0, 0.0, 1.0), depth, object};
}

PixelAovs pixelOf(std::initializer_list<FirstHit> hits) {
    PixelAovs pixel;
    for (const FirstHit& hit : hits) pixel.add(hit);
    return pixel;
}

TEST(PixelAovs, SumHitsAndCountThemByObject) {
    const PixelAovs pixel = pixelOf({firstHit(7, 1.0), firstHit(2, 2.0), firstHit(7, 4.0), firstHit(9, 8.0)});
    EXPECT_EQ(pixel.albedo, Vec3d(1.0, 2.0, 3.0));
    EXPECT_EQ(pixel.normal, Vec3d(0.0, 0.0, 4.0));
    EXPECT_EQ(pixel.depth, 15.0);
    EXPECT_EQ(pixel.objects, (std::vector<PixelAovs::Coverage>{{2, 1}, {7, 2}, {9, 1}}));
    EXPECT_EQ(pixel.hitCount(), 4u);
    EXPECT_EQ(PixelAovs{}.hitCount(), 0u);
}

TEST(PixelAovs, JoiningIsAdditionInAnyOrder) {
    const PixelAovs first = pixelOf({firstHit(3, 1.0), firstHit(1, 2.0)});
    const PixelAovs second = pixelOf({firstHit(5, 4.0), firstHit(3, 8.0), firstHit(0, 16.0)});
    PixelAovs joined = first;
    joined.merge(second);
    PixelAovs reversed = second;
    reversed.merge(first);
    EXPECT_EQ(joined, reversed);
    EXPECT_EQ(joined.objects, (std::vector<PixelAovs::Coverage>{{0, 1}, {1, 1}, {3, 2}, {5, 1}}));
    EXPECT_EQ(joined.depth, 31.0);
    EXPECT_EQ(joined.hitCount(), 5u);
    joined.merge(PixelAovs{});
    EXPECT_EQ(joined, reversed);
    joined.addCoverage(4, 1'000'000'000'000);
    EXPECT_EQ(joined.objects[3], (PixelAovs::Coverage{4, 1'000'000'000'000}));
}

TEST(PixelAovs, AFilmKeepsOneForEachPixelIfAsked) {
    Film film(3, 2);
    EXPECT_TRUE(film.aovs.empty());
    film.keepAovs();
    EXPECT_EQ(film.aovs.size(), film.pixels.size());
}

} // namespace
} // namespace isolux
