// Files of compiled pipelines: what was stored comes back, and nothing else does.
#include "gpu/pipeline_cache.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>

namespace isolux {
namespace {

constexpr std::size_t kHeaderBytes = 64;

std::vector<std::byte> bytesOf(std::size_t count) {
    std::vector<std::byte> bytes(count);
    for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i * 7 + 1);
    return bytes;
}

PipelineKey someKey() {
    PipelineKey key{{0x10005, 7, 3, {}}, 0x123456789ABCDEF0u};
    for (std::size_t i = 0; i < key.driver.pipelineCacheUuid.size(); ++i)
        key.driver.pipelineCacheUuid[i] = static_cast<std::uint8_t>(200 + i);
    return key;
}

/// Keys that differ from `someKey` by one part each.
std::vector<PipelineKey> foreignKeys() {
    std::vector<PipelineKey> keys(6, someKey());
    keys[0].driver.vendor ^= 1;
    keys[1].driver.device ^= 1u << 31;
    keys[2].driver.driverVersion ^= 1u << 8;
    keys[3].driver.pipelineCacheUuid[15] ^= 1;
    keys[4].kernel ^= 1;
    keys[5].kernel ^= std::uint64_t{1} << 63;
    return keys;
}

TEST(PipelineFile, WhatWasEncodedIsDecoded) {
    for (const std::size_t size : {1u, 33u, 5000u}) {
        const std::vector<std::byte> data = bytesOf(size);
        const DecodedPipeline decoded = decodePipeline(someKey(), encodePipeline(someKey(), data));
        EXPECT_EQ(decoded.data, data);
        EXPECT_EQ(decoded.problem, "");
    }
}

TEST(PipelineFile, NoOtherLengthIsAccepted) {
    std::vector<std::byte> file = encodePipeline(someKey(), bytesOf(40));
    for (std::size_t size = 0; size < file.size(); ++size) {
        const DecodedPipeline decoded = decodePipeline(someKey(), std::span(file).first(size));
        EXPECT_TRUE(decoded.data.empty()) << size;
        EXPECT_NE(decoded.problem, "") << size;
    }
    file.push_back(std::byte{0});
    EXPECT_TRUE(decodePipeline(someKey(), file).data.empty());
    EXPECT_TRUE(decodePipeline(someKey(), encodePipeline(someKey(), {})).data.empty());
}

TEST(PipelineFile, EveryFlippedBitIsNoticed) {
    std::vector<std::byte> file = encodePipeline(someKey(), bytesOf(40));
    for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
        file[bit / 8] ^= std::byte{1} << bit % 8;
        EXPECT_TRUE(decodePipeline(someKey(), file).data.empty()) << "bit " << bit;
        file[bit / 8] ^= std::byte{1} << bit % 8;
    }
    EXPECT_FALSE(decodePipeline(someKey(), file).data.empty());
}

TEST(PipelineFile, OtherDriversAndKernelsAreRefused) {
    const std::vector<std::byte> file = encodePipeline(someKey(), bytesOf(40));
    for (const PipelineKey& key : foreignKeys()) EXPECT_TRUE(decodePipeline(key, file).data.empty());
}

TEST(PipelineFile, KernelsDifferByCodeAndConstants) {
    const std::vector<std::uint32_t> code{1, 2, 3};
    const std::vector<std::uint32_t> other{1, 2, 4};
    EXPECT_EQ(hashKernel(code, {{1, 2}}), hashKernel(code, {{1, 2}}));
    EXPECT_NE(hashKernel(code, {{1, 2}}), hashKernel(other, {{1, 2}}));
    EXPECT_NE(hashKernel(code, {{1, 2}}), hashKernel(code, {{1, 3}}));
    EXPECT_NE(hashKernel(code, {{1, 2}}), hashKernel(code, {{2, 2}}));
    EXPECT_NE(hashKernel(code, {}), hashKernel(code, {{0, 0}}));
}

class PipelineFolderTest : public ::testing::Test {
protected:
    PipelineFolderTest()
        : path_(std::filesystem::temp_directory_path() / ("isolux-pipelines-" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~PipelineFolderTest() override { std::filesystem::remove_all(path_); }

    [[nodiscard]] std::size_t fileCount(const std::filesystem::path& folder) const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
    }

    std::filesystem::path path_;
};

TEST_F(PipelineFolderTest, KeepsAFileForEachKey) {
    const PipelineFolder folder(path_ / "made" / "here");
    EXPECT_TRUE(folder.load(someKey()).empty());
    folder.store(someKey(), bytesOf(50));
    for (const PipelineKey& key : foreignKeys()) {
        EXPECT_TRUE(folder.load(key).empty());
        EXPECT_NE(folder.fileOf(key), folder.fileOf(someKey()));
    }
    folder.store(foreignKeys()[4], bytesOf(10));
    EXPECT_EQ(folder.load(someKey()), bytesOf(50));
    EXPECT_EQ(folder.load(foreignKeys()[4]), bytesOf(10));
    folder.store(someKey(), bytesOf(60));
    EXPECT_EQ(folder.load(someKey()), bytesOf(60));
    EXPECT_EQ(fileCount(path_ / "made" / "here"), 2u) << "no temporary file is left";
}

TEST_F(PipelineFolderTest, DamagedFilesAreAsGoodAsNone) {
    const PipelineFolder folder(path_);
    folder.store(someKey(), bytesOf(50));
    const std::filesystem::path file = folder.fileOf(someKey());
    for (const std::size_t size :
         {kHeaderBytes + 49, kHeaderBytes + 1, kHeaderBytes, std::size_t{10}, std::size_t{0}}) {
        std::filesystem::resize_file(file, size);
        EXPECT_TRUE(folder.load(someKey()).empty()) << size;
    }
    folder.store(someKey(), bytesOf(50));
    EXPECT_EQ(folder.load(someKey()), bytesOf(50)) << "the next run mends it";
    std::filesystem::rename(file, folder.fileOf(foreignKeys()[0]));
    EXPECT_TRUE(folder.load(foreignKeys()[0]).empty()) << "another key's file under this key's name";
    std::filesystem::create_directory(file);
    EXPECT_TRUE(folder.load(someKey()).empty());
    folder.store(someKey(), bytesOf(50)); // no harm done
    EXPECT_TRUE(folder.load(someKey()).empty());
}

TEST_F(PipelineFolderTest, FoldersThatCannotBeWrittenAreNoError) {
    std::ofstream(path_ / "file") << "no folder";
    for (const std::filesystem::path& path :
         {path_ / "file", path_ / "file" / "below", std::filesystem::path("/proc/isolux"), std::filesystem::path()}) {
        const PipelineFolder folder(path);
        folder.store(someKey(), bytesOf(50));
        EXPECT_TRUE(folder.load(someKey()).empty()) << path;
    }
    EXPECT_EQ(fileCount(path_), 1u);
}

TEST_F(PipelineFolderTest, TheOldestFilesGo) {
    const PipelineFolder folder(path_);
    std::ofstream(path_ / "letter.txt") << "not ours";
    PipelineKey key = someKey();
    for (std::uint64_t i = 0; i < 140; ++i) {
        key.kernel = i;
        folder.store(key, bytesOf(8));
        const auto age = std::chrono::seconds(1000 - i);
        std::filesystem::last_write_time(folder.fileOf(key), std::filesystem::file_time_type::clock::now() - age);
    }
    EXPECT_EQ(fileCount(path_), 129u) << "128, and what is not ours";
    EXPECT_FALSE(folder.load(key).empty());
    key.kernel = 0;
    EXPECT_TRUE(folder.load(key).empty());
}

} // namespace
} // namespace isolux
