// Environment maps from files: formats, channels, and texels that are no radiance.
#include "unit/load_shared.h"

#include "core/error.h"
#include "load/environment_file.h"

#include <OpenImageIO/imageio.h>

#include <cstring>
#include <fstream>
#include <limits>

namespace isolux {
namespace {

class LoadEnvironmentTest : public ::testing::Test {
protected:
    LoadEnvironmentTest() {
        folder_ = fs::temp_directory_path() / (std::string("isolux_environment_") +
                                               ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~LoadEnvironmentTest() override { fs::remove_all(folder_); }

    fs::path write(const std::string& name, const OIIO::ImageSpec& spec, const std::vector<float>& values) {
        const fs::path path = folder_ / name;
        const auto output = OIIO::ImageOutput::create(path.string());
        EXPECT_TRUE(output && output->open(path.string(), spec) &&
                    output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close());
        return path;
    }
    static OIIO::ImageSpec sized(int width, int height, int channels) {
        return {width, height, channels, OIIO::TypeDesc::FLOAT};
    }
    static std::string failure(const fs::path& path) {
        try {
            (void)loadEnvironmentMap(path);
            return {};
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::badInput);
            EXPECT_EQ(std::string(error.what()).find(path.string()), 0u) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
    }

    fs::path folder_;
};

TEST_F(LoadEnvironmentTest, OpenExrIsReadAsStored) {
    const auto map = loadEnvironmentMap(write("sky.exr", sized(2, 2, 3), {1, 2, 3, 4, 5, 6, 7, 8, 9, 1e6f, 0, 0.125f}));
    EXPECT_EQ(map->name, "sky.exr");
    EXPECT_EQ(map->width, 2u);
    EXPECT_EQ(map->height, 2u);
    EXPECT_EQ(map->texels, (std::vector<Vec3f>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {1e6f, 0, 0.125f}}));
}

/// The only chunk of a small file is said to begin where its table of offsets ends; elsewhere outside the file nothing
/// may be read.
TEST_F(LoadEnvironmentTest, OffsetsOutsideTheFileAreRefused) {
    for (const std::int64_t offset : {std::int64_t{-1}, std::int64_t{1} << 40}) {
        const fs::path path = write("offset.exr", sized(2, 2, 3), std::vector<float>(12, 1.0f));
        std::vector<char> bytes(fs::file_size(path));
        std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        std::size_t entry = 0;
        const auto valueAt = [&](std::size_t place) {
            std::uint64_t value = 0;
            std::memcpy(&value, bytes.data() + place, sizeof(value));
            return value;
        };
        while (entry + 8 < bytes.size() && valueAt(entry) != entry + 8) ++entry;
        ASSERT_LT(entry + 8, bytes.size()) << "no table found";
        std::memcpy(bytes.data() + entry, &offset, sizeof(offset));
        std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        EXPECT_NE(failure(path).find("cannot be decoded"), std::string::npos) << offset;
    }
}

TEST_F(LoadEnvironmentTest, AlphaIsIgnoredAndGreyRepeated) {
    const auto rgba = loadEnvironmentMap(write("a.exr", sized(2, 1, 4), {1, 2, 3, 0, 4, 5, 6, 0.5f}));
    EXPECT_EQ(rgba->texels, (std::vector<Vec3f>{{1, 2, 3}, {4, 5, 6}}));
    const auto grey = loadEnvironmentMap(write("b.exr", sized(2, 1, 1), {1, 2}));
    EXPECT_EQ(grey->texels, (std::vector<Vec3f>{{1, 1, 1}, {2, 2, 2}}));
    const auto greyAlpha = loadEnvironmentMap(write("c.exr", sized(2, 1, 2), {1, 0, 2, 0.5f}));
    EXPECT_EQ(greyAlpha->texels, (std::vector<Vec3f>{{1, 1, 1}, {2, 2, 2}}));
}

TEST_F(LoadEnvironmentTest, RadianceAndHalfArePreciseWhereTheyCan) {
    const auto hdr = loadEnvironmentMap(write("a.hdr", sized(2, 1, 3), {1, 0.5f, 0.25f, 8, 4, 2}));
    EXPECT_EQ(hdr->texels, (std::vector<Vec3f>{{1, 0.5f, 0.25f}, {8, 4, 2}}));
    OIIO::ImageSpec half(2, 1, 3, OIIO::TypeDesc::HALF);
    EXPECT_EQ(loadEnvironmentMap(write("b.exr", half, {1, 0.5f, 0, 2, 65504, 3}))->texels,
              (std::vector<Vec3f>{{1, 0.5f, 0}, {2, 65504, 3}}));
}

TEST_F(LoadEnvironmentTest, WhatIsNoRadianceIsNamedByItsTexel) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float wrong : {-0.5f, infinity, nan}) {
        std::vector<float> values(2 * 3 * 3, 1.0f);
        values[3 * 3 + 1] = wrong; // column 1 of row 1
        values[3 * 5] = wrong;
        const std::string message = failure(write("a.exr", sized(2, 3, 3), values));
        EXPECT_NE(message.find("texel (1, 1) is (1, "), std::string::npos) << message;
        EXPECT_NE(message.find("finite and not negative"), std::string::npos) << message;
    }
}

TEST_F(LoadEnvironmentTest, OtherFilesAreRefused) {
    EXPECT_NE(failure(folder_ / "no.exr").find("does not exist"), std::string::npos);
    EXPECT_NE(failure(folder_).find("this is a directory"), std::string::npos);
    std::ofstream(folder_ / "text.exr") << "hello";
    EXPECT_NE(failure(folder_ / "text.exr").find("neither Radiance .hdr nor OpenEXR"), std::string::npos);
    std::ofstream(folder_ / "start.exr") << "\x76\x2F\x31\x01";
    EXPECT_NE(failure(folder_ / "start.exr").find("header is cut short or damaged"), std::string::npos);
    const OIIO::ImageSpec bytes(1, 1, 3, OIIO::TypeDesc::UINT8);
    EXPECT_NE(failure(write("a.png", bytes, {1, 1, 1})).find("neither Radiance"), std::string::npos);
    const OIIO::ImageSpec integers(1, 1, 3, OIIO::TypeDesc::UINT32);
    EXPECT_NE(failure(write("a.exr", integers, {1, 1, 1})).find("texels are integers"), std::string::npos);
    OIIO::ImageSpec cropped = sized(2, 1, 3);
    cropped.full_width = 4;
    EXPECT_NE(failure(write("b.exr", cropped, std::vector<float>(6, 1.0f))).find("data window"), std::string::npos);
}

/// An OpenEXR file that is all header.
class Header {
public:
    Header& add(const std::string& name, const std::string& type, const std::string& value) {
        return claim(name, type, static_cast<std::int32_t>(value.size()), value);
    }
    Header& claim(const std::string& name, const std::string& type, std::int32_t size, const std::string& value) {
        bytes_ += name + '\0' + type + '\0' + integers({size}) + value;
        return *this;
    }
    static std::string integers(const std::vector<std::int32_t>& values) {
        return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(std::int32_t)};
    }
    [[nodiscard]] std::string bytes() const { return bytes_ + '\0'; }

private:
    std::string bytes_ = "\x76\x2F\x31\x01" + integers({2});
};

