// libFuzzer's target: bytes as scene, image or environment map, told by how they begin. The loader may refuse them with
// an Error of bad input that names the file, and nothing else: another exception, a fault that a sanitizer sees, a
// leak, or more memory or time than the limits allow is a finding.
#include "core/error.h"
#include "load/context.h"
#include "load/environment_file.h"
#include "load/gltf.h"
#include "load/image_decoder.h"

#include <OpenImageIO/imageio.h>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>

using namespace isolux;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

/// Far below what people render: what a small input may cost shows at once.
constexpr LoadLimits kLimits{512, std::uint64_t{1} << 22, std::uint64_t{1} << 22, 0x1p16};

/// An empty folder of this process, for URIs to lead into. libFuzzer ends without cleaning up: `run` does.
const fs::path& folder() {
    static const fs::path kFolder = [] {
        std::string name = fs::temp_directory_path() / "isolux_fuzz_XXXXXX";
        if (mkdtemp(name.data()) == nullptr) std::abort();
        return fs::path(name);
    }();
    return kFolder;
}

std::string_view asText(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

void loadAsEnvironment(ByteSpan bytes, const fs::path& file) {
    std::ofstream(file, std::ios::binary).write(asText(bytes).data(), static_cast<std::streamsize>(bytes.size()));
    (void)loadEnvironmentMap(file, kLimits);
}

void loadAsImage(ByteSpan bytes, const fs::path& file) {
    LoadContext context(file.string(), kLimits);
    const nlohmann::json image = nlohmann::json::object();
    (void)decodeImage({bytes, JsonReader(image, "/images/0", context)}, kLimits.texelBytes);
}

void load(ByteSpan bytes, const fs::path& file) {
    const std::string_view text = asText(bytes);
    for (const std::string_view start : {"#?"sv, "\x76\x2F\x31\x01"sv})
        if (text.starts_with(start)) return loadAsEnvironment(bytes, file);
    for (const std::string_view start : {"\x89PNG"sv, "\xFF\xD8\xFF"sv, "RIFF"sv})
        if (text.starts_with(start)) return loadAsImage(bytes, file);
    (void)loadSceneFromBytes(bytes, file, kLimits);
}

void requireOneLineOfBadInput(const Error& error, const fs::path& file) {
    const std::string_view message = error.what();
    if (error.code() == ExitCode::badInput && message.starts_with(file.string() + ": ") &&
        message.find('\n') == std::string_view::npos)
        return;
    std::fprintf(stderr, "not a message as promised: '%s'\n", error.what());
    std::abort();
}

constexpr std::size_t kGlbHeaders = 20; // of the file, and of the chunk of JSON

std::uint32_t wordAt(const std::uint8_t* bytes) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof(word));
    return word;
}

bool isGlb(const std::uint8_t* data, std::size_t size) {
    return size >= kGlbHeaders && asText({data, 4}) == "glTF" && wordAt(data + 12) <= size - kGlbHeaders;
}

/// Changes the JSON of a GLB and mends the lengths, which changes of single bytes would break for good.
std::size_t mutateGlb(std::uint8_t* data, std::size_t size, std::size_t maxSize) {
    const std::size_t jsonSize = wordAt(data + 12);
    const std::vector<std::uint8_t> rest(data + kGlbHeaders + jsonSize, data + size);
    const std::size_t room = maxSize - kGlbHeaders - rest.size();
    const std::size_t changed = LLVMFuzzerMutate(data + kGlbHeaders, jsonSize, room);
    std::copy(rest.begin(), rest.end(), data + kGlbHeaders + changed);
    const auto total = static_cast<std::uint32_t>(kGlbHeaders + changed + rest.size());
    const auto json = static_cast<std::uint32_t>(changed);
    std::memcpy(data + 8, &total, sizeof(total));
    std::memcpy(data + 12, &json, sizeof(json));
    return total;
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", 1);
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned seed) {
    const bool mendsLengths = isGlb(data, size) && std::minstd_rand(seed)() % 4 != 0;
    return mendsLengths ? mutateGlb(data, size, maxSize) : LLVMFuzzerMutate(data, size, maxSize);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const fs::path file = folder() / "input";
    try {
        load({data, size}, file);
    } catch (const Error& error) {
        requireOneLineOfBadInput(error, file);
    }
    return 0;
}
