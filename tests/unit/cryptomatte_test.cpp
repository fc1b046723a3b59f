// Cryptomatte: the published hashes and keys, ranks, and the manifest.
#include "film/cryptomatte.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <limits>

namespace isolux {
namespace {

/// Known answers of MurmurHash3_x86_32: every length of tail, bytes above 127, zeros.
TEST(MurmurHash3, GivesTheKnownAnswers) {
    EXPECT_EQ(murmurHash3(""), 0u);
    EXPECT_EQ(murmurHash3("a"), 0x3C2569B2u);
    EXPECT_EQ(murmurHash3("ab"), 0x9BBFD75Fu);
    EXPECT_EQ(murmurHash3("abc"), 0xB3DD93FAu);
    EXPECT_EQ(murmurHash3("test"), 0xBA6BD213u);
    EXPECT_EQ(murmurHash3("hello"), 0x248BFA47u);
    EXPECT_EQ(murmurHash3("Hello, world!"), 0xC0363E43u);
    EXPECT_EQ(murmurHash3("The quick brown fox jumps over the lazy dog"), 0x2E4FF723u);
    EXPECT_EQ(murmurHash3("\xFF\xFF\xFF\xFF"), 0x76293B50u);
    EXPECT_EQ(murmurHash3("\x21\x43\x65\x87"), 0xF55B516Bu);
    EXPECT_EQ(murmurHash3(std::string_view("\0\0\0\0", 4)), 0x2362F9DEu);
    EXPECT_EQ(murmurHash3(std::string_view("\0\0\0", 3)), 0x85F0B427u);
}

/// The ids that Cryptomatte's own tests ask of a program.
TEST(CryptomatteId, GivesThePublishedIds) {
    EXPECT_EQ(cryptomatteId("hello"), 6.0705627102400005616e-17f);
    EXPECT_EQ(cryptomatteId("cube"), -4.08461912519e+15f);
    EXPECT_EQ(cryptomatteId("sphere"), 2.79018604383e+15f);
    EXPECT_EQ(cryptomatteId("plane"), 3.66557617593e-11f);
    EXPECT_EQ(cryptomatteId("\xD1\x80\xD0\xB0\xD0\xB2\xD0\xBD\xD0\xB8\xD0\xBD\xD0\xB0"), -1.3192631212399999468e-25f);
    EXPECT_EQ(cryptomatteId("m\xC3\xA4"
                            "dchen"),
              6.2361298211599995797e+25f);
}

/// Two names in 256 have a hash whose exponent would make no normal float.
TEST(CryptomatteId, IsAlwaysANormalNumber) {
    int changed = 0;
    for (int i = 0; i < 5000; ++i) {
        const std::string name = std::to_string(i);
        EXPECT_TRUE(std::isnormal(cryptomatteId(name))) << name;
        const std::uint32_t exponent = (murmurHash3(name) >> 23) & 0xffu;
        changed += exponent == 0 || exponent == 255 ? 1 : 0;
    }
    EXPECT_GT(changed, 0);
    EXPECT_EQ(cryptomatteId(""), std::numeric_limits<float>::min()) << "hash 0: exponent 1, no mantissa";
}

TEST(Cryptomatte, RanksByCoverageAndMergesNames) {
    const Cryptomatte matte("CryptoObject", {"cube", "sphere", "plane", "cube"});
    PixelAovs pixel;
    pixel.addCoverage(0, 2);
    pixel.addCoverage(1, 4);
    pixel.addCoverage(2, 1);
    pixel.addCoverage(3, 3);
    const std::vector<Cryptomatte::Rank> ranks = matte.ranks(pixel, 16);
    ASSERT_EQ(ranks.size(), 3u);
    EXPECT_EQ(ranks[0].id, cryptomatteId("cube"));
    EXPECT_EQ(ranks[0].coverage, 5.0f / 16.0f);
    EXPECT_EQ(ranks[1].id, cryptomatteId("sphere"));
    EXPECT_EQ(ranks[1].coverage, 0.25f);
    EXPECT_EQ(ranks[2].id, cryptomatteId("plane"));
    EXPECT_EQ(ranks[2].coverage, 1.0f / 16.0f);
}

/// Which of two equal coverages comes first must not depend on the order of the objects.
TEST(Cryptomatte, EqualCoveragesHaveOneOrder) {
    PixelAovs pixel;
    pixel.addCoverage(0, 1);
    pixel.addCoverage(1, 1);
    const auto ranks = Cryptomatte("T", {"cube", "sphere"}).ranks(pixel, 2);
    const auto swapped = Cryptomatte("T", {"sphere", "cube"}).ranks(pixel, 2);
    EXPECT_EQ(ranks[0].id, swapped[0].id);
    EXPECT_EQ(ranks[1].id, swapped[1].id);
}

TEST(Cryptomatte, HasAsManyLayersAsThePixelWithMostNames) {
    Film film(2, 1);
    film.keepAovs();
    const Cryptomatte matte("CryptoObject", {"a", "b", "c", "d", "a"});
    EXPECT_EQ(matte.layerCount(film), 1u) << "a file without objects still has its layer";
    for (std::uint32_t object = 0; object < 3; ++object) film.aovs[0].addCoverage(object, 1);
    EXPECT_EQ(matte.layerCount(film), 2u);
    for (std::uint32_t object = 0; object < 5; ++object) film.aovs[1].addCoverage(object, 1);
    EXPECT_EQ(matte.layerCount(film), 2u) << "five objects, four names";
    EXPECT_EQ(matte.channels(2), (std::vector<std::string>{"CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B",
                                                           "CryptoObject00.A", "CryptoObject01.R", "CryptoObject01.G",
                                                           "CryptoObject01.B", "CryptoObject01.A"}));
}

/// The specification's own manifest, and the key of a widely used plug-in's channels.
TEST(Cryptomatte, MetadataAreThePublishedOnes) {
    const Metadata metadata = Cryptomatte("crypto_object", {"default", "bunny"}).metadata();
    EXPECT_EQ(metadataText(metadata, "cryptomatte/f834d0a/manifest"), R"({"bunny":"13851a76","default":"42c9679f"})");
}

/// The manifest survives names that JSON must escape.
TEST(Cryptomatte, MetadataSayHowToDecode) {
    const std::vector<std::string> names{"cube", "a \"b\" \\ \n\x01 \xC3\xA4", "cube"};
    const Metadata metadata = Cryptomatte("CryptoObject", names).metadata();
    EXPECT_EQ(metadata.size(), 4u);
    EXPECT_EQ(metadataText(metadata, "cryptomatte/3ae39a5/name"), "CryptoObject");
    EXPECT_EQ(metadataText(metadata, "cryptomatte/3ae39a5/hash"), "MurmurHash3_32");
    EXPECT_EQ(metadataText(metadata, "cryptomatte/3ae39a5/conversion"), "uint32_to_float32");
    const auto manifest = nlohmann::json::parse(*metadataText(metadata, "cryptomatte/3ae39a5/manifest"));
    EXPECT_EQ(manifest.size(), 2u);
    for (const std::string& name : names) {
        const auto bits = static_cast<std::uint32_t>(std::stoul(manifest.at(name).get<std::string>(), nullptr, 16));
        EXPECT_EQ(std::bit_cast<float>(bits), cryptomatteId(name)) << name;
    }
    EXPECT_TRUE(Cryptomatte("CryptoMaterial", {}).metadata().contains("cryptomatte/be359d6/name"));
}

} // namespace
} // namespace isolux
