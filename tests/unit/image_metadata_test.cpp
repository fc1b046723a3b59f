// What is left of image files before a decoder sees them.
#include "load/image_metadata.h"

#include <gtest/gtest.h>

#include <string>

namespace isolux {
namespace {

using namespace std::string_literals;

std::string left(const std::string& file) {
    const Bytes bytes(file.begin(), file.end());
    const Bytes result = withoutMetadata(bytes);
    return {result.begin(), result.end()};
}

TEST(ImageMetadata, PngKeepsItsPictureAndTransparency) {
    const std::string start = "\x89PNG\r\n\x1A\n"s;
    const auto chunk = [](const std::string& name, const std::string& data) {
        return "\0\0\0"s + static_cast<char>(data.size()) + name + data + "CRC."s;
    };
    const std::string picture = chunk("PLTE", "rgb") + chunk("tRNS", "a") + chunk("IDAT", "data");
    EXPECT_EQ(left(start + chunk("IHDR", "head") + chunk("eXIf", "II*") + chunk("tEXt", "words") + picture +
                   chunk("zTXt", "") + chunk("IEND", "")),
              start + chunk("IHDR", "head") + picture + chunk("IEND", ""));
    EXPECT_EQ(left(start + chunk("tEXt", "words") + "\0\0\1\0IDATcut short"s), start + "\0\0\1\0IDATcut short"s);
}

TEST(ImageMetadata, JpegKeepsWhatItsColoursAre) {
    const auto segment = [](char code, const std::string& data) {
        return "\xFF"s + code + '\0' + static_cast<char>(data.size() + 2) + data;
    };
    const auto file = [&](const std::string& exif, const std::string& photoshop, const std::string& comment) {
        return "\xFF\xD8"s + segment('\xE0', "JFIF") + "stray\xFF"s + segment('\xE1', exif) + segment('\xDB', "table") +
               segment('\xED', photoshop) + segment('\xEE', "Adobe") + segment('\xFE', comment) +
               segment('\xDA', "scan") + "data\xFF\xED\0\x04in"s + "\xFF\xD9"s;
    };
    const auto zeros = [](const char* text) { return std::string(std::string(text).size(), '\0'); };
    EXPECT_EQ(left(file("Exif II*", "Photoshop 3.0", "words")),
              file(zeros("Exif II*"), zeros("Photoshop 3.0"), zeros("words")));
    EXPECT_EQ(left("\xFF\xD8\xFF\xED\xFF\xFFPhotoshop"s), "\xFF\xD8\xFF\xED\xFF\xFF"s + zeros("Photoshop"));
    for (const std::string& cut :
         {"\xFF\xD8\xFF"s, "\xFF\xD8\xFF\xED"s, "\xFF\xD8\xFF\xED\0"s, "\xFF\xD8\xFF\xED\0\0"s})
        EXPECT_EQ(left(cut), cut);
}

TEST(ImageMetadata, WebpKeepsItsPicture) {
    const auto chunk = [](const std::string& name, const std::string& data) {
        return name + static_cast<char>(data.size()) + "\0\0\0"s + data + (data.size() % 2 == 1 ? "\0"s : ""s);
    };
    const auto file = [&](const std::string& exif, const std::string& xmp, const std::string& profile) {
        return "RIFF....WEBP"s + chunk("VP8X", "flags") + chunk(profile, "icc") + chunk("VP8L", "data") +
               chunk(exif, "II*") + chunk(xmp, "<x>");
    };
    EXPECT_EQ(left(file("EXIF", "XMP ", "ICCP")), file("____", "____", "____"));
}

} // namespace
} // namespace isolux
