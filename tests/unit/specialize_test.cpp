// Folded kernels in a folder: what is kept is used, and whatever is wrong with a file, the same module comes out.
#include "gpu/specialize.h"

#include "kernels/spirv.h"
#include "shared/interface.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>

namespace isolux {
namespace {

using Words = std::vector<std::uint32_t>;

const std::span<const std::uint32_t> kModule = kernels::intersect;

Specialization constants(std::uint32_t workgroupSize) { return {{shared::kSpecWorkgroupSize, workgroupSize}}; }

class KeptSpecialization : public ::testing::Test {
protected:
    KeptSpecialization()
        : path_(std::filesystem::temp_directory_path() / ("isolux-folded-" + std::to_string(::getpid()))),
          folder_(path_) {}
    ~KeptSpecialization() override { std::filesystem::remove_all(path_); }

    [[nodiscard]] std::filesystem::path file() const { return folder_.fileOf(specializedKey(kModule, constants(64))); }

    std::filesystem::path path_;
    PipelineFolder folder_;
};

TEST_F(KeptSpecialization, IsTheSameModule) {
    const Words folded = specialize(kModule, constants(64));
    ASSERT_NE(folded, specialize(kModule, constants(32)));
    EXPECT_EQ(specialize(kModule, constants(64), folder_), folded);
    EXPECT_TRUE(std::filesystem::exists(file()));
    EXPECT_EQ(specialize(kModule, constants(64), folder_), folded);
    EXPECT_EQ(specialize(kModule, constants(32), folder_), specialize(kModule, constants(32)));
    EXPECT_EQ(specialize(kModule, constants(64), PipelineFolder({})), folded);
}

TEST_F(KeptSpecialization, IsReadInsteadOfFoldingAgain) {
    const Words marker{1, 2, 3};
    folder_.store(specializedKey(kModule, constants(64)), std::as_bytes(std::span(marker)));
    EXPECT_EQ(specialize(kModule, constants(64), folder_), marker);
}

TEST_F(KeptSpecialization, DamageIsMended) {
    const Words folded = specialize(kModule, constants(64), folder_);
    const auto size = std::filesystem::file_size(file());
    for (const std::uintmax_t left : {size - 1, size - 4, std::uintmax_t{64}, std::uintmax_t{0}}) {
        std::filesystem::resize_file(file(), left);
        EXPECT_EQ(specialize(kModule, constants(64), folder_), folded) << left << " bytes left";
        EXPECT_EQ(std::filesystem::file_size(file()), size);
    }
    std::fstream(file(), std::ios::in | std::ios::out | std::ios::binary).seekp(500).put('\x7F').put('\x80');
    EXPECT_TRUE(folder_.load(specializedKey(kModule, constants(64))).empty());
    EXPECT_EQ(specialize(kModule, constants(64), folder_), folded);
    EXPECT_FALSE(folder_.load(specializedKey(kModule, constants(64))).empty());
}

TEST_F(KeptSpecialization, BelongsToNoDriver) {
    const PipelineKey key = specializedKey(kModule, constants(64));
    EXPECT_EQ(key.driver, DriverIdentity{});
    EXPECT_NE(key.kernel, hashKernel(kModule, constants(64)));
    EXPECT_NE(key, specializedKey(kModule, constants(32)));
    EXPECT_NE(key, specializedKey(kernels::path, constants(64)));
}

} // namespace
} // namespace isolux
