// The glTF loader survives damaged and hostile files: text, containers, URIs that reach elsewhere, amplification.
#include "unit/load_fixture.h"

#ifdef __unix__
#include <sys/stat.h>
#endif

namespace isolux::load_test {
namespace {

TEST_F(LoadTest, MalformedTextIsRefused) {
    EXPECT_MENTIONS(failure(std::string()), "scene.gltf: the file is empty");
    EXPECT_MENTIONS(failure(std::string("{\"a\": 1,\n  oops}")), "error at line 2, column 3");
    EXPECT_MENTIONS(failure(std::string("{\"\xFF\": 1}")), "valid JSON");
    EXPECT_MENTIONS(failure(std::string("{\"a\": 1e999}")), "too large");
    EXPECT_MENTIONS(failure(std::string("[]")), "must be an object, not array");
    EXPECT_MENTIONS(failure(std::string(3000000, '[')), "nested deeper than 128 levels");
    EXPECT_MENTIONS(failure("{\"extras\":" + std::string(30000, '[') + std::string(30000, ']') + "}"), "128 levels");
    std::string many = "[0";
    for (int i = 0; i < (1 << 24) + 1; ++i) many += ",0";
    EXPECT_MENTIONS(failure(many), "values");
}

TEST_F(LoadTest, MalformedBinaryFilesAreRefused) {
    const std::string text = chunk(triangleDocument().dump(), "JSON", ' ');
    EXPECT_TRUE(failure(glb(text)).empty());
    EXPECT_MENTIONS(failure(std::string("glTF")), "header is cut short");
    EXPECT_MENTIONS(failure("glTF" + word(1) + word(12)), "version 1");
    EXPECT_MENTIONS(failure("glTF" + word(2) + word(0)), "claims 0 bytes");
    EXPECT_MENTIONS(failure("glTF" + word(2) + word(0xFFFFFFFFu) + text), "claims 4294967295 bytes");
    EXPECT_MENTIONS(failure(glb("")), "stray bytes");
    EXPECT_MENTIONS(failure(glb(word(0x7FFFFFFFu) + "JSON{}  ")), "claims 2147483647 bytes but only 4");
    EXPECT_MENTIONS(failure(glb(chunk("", "JSON", ' '))), "valid JSON");
    EXPECT_MENTIONS(failure(glb(chunk("x", std::string("BIN\0", 4), ' '))), "first GLB chunk is not JSON");
    EXPECT_MENTIONS(failure(glb(text + text)), "two JSON chunks");
    EXPECT_TRUE(failure(glb(text + word(0) + std::string("BIN\0", 4))).empty());
    json document = triangleDocument();
    document["buffers"][0].erase("uri");
    const std::string empty = word(0) + std::string("BIN\0", 4);
    EXPECT_MENTIONS(failure(glb(chunk(document.dump(), "JSON", ' ') + empty)), "there are only 0 bytes of data");
}

TEST_F(LoadTest, UrisCannotLeaveTheFolder) {
    std::ofstream(folder_ / "secret.bin", std::ios::binary) << bytesOf(kTriangle);
    fs::create_directory(folder_ / "scene" / "sub");
    fs::create_symlink(folder_ / "secret.bin", folder_ / "scene" / "link.bin");
    fs::create_directory_symlink(folder_, folder_ / "scene" / "up");
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"../secret.bin", "leads out of the scene's folder"},
        {"%2e%2e/secret.bin", "leads out of the scene's folder"},
        {"sub/../../secret.bin", "leads out of the scene's folder"},
        {"link.bin", "leads out of the scene's folder"},
        {"up/secret.bin", "leads out of the scene's folder"},
        {"../../../../../../../../etc/hostname", "leads out of the scene's folder"},
        {(folder_ / "scene" / "scene.gltf").string(), "absolute path"},
        {"%2Fetc/hostname", "absolute path"},
        {"file:///etc/hostname", "not a relative path"},
        {"http://example.org/a.bin", "not a relative path"},
        {"sub", "this is a directory"},
        {".", "leads out of the scene's folder"},
        {"", "is empty"},
        {"missing.bin", "missing.bin': the file does not exist"},
        {"a%00b", "NUL"},
        {"100%", "write a percent sign as %25"},
        {"a\nb", "a?b"},
    };
    for (const auto& [uri, expected] : cases) {
        json document = triangleDocument();
        document["buffers"][0]["uri"] = uri;
        const std::string message = failure(document);
        EXPECT_MENTIONS(message, "/buffers/0/uri: ");
        EXPECT_MENTIONS(message, expected);
    }
}