TEST_F(LoadEnvironmentTest, HeadersOfOpenExrClaimNoMoreThanTheirBytes) {
    const auto message = [&](const Header& header) {
        std::ofstream(folder_ / "a.exr", std::ios::binary) << header.bytes() << std::string(100, '\0');
        return failure(folder_ / "a.exr");
    };
    const auto expect = [&](const Header& header, const char* part) {
        const std::string text = message(header);
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    expect(Header().claim("note", "madeUp", 846753634, ""), "header is cut short or damaged");
    expect(Header().claim("note", "madeUp", -1, ""), "header is cut short or damaged");
    expect(Header().add("dataWindow", "box2i", "short"), "header is cut short or damaged");
    expect(Header().add("dataWindow", "text", std::string(16, '\0')), "header is cut short or damaged");
    expect(Header().add("channels", "chlist", "R"), "header is cut short or damaged");
    const std::string large = Header::integers({0, 0, 16383, 16383});
    expect(Header().add("dataWindow", "box2i", large), "it claims 16384 x 16384 texels");
    const std::string tall = Header::integers({0, 0, 0, 1 << 18});
    expect(Header().add("dataWindow", "box2i", tall), "it claims 1 x 262145 texels");
    expect(Header().add("dataWindow", "box2i", Header::integers({5, 5, 1, 1})), "not an image that can be read");
    expect(Header().add("preview", "preview", Header::integers({1 << 15, 1 << 14})), "not an image that can be read");
    expect(Header().add("texts", "stringvector", Header::integers({1 << 30})), "not an image that can be read");
}

TEST_F(LoadEnvironmentTest, TruncatedAndHugeFilesAreRefused) {
    std::vector<float> values(64 * 32 * 3);
    std::uint32_t state = 1;
    for (float& value : values) value = static_cast<float>((state = state * 1664525u + 1013904223u) >> 8);
    for (const char* name : {"a.exr", "a.hdr"}) {
        const fs::path path = write(name, sized(64, 32, 3), values);
        EXPECT_TRUE(failure(path).empty());
        const std::uintmax_t size = fs::file_size(path);
        for (const std::uintmax_t length : {size - 100, size / 2, std::uintmax_t{40}, std::uintmax_t{0}}) {
            fs::resize_file(path, length);
            EXPECT_FALSE(failure(path).empty()) << name << " " << length;
        }
    }
    std::ofstream(folder_ / "huge.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 65535 +X 65535\n....";
    EXPECT_FALSE(failure(folder_ / "huge.hdr").empty());
}

TEST(SharedScenes, EnvironmentMapsLoad) {
    const std::optional<fs::path> scenes = sharedScenes();
    if (!scenes) return;
    const fs::path folder = *scenes / "env";
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto map = loadEnvironmentMap(entry.path());
        EXPECT_EQ(map->texels.size(), std::size_t{map->width} * map->height) << entry.path();
        EXPECT_EQ(map->width, 2 * map->height) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 6u);
    const auto white = loadEnvironmentMap(folder / "white_furnace_1.hdr");
    for (const Vec3f& texel : white->texels) ASSERT_EQ(texel, Vec3f(1.0f));
}

} // namespace
} // namespace isolux
