// What drivers, and specialize.h before them, make of kernels, kept in files from one run to the next. A file that is
// damaged, or was written by another driver, is as good as none; a folder that cannot be written to is no error.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isolux {

/// Specialisation constants by id; booleans are 0 or 1.
using Specialization = std::map<std::uint32_t, std::uint32_t>;

/// Which driver's pipelines are of use on a device.
struct DriverIdentity {
    std::uint32_t vendor = 0;
    std::uint32_t device = 0;
    std::uint32_t driverVersion = 0;
    std::array<std::uint8_t, 16> pipelineCacheUuid{};

    friend bool operator==(const DriverIdentity&, const DriverIdentity&) = default;
};

/// What a pipeline was made by, and from.
struct PipelineKey {
    DriverIdentity driver;
    std::uint64_t kernel = 0; ///< hashKernel

    friend bool operator==(const PipelineKey&, const PipelineKey&) = default;
};

/// 64-bit FNV-1a of the module, its constants and, for what is not a driver's, the name of what makes something of
/// them. Drivers tell pipelines apart themselves; among the other files of a folder, 128 at most, two hashes meet by
/// chance with a probability below 2^-50 (birthdays: 128^2 / 2 / 2^64).
[[nodiscard]] std::uint64_t hashKernel(std::span<const std::uint32_t> spirv, const Specialization& specialization,
                                       std::string_view maker = {});

/// The bytes of a file that holds a driver's data for this key.
[[nodiscard]] std::vector<std::byte> encodePipeline(const PipelineKey& key, std::span<const std::byte> data);

struct DecodedPipeline {
    std::vector<std::byte> data;
    std::string problem; ///< why there is no data; empty if there is
};
/// The reverse. Nothing but what `encodePipeline` made for the same key, to the last bit, is accepted.
[[nodiscard]] DecodedPipeline decodePipeline(const PipelineKey& key, std::span<const std::byte> file);

/// A folder with a file for each key. Several processes may use it at once: files are replaced as a whole.
class PipelineFolder {
public:
    /// An empty path: nothing is kept.
    explicit PipelineFolder(std::filesystem::path path) : path_(std::move(path)) {}

    [[nodiscard]] bool kept() const { return !path_.empty(); }
    [[nodiscard]] std::filesystem::path fileOf(const PipelineKey& key) const;

    /// The driver's data; empty if there is none that is sound.
    [[nodiscard]] std::vector<std::byte> load(const PipelineKey& key) const;
    /// Makes the folder if need be, and removes the oldest files where there are too many.
    void store(const PipelineKey& key, std::span<const std::byte> data) const;

private:
    void removeOldest() const;

    std::filesystem::path path_;
};

} // namespace isolux
