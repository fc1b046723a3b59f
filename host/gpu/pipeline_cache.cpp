#include "gpu/pipeline_cache.h"

#include "core/log.h"
#include "core/platform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <utility>

namespace isolux {
namespace {

constexpr std::array<char, 8> kMagic{'I', 'S', 'O', 'L', 'U', 'X', 'P', 'C'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderBytes = 64; // magic, version, driver, kernel, size, checksum
constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 28;
constexpr std::size_t kMostFiles = 128;
constexpr const char* kExtension = ".pipeline";

/// 64-bit FNV-1a (Fowler, Noll and Vo), one number after another in little-endian order.
class Fnv {
public:
    void add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) state_ = (state_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001B3u;
    }
    void add(std::uint32_t word) {
        for (int i = 0; i < 4; ++i) state_ = (state_ ^ (word >> 8 * i & 0xFFu)) * 0x100000001B3u;
    }
    [[nodiscard]] std::uint64_t state() const { return state_; }

private:
    std::uint64_t state_ = 0xCBF29CE484222325u;
};

void append(std::vector<std::byte>& bytes, std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(value >> 8 * i & 0xFFu));
}

/// All of the header but the checksum.
std::vector<std::byte> headerFor(const PipelineKey& key, std::size_t size) {
    const auto magic = std::as_bytes(std::span(kMagic));
    std::vector<std::byte> header(magic.begin(), magic.end());
    append(header, kVersion, 4);
    append(header, key.driver.vendor, 4);
    append(header, key.driver.device, 4);
    append(header, key.driver.driverVersion, 4);
    for (const std::uint8_t byte : key.driver.pipelineCacheUuid) header.push_back(static_cast<std::byte>(byte));
    append(header, key.kernel, 8);
    append(header, size, 8);
    return header;
}

std::vector<std::byte> checksumOf(std::span<const std::byte> header, std::span<const std::byte> data) {
    Fnv hash;
    hash.add(header);
    hash.add(data);
    std::vector<std::byte> bytes;
    append(bytes, hash.state(), 8);
    return bytes;
}

std::vector<std::byte> readFile(const std::filesystem::path& path) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || size > kLargestFile) return {};
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::ifstream file(path, std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) return {};
    return bytes;
}

bool writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return static_cast<bool>(file.flush());
}

} // namespace

std::uint64_t hashKernel(std::span<const std::uint32_t> spirv, const Specialization& specialization,
                         std::string_view maker) {
    Fnv hash;
    for (const std::uint32_t word : spirv) hash.add(word);
    for (const auto& [id, value] : specialization) {
        hash.add(id);
        hash.add(value);
    }
    hash.add(std::as_bytes(std::span(maker)));
    return hash.state();
}

std::vector<std::byte> encodePipeline(const PipelineKey& key, std::span<const std::byte> data) {
    std::vector<std::byte> file = headerFor(key, data.size());
    const std::vector<std::byte> checksum = checksumOf(file, data);
    file.insert(file.end(), checksum.begin(), checksum.end());
    file.insert(file.end(), data.begin(), data.end());
    return file;
}

DecodedPipeline decodePipeline(const PipelineKey& key, std::span<const std::byte> file) {
    if (file.size() <= kHeaderBytes) return {{}, "it is truncated"};
    const std::span<const std::byte> data = file.subspan(kHeaderBytes);
    const std::vector<std::byte> header = headerFor(key, data.size());
    // What another version, driver or kernel wrote differs from here on, and so does a file of another length.
    if (!std::equal(header.begin(), header.end(), file.begin()))
        return {{}, "it is of another driver, kernel or length"};
    const std::vector<std::byte> checksum = checksumOf(header, data);
    if (!std::equal(checksum.begin(), checksum.end(), file.begin() + static_cast<std::ptrdiff_t>(header.size())))
        return {{}, "its checksum is wrong"};
    return {{data.begin(), data.end()}, ""};
}

std::filesystem::path PipelineFolder::fileOf(const PipelineKey& key) const {
    Fnv hash;
    hash.add(headerFor(key, 0));
    return path_ / fmt::format("{:016x}{}", hash.state(), kExtension);
}

std::vector<std::byte> PipelineFolder::load(const PipelineKey& key) const {
    const std::filesystem::path path = fileOf(key);
    std::error_code error;
    if (!kept() || !std::filesystem::is_regular_file(path, error)) return {};
    DecodedPipeline decoded = decodePipeline(key, readFile(path));
    if (!decoded.problem.empty()) spdlog::debug("pipeline cache {}: ignored, {}", path.string(), decoded.problem);
    return std::move(decoded.data);
}

void PipelineFolder::store(const PipelineKey& key, std::span<const std::byte> data) const {
    if (!kept()) return;
    std::error_code error;
    std::filesystem::create_directories(path_, error);
    const std::filesystem::path target = fileOf(key);
    std::filesystem::path temporary = target;
    temporary += fmt::format(".{}.tmp", processId());
    // Not flushed to disk: a file that a power cut tears has a wrong checksum.
    const bool written = !error && writeFile(temporary, encodePipeline(key, data));
    if (written) std::filesystem::rename(temporary, target, error);
    if (written && !error) {
        removeOldest();
        return;
    }
    spdlog::debug("pipeline cache {}: cannot be written", target.string());
    std::filesystem::remove(temporary, error);
}

/// Also of what an interrupted process left under a temporary name.
void PipelineFolder::removeOldest() const {
    std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(path_, error)) {
        std::error_code ignored;
        if (entry.path().filename().string().find(kExtension) == std::string::npos) continue;
        files.emplace_back(entry.last_write_time(ignored), entry.path());
    }
    if (files.size() <= kMostFiles) return;
    std::sort(files.begin(), files.end());
    files.resize(files.size() - kMostFiles);
    for (const auto& file : files) std::filesystem::remove(file.second, error);
}

} // namespace isolux
