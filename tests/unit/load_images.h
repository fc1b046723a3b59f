// Encodes small images with OpenImageIO for the loader's tests, and puts them on a triangle.
#pragma once

#include "unit/load_fixture.h"

#include <OpenImageIO/imageio.h>

namespace isolux::load_test {

/// What an image file is made of.
struct Picture {
    int width = 1;
    int height = 1;
    int channels = 3;
};

/// The bytes of a file whose format its name tells, of samples of type T.
template <typename T> std::string encoded(const fs::path& path, const Picture& picture, const std::vector<T>& samples) {
    OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, OIIO::BaseTypeFromC<T>::value);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto output = OIIO::ImageOutput::create(path.string());
    EXPECT_TRUE(output && output->open(path.string(), spec) &&
                output->write_image(OIIO::BaseTypeFromC<T>::value, samples.data()) && output->close())
        << path;
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline json vectors2(int componentType, std::size_t count) {
    return {{"componentType", componentType}, {"count", count}, {"type", "VEC2"}};
}

inline json vectors4(int componentType, std::size_t count) {
    return {{"componentType", componentType}, {"count", count}, {"type", "VEC4"}};
}

inline const std::vector<float> kCorners = {0, 0, 1, 0, 0, 1};

/// A triangle with coordinates and a material whose base colour is texture 0, of image 0.
inline json texturedDocument(const json& image) {
    json document = triangleDocument();
    primitiveOf(document)["attributes"]["TEXCOORD_0"] = addAccessor(document, bytesOf(kCorners), vectors2(5126, 3));
    primitiveOf(document)["material"] = 0;
    document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    document["textures"] = {{{"source", 0}}};
    document["images"] = json::array({image});
    return document;
}

/// A white PNG of one texel.
inline json whiteImage(const fs::path& folder) {
    return {{"uri", dataUri(encoded<std::uint8_t>(folder / "white.png", {1, 1, 3}, {255, 255, 255}))}};
}

} // namespace isolux::load_test