#ifdef __unix__
TEST_F(LoadTest, FifosAndDevicesAreNotOpened) {
    ASSERT_EQ(mkfifo((folder_ / "scene" / "fifo").c_str(), 0600), 0);
    json document = triangleDocument();
    document["buffers"][0]["uri"] = "fifo";
    EXPECT_MENTIONS(failure(document), "not a regular file");
    EXPECT_THROW((void)loadScene(folder_ / "scene" / "fifo"), Error);
    EXPECT_THROW((void)loadScene("/dev/zero"), Error);
}
#endif

TEST_F(LoadTest, MissingFilesAndDirectoriesAreNamed) {
    EXPECT_THROW((void)loadScene(folder_ / "absent.gltf"), Error);
    EXPECT_THROW((void)loadScene(folder_), Error);
}

TEST_F(LoadTest, SmallFilesCannotExpandWithoutBound) {
    json document = triangleDocument();
    const std::size_t count = 300000;
    primitiveOf(document)["indices"] = addAccessor(document, std::string(count, '\0'), scalars(5121, count));
    json& primitives = document["meshes"][0]["primitives"];
    for (int i = 0; i < 2000; ++i) primitives.push_back(json(primitives[0]));
    EXPECT_MENTIONS(failure(document), "/meshes: the meshes expand to over 64 times the size of the buffers");
}

TEST_F(LoadTest, ManyDistinctWarningsAreCut) {
    json document = triangleDocument();
    for (int i = 0; i < 1000; ++i) document["extensionsUsed"].push_back("EXT_" + std::to_string(i));
    const Scene scene = load(document);
    EXPECT_EQ(scene.warnings.size(), 33u);
    EXPECT_EQ(scene.warnings.back(), "968 more warnings");
}

// Every truncation of a file, and every byte of it changed, ends in a Scene or an Error.
TEST_F(LoadTest, DamagedFilesAreSurvived) {
    json document = triangleDocument();
    document["buffers"][0].erase("uri");
    const std::string file =
        glb(chunk(document.dump(), "JSON", ' ') + chunk(bytesOf(kTriangle), std::string("BIN\0", 4), ' '));
    for (std::size_t i = 0; i < file.size(); ++i) {
        EXPECT_FALSE(failure(file.substr(0, i)).empty()) << i;
        for (const char change : {'\x01', '\x10', '\x80', '\xFF'}) {
            std::string damaged = file;
            damaged[i] = static_cast<char>(damaged[i] ^ change);
            (void)failure(damaged);
        }
    }
}

/// A strip of quantised vertices, some replaced by a sparse accessor, under sparse indices, beside a spot light.
std::string intricateFile() {
    const std::string data = bytesOf<std::int16_t>({0, 0, 0, 0, 9, 0, 0, 0, 0, 9, 0, 0, 9, 9, 0, 0}) + // positions
                             bytesOf<std::uint16_t>({0, 1, 2, 3, 1, 3}) + // indices, sparse ones
                             bytesOf<std::int16_t>({5, 5, 5, 7, 7, 7});   // what they replace
    const auto sparse = [](int indices, int values) {
        return json{{"count", 2},
                    {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                    {"values", {{"bufferView", values}}}};
    };
    json document = triangleDocument();
    document["buffers"] = {{{"byteLength", data.size()}}};
    document["bufferViews"] = {{{"buffer", 0}, {"byteLength", 32}, {"byteStride", 8}},
                               {{"buffer", 0}, {"byteOffset", 32}, {"byteLength", 8}},
                               {{"buffer", 0}, {"byteOffset", 40}, {"byteLength", 4}},
                               {{"buffer", 0}, {"byteOffset", 44}, {"byteLength", 12}}};
    document["accessors"] = {{{"bufferView", 0}, {"componentType", 5122}, {"count", 4}, {"type", "VEC3"}},
                             {{"bufferView", 1}, {"componentType", 5123}, {"count", 4}, {"type", "SCALAR"}}};
    document["accessors"][0]["sparse"] = sparse(2, 3);
    document["accessors"][1]["sparse"] = sparse(2, 2);
    primitiveOf(document).update({{"indices", 1}, {"mode", 5}});
    document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", json::object()}}};
    document["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    return glb(chunk(document.dump(), "JSON", ' ') + chunk(data, std::string("BIN\0", 4), ' '));
}

TEST_F(LoadTest, DamagedIntricateFilesAreSurvived) {
    const std::string file = intricateFile();
    EXPECT_EQ(primitiveCount(load(file)), 2u);
    for (std::size_t i = 0; i < file.size(); ++i)
        for (const char change : {'\x01', '\x80'}) {
            std::string damaged = file;
            damaged[i] = static_cast<char>(damaged[i] ^ change);
            (void)failure(damaged);
        }
}

} // namespace
} // namespace isolux::load_test
