// Texels as materials read them: decoding, wrapping, maps that do not vary.
#include "scene/textures.h"

#include "core/srgb.h"

#include <gtest/gtest.h>

#include <limits>

namespace isolux {
namespace {

/// A scene whose one texture shows the texels, a row of them.
Scene sceneOf(const std::vector<Texel8>& texels) {
    Scene scene;
    scene.images = {{"row", static_cast<std::uint32_t>(texels.size()), 1, texels, {}}};
    scene.textures = {Texture{}};
    return scene;
}

TextureMap firstTexture() {
    TextureMap map;
    map.texture = 0;
    return map;
}

TEST(Textures, ColoursAreDecodedAndNumbersAreNot) {
    const TextureImage bytes{"", 1, 1, {Texel8(0, 128, 255, 128)}, {}};
    const TextureImage words{"", 1, 1, {}, {Texel16(0, 32768, 65535, 32768)}};
    const double byte = 128.0 / 255.0;
    const double word = 32768.0 / 65535.0;
    for (const MapSlot slot : {MapSlot::baseColor, MapSlot::emission, MapSlot::specularColor}) {
        EXPECT_EQ(decodedTexel(bytes, 0, slot), glm::dvec4(0.0, linearFromSrgb(byte), 1.0, byte));
        EXPECT_EQ(decodedTexel(words, 0, slot), glm::dvec4(0.0, linearFromSrgb(word), 1.0, word));
    }
    for (const MapSlot slot :
         {MapSlot::metallicRoughness, MapSlot::normal, MapSlot::transmission, MapSlot::thickness, MapSlot::specular}) {
        EXPECT_EQ(decodedTexel(bytes, 0, slot), glm::dvec4(0.0, byte, 1.0, byte));
        EXPECT_EQ(decodedTexel(words, 0, slot), glm::dvec4(0.0, word, 1.0, word));
    }
}

TEST(Textures, IndicesAreWrapped) {
    using enum TextureWrap;
    const std::vector<std::uint32_t> repeated{1, 2, 0, 1, 2, 0, 1, 2, 0, 1};
    const std::vector<std::uint32_t> mirrored{1, 0, 0, 1, 2, 2, 1, 0, 0, 1};
    const std::vector<std::uint32_t> clamped{0, 0, 0, 1, 2, 2, 2, 2, 2, 2};
    for (int i = 0; i < 10; ++i)
        for (const double fraction : {0.0, 0.5, 0.999}) {
            EXPECT_EQ(texelIndex(i - 2 + fraction, 3, repeat), repeated[i]) << i;
            EXPECT_EQ(texelIndex(i - 2 + fraction, 3, mirroredRepeat), mirrored[i]) << i;
            EXPECT_EQ(texelIndex(i - 2 + fraction, 3, clampToEdge), clamped[i]) << i;
        }
}

TEST(Textures, NoCoordinateLeadsOutOfTheImage) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::mirroredRepeat, TextureWrap::clampToEdge}) {
        for (const double s : {1e17, -1e17, 1e300, -1e300, -1e-300, 7.0 - 1e-15, 0x1p53 + 2.0})
            for (const std::uint32_t size : {1u, 3u, 7u, 65535u}) EXPECT_LT(texelIndex(s, size, wrap), size);
        for (const double s : {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()})
            EXPECT_EQ(texelIndex(s, 5, wrap), 0u);
    }
}

TEST(Textures, MapsAreTransformed) {
    const Scene scene = sceneOf({Texel8(0), Texel8(51), Texel8(102), Texel8(255)});
    TextureMap map = firstTexture();
    EXPECT_EQ(nearestValue(scene, map, MapSlot::thickness, {0.3, 9.0}).y, 0.2);
    map.offset = {0.25, 0.0};
    EXPECT_EQ(nearestValue(scene, map, MapSlot::thickness, {0.3, 9.0}).y, 0.4);
    map.uvFromMesh = glm::dmat2(0.0, 1.0, 2.0, 0.0); // u = 2 v + 1/4
    EXPECT_EQ(nearestValue(scene, map, MapSlot::thickness, {9.0, 0.3}).y, 1.0);
}

TEST(Textures, AMapVariesOnlyInTheChannelsThatAreRead) {
    using enum MapSlot;
    const auto constantSlots = [](const Texel8& other) {
        std::vector<MapSlot> slots;
        const Scene scene = sceneOf({Texel8(10), Texel8(10), other, Texel8(10)});
        for (std::uint32_t i = 0; i < kMapSlots; ++i)
            if (constantValue(scene, firstTexture(), MapSlot{i})) slots.push_back(MapSlot{i});
        return slots;
    };
    EXPECT_EQ(constantSlots(Texel8(10)).size(), kMapSlots);
    EXPECT_EQ(constantSlots({9, 10, 10, 10}), (std::vector<MapSlot>{metallicRoughness, thickness, specular}));
    EXPECT_EQ(constantSlots({10, 9, 10, 10}), (std::vector<MapSlot>{transmission, specular}));
    EXPECT_EQ(constantSlots({10, 10, 9, 10}), (std::vector<MapSlot>{transmission, thickness, specular}));
    EXPECT_EQ(constantSlots({10, 10, 10, 9}),
              (std::vector<MapSlot>{metallicRoughness, normal, emission, transmission, thickness, specularColor}));
}

TEST(Textures, AConstantIsDecoded) {
    const Scene scene = sceneOf({Texel8(128, 0, 255, 51), Texel8(128, 0, 255, 51)});
    EXPECT_EQ(constantValue(scene, firstTexture(), MapSlot::baseColor),
              glm::dvec4(linearFromSrgb(128.0 / 255.0), 0.0, 1.0, 0.2));
    EXPECT_EQ(constantValue(scene, firstTexture(), MapSlot::normal), glm::dvec4(128.0 / 255.0, 0.0, 1.0, 0.2));
    Scene words;
    words.images = {{"", 2, 1, {}, {Texel16(1), Texel16(2)}}};
    words.textures = {Texture{}};
    EXPECT_EQ(constantValue(words, firstTexture(), MapSlot::baseColor), std::nullopt);
}

} // namespace
} // namespace isolux
