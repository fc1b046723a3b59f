// Images of glTF files: every format as stored, and hostile ones refused.
#include "unit/load_images.h"

#include "load/context.h"

namespace isolux::load_test {
namespace {

using Texels8 = std::vector<Texel8>;

/// A PNG of two palette entries: (255, 0, 0) and (0, 0, 200) with alpha 64.
std::string palettePng() {
    return "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABAQMAAADO7O3JAAAABlBMVEX/AAAAAMjUHFiBAAAAAnRSTl"
           "P/QJNrcdoAAAAKSURBVHjaY3AAAABCAEGEv45iAAAAAElFTkSuQmCC";
}

/// A PNG of four texels of one bit: 0 1 0 1.
std::string bitPng() {
    return "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAQAAAABAQAAAADRRzJgAAAACklEQVR42mMIAAAAUgBRWqmjOgAAAA"
           "BJRU5ErkJggg==";
}

/// A PNG of two texels, (10, 20, 30) and (40, 50, 60), that says its gamma is 1 and that it is sRGB.
std::string gammaPng() {
    return "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAABGdBTUEAAYagMeiWXwAAAAFzUkdCAK"
           "7OHOkAAAAPSURBVHjaY+ASkdMwsgEAAjcA0+It7Z8AAAAASUVORK5CYII=";
}

/// Lossless WebP of four texels with alpha, among them (200, 100, 50) with alpha 0 (OpenImageIO writes no such file).
std::string losslessWebP() {
    return "data:image/webp;base64,UklGRjwAAABXRUJQVlA4TC8AAAAvAwAAEB+gIG0DFu6rnJCAoPl/yDUCAcpU4Q01bRsw6QBe3n1Ct"
           "mv/F2DoSUT/AwA=";
}

/// Lossy WebP of 16 x 16 texels (128, 128, 128), with alpha 0 in the left half.
std::string lossyWebP() {
    return "data:image/webp;base64,UklGRk4AAABXRUJQVlA4WAoAAAAQAAAADwAADwAAQUxQSA8AAAABEBIQ/p+WZDUiJoA0fwEAVlA4I"
           "BgAAABQAQCdASoQABAAAMASJaQABHQAAP4AAAA=";
}

class LoadImageTest : public LoadTest {
protected:
    template <typename T>
    std::string file(const std::string& name, const Picture& picture, const std::vector<T>& samples) {
        return encoded(folder_ / name, picture, samples);
    }
    /// The one image of a document that has these bytes as its base colour.
    TextureImage decode(const std::string& bytes) { return decodeUri(dataUri(bytes)); }
    TextureImage decodeUri(const std::string& uri) {
        const Scene scene = load(texturedDocument({{"uri", uri}}));
        EXPECT_EQ(scene.images.size(), 1u);
        return scene.images.at(0);
    }
    std::string failureOf(const std::string& bytes) { return failure(texturedDocument({{"uri", dataUri(bytes)}})); }
};

TEST_F(LoadImageTest, PngKeepsEightBitsOfEveryLayout) {
    const TextureImage grey = decode(file<std::uint8_t>("a.png", {2, 1, 1}, {7, 200}));
    EXPECT_EQ(grey.texels8, (Texels8{{7, 7, 7, 255}, {200, 200, 200, 255}}));
    EXPECT_TRUE(grey.texels16.empty());
    EXPECT_EQ(decode(file<std::uint8_t>("a.png", {2, 1, 2}, {7, 0, 200, 9})).texels8,
              (Texels8{{7, 7, 7, 0}, {200, 200, 200, 9}}));
    const TextureImage rgb = decode(file<std::uint8_t>("a.png", {1, 2, 3}, {1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(rgb.texels8, (Texels8{{1, 2, 3, 255}, {4, 5, 6, 255}}));
    EXPECT_EQ(rgb.width, 1u);
    EXPECT_EQ(rgb.height, 2u);
    // Colour beside an alpha of zero stays: it is not multiplied in.
    EXPECT_EQ(decode(file<std::uint8_t>("a.png", {2, 1, 4}, {200, 100, 50, 0, 9, 8, 7, 128})).texels8,
              (Texels8{{200, 100, 50, 0}, {9, 8, 7, 128}}));
}

TEST_F(LoadImageTest, PngKeepsSixteenBits) {
    using Texels16 = std::vector<Texel16>;
    const TextureImage rgba = decode(file<std::uint16_t>("a.png", {1, 2, 4}, {1, 256, 65535, 3, 40000, 2, 1, 0}));
    EXPECT_EQ(rgba.texels16, (Texels16{{1, 256, 65535, 3}, {40000, 2, 1, 0}}));
    EXPECT_TRUE(rgba.texels8.empty());
    EXPECT_EQ(decode(file<std::uint16_t>("a.png", {2, 1, 1}, {258, 65534})).texels16,
              (Texels16{{258, 258, 258, 65535}, {65534, 65534, 65534, 65535}}));
}

TEST_F(LoadImageTest, PalettesBitsAndGammaAreReadAsWritten) {
    EXPECT_EQ(decodeUri(palettePng()).texels8, (Texels8{{255, 0, 0, 255}, {0, 0, 200, 64}}));
    EXPECT_EQ(decodeUri(bitPng()).texels8,
              (Texels8{{0, 0, 0, 255}, {255, 255, 255, 255}, {0, 0, 0, 255}, {255, 255, 255, 255}}));
    EXPECT_EQ(decodeUri(gammaPng()).texels8, (Texels8{{10, 20, 30, 255}, {40, 50, 60, 255}}));
}

TEST_F(LoadImageTest, WebPKeepsColourBesideAlpha) {
    EXPECT_EQ(decodeUri(losslessWebP()).texels8,
              (Texels8{{200, 100, 50, 128}, {9, 8, 7, 255}, {200, 100, 50, 0}, {1, 2, 3, 4}}));
    const TextureImage lossy = decodeUri(lossyWebP());
    ASSERT_EQ(lossy.texels8.size(), 256u);
    for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(lossy.texels8[i], Texel8(128, 128, 128, i % 16 < 8 ? 0 : 255)) << i;
    const TextureImage opaque = decode(file("a.webp", {8, 8, 3}, std::vector<std::uint8_t>(8 * 8 * 3, 128)));
    EXPECT_EQ(opaque.texels8, Texels8(64, Texel8(128, 128, 128, 255)));
}

TEST_F(LoadImageTest, JpegOfOneColourHasIt) {
    const std::vector<std::uint8_t> samples(16 * 8 * 3, 128);
    const TextureImage image = decode(file("a.jpg", {16, 8, 3}, samples));
    EXPECT_EQ(image.texels8, Texels8(16 * 8, Texel8(128, 128, 128, 255)));
    EXPECT_EQ(decode(file("a.jpg", {8, 8, 1}, std::vector<std::uint8_t>(64, 128))).texels8,
              Texels8(64, Texel8(128, 128, 128, 255)));
}

TEST_F(LoadImageTest, ImagesLieInFilesUrisAndBuffers) {
    const std::string png = file<std::uint8_t>("a.png", {1, 1, 3}, {1, 2, 3});
    write("my image.png", png);
    json document = texturedDocument({{"uri", "my%20image.png"}});
    const Scene fromFile = load(document);
    EXPECT_EQ(fromFile.images.at(0).texels8, (Texels8{{1, 2, 3, 255}}));
    EXPECT_EQ(fromFile.images[0].name, "my%20image.png");
    document = texturedDocument({{"bufferView", 2}, {"mimeType", "image/png"}, {"name", "inside"}});
    (void)addAccessor(document, png, {{"componentType", 5121}, {"count", 1}, {"type", "SCALAR"}});
    const Scene fromBuffer = load(document);
    EXPECT_EQ(fromBuffer.images.at(0).texels8, (Texels8{{1, 2, 3, 255}}));
    EXPECT_EQ(fromBuffer.images[0].name, "inside");
    EXPECT_TRUE(fromBuffer.warnings.empty());
    document["images"][0]["mimeType"] = "image/jpeg";
    EXPECT_TRUE(mentions(load(document).warnings, "/images/0/mimeType: is not image/png, which the image is"));
}

TEST_F(LoadImageTest, ContentHashCoversImages) {
    const json document = texturedDocument({{"uri", "a.png"}});
    write("a.png", file<std::uint8_t>("x.png", {1, 1, 3}, {1, 2, 3}));
    const std::string hash = load(document).contentHash;
    EXPECT_EQ(load(document).contentHash, hash);
    write("a.png", file<std::uint8_t>("x.png", {1, 1, 3}, {1, 2, 4}));
    EXPECT_NE(load(document).contentHash, hash);
}

TEST_F(LoadImageTest, OnlyWhatSurfacesNeedIsDecoded) {
    json document = texturedDocument(whiteImage(folder_));
    document["images"].push_back(document["images"][0]);
    document["textures"] = {{{"source", 0}}, {{"source", 1}}, {{"source", 0}}};
    // The second image serves ambient occlusion, an emission of zero, and a material that nothing has.
    document["materials"][0]["occlusionTexture"]["index"] = 1;
    document["materials"][0]["emissiveTexture"]["index"] = 1;
    document["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] = 2;
    document["materials"].push_back(document["materials"][0]);
    document["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
    const Scene scene = load(document);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.textures.size(), 1u); // textures 0 and 2 are alike
    EXPECT_EQ(scene.materials.at(0).map(MapSlot::metallicRoughness).texture, 0u);
    EXPECT_FALSE(scene.materials[0].map(MapSlot::emission).present());
    EXPECT_FALSE(scene.materials.at(1).map(MapSlot::baseColor).present());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoadImageTest, MissingAndForeignImagesAreRefusedByPointer) {
    EXPECT_MENTIONS(failure(texturedDocument({{"uri", "no.png"}})), "/images/0/uri: cannot read '");
    EXPECT_MENTIONS(failure(texturedDocument({{"uri", "../x.png"}})), "/images/0/uri: '../x.png' leads out");
    EXPECT_MENTIONS(failure(texturedDocument({{"uri", "http://x/y.png"}})), "/images/0/uri: 'http://x/y.png' is not");
    EXPECT_MENTIONS(failure(texturedDocument({{"bufferView", 9}})), "/images/0/bufferView: refers to bufferViews 9");
    EXPECT_MENTIONS(failure(texturedDocument(json::object())), "/images/0: must have either a uri or a bufferView");
    EXPECT_MENTIONS(failureOf("GIF89a..."), "/images/0: is neither PNG, JPEG nor WebP");
    EXPECT_MENTIONS(failureOf(""), "/images/0: is neither PNG, JPEG nor WebP");
    // A file that no material needs must be there as well; its format does not matter.
    json document = triangleDocument();
    document["images"] = {{{"uri", "no.png"}}};
    EXPECT_MENTIONS(failure(document), "/images/0/uri: cannot read '");
    write("no.png", "something else");
    EXPECT_TRUE(failure(document).empty());
}

/// Random colours: they do not compress, so that every cut loses something.
std::vector<std::uint8_t> noise(std::size_t count) {
    std::vector<std::uint8_t> samples(count);
    std::uint32_t state = 1;
    for (std::uint8_t& sample : samples)
        sample = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
    return samples;
}

TEST_F(LoadImageTest, TruncatedImagesAreRefused) {
    for (const char* name : {"a.png", "a.jpg", "a.webp"}) {
        const std::string bytes = file(name, {16, 16, 3}, noise(16 * 16 * 3));
        EXPECT_TRUE(failureOf(bytes).empty()) << name;
        for (const std::size_t length : {bytes.size() / 2, bytes.size() - 40, std::size_t{30}, std::size_t{12}})
            EXPECT_MENTIONS(failureOf(bytes.substr(0, length)), "/images/0: ") << name << " " << length;
    }
}

TEST_F(LoadImageTest, WordsOfDecodersStayOnOneLine) {
    EXPECT_EQ(printableLines("incorrect data check\nPNG library error\n"), "incorrect data check; PNG library error");
    EXPECT_EQ(printableLines("a\n\nb\tc"), "a; b?c");
    EXPECT_EQ(printableLines(""), "");
}

TEST_F(LoadImageTest, DamagedImagesAreSurvived) {
    for (const char* name : {"a.png", "a.jpg", "a.webp"}) {
        const std::string bytes = file(name, {8, 8, 4}, noise(8 * 8 * 4));
        for (std::size_t i = 0; i < std::min<std::size_t>(bytes.size(), 200); ++i) {
            std::string damaged = bytes;
            damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
            (void)failureOf(damaged);
        }
    }
}

/// A PNG's header, with the right checksum, and next to nothing behind it.
std::string claimingPng(std::uint32_t width, std::uint32_t height, char depth = 8, char colorType = 6) {
    const auto bigEndian = [](std::uint32_t v) {
        return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                           static_cast<char>(v)};
    };
    const std::string header = "IHDR" + bigEndian(width) + bigEndian(height) + std::string{depth, colorType, 0, 0, 0};
    std::uint32_t crc = 0xFFFFFFFFu; // of PNG's annex D
    for (const char c : header) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
    }
    return "\x89PNG\r\n\x1A\n" + bigEndian(13) + header + bigEndian(~crc) + bigEndian(0) + "IDAT" +
           bigEndian(0x35AF061Eu) + bigEndian(0) + "IEND" + bigEndian(0xAE426082u);
}

TEST_F(LoadImageTest, HeadersThatClaimTooMuchAreRefusedBeforeMemoryIsTaken) {
    EXPECT_MENTIONS(failureOf(claimingPng(65535, 65535)), "/images/0: ");
    EXPECT_MENTIONS(failureOf(claimingPng(20000, 4)), "at most 16384 a side");
    EXPECT_MENTIONS(failureOf(claimingPng(16384, 16384)), "16384 x 16384 texels: 57 bytes cannot hold them");
    // They could hold them as bits.
    EXPECT_MENTIONS(failureOf(claimingPng(512, 512)), "512 x 512 texels: 57 bytes cannot hold them");
    EXPECT_MENTIONS(failureOf(claimingPng(512, 512, 1, 0)), "cannot be decoded");
    // Whether or not a surface needs the image.
    json document = triangleDocument();
    document["images"] = {{{"uri", dataUri(claimingPng(16384, 16384))}}};
    EXPECT_MENTIONS(failure(document), "/images/0: it claims 16384 x 16384");
}

/// OpenImageIO takes memory for all of a WebP as soon as it opens it.
TEST_F(LoadImageTest, HeadersOfWebpAreReadBeforeTheirDecoderIs) {
    const auto webp = [](const std::string& name, const std::string& data) {
        const std::string chunk = name + word(static_cast<std::uint32_t>(data.size())) + data;
        return "RIFF" + word(static_cast<std::uint32_t>(4 + chunk.size())) + "WEBP" + chunk;
    };
    const std::string canvas = std::string(4, '\0') + "\xFF\xFF\xFF" + "\x03" + std::string(20, '\0');
    EXPECT_MENTIONS(failureOf(webp("VP8X", canvas)), "16777216 x 4 texels: at most 16384 a side");
    const std::string frame = std::string("\x30\x01\x00\x9D\x01\x2A", 6) + std::string(20, '\0');
    EXPECT_MENTIONS(failureOf(webp("VP8 ", frame)), "0 x 0 texels: no picture");
    const std::string lossless = "\x2F\xFF\x3F" + std::string(20, '\0');
    LoadLimits limits;
    limits.imageSide = 16383;
    const std::string document = texturedDocument({{"uri", dataUri(webp("VP8L", lossless))}}).dump();
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(document.data()), document.size());
    try {
        (void)loadSceneFromBytes(bytes, folder_ / "scene.gltf", limits);
        ADD_FAILURE() << "is loaded beyond its limits";
    } catch (const Error& error) {
        EXPECT_MENTIONS(error.what(), "scene.gltf: /images/0: it claims 16384 x 1 texels: at most 16383 a side");
    }
    const std::string large = "\x2F\xFF\xFF\xFF\x0F" + std::string(8, '\0');
    EXPECT_MENTIONS(failureOf(webp("VP8L", large)), "16384 x 16384 texels: 33 bytes cannot hold them");
    EXPECT_MENTIONS(failureOf(webp("ALPH", lossless)), "its data is cut short or damaged");
    EXPECT_MENTIONS(failureOf(webp("VP8L", "")), "its data is cut short or damaged");
}

} // namespace
} // namespace isolux::load_test
