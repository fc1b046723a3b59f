#include "app/reference_cache.h"

#include "app/method_names.h"
#include "core/log.h"
#include "load/bytes.h"
#include "report/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

constexpr const char* kKeyEntry = "isolux/referenceKey";

bool isFinite(const Image& image) {
    return std::all_of(image.values.begin(), image.values.end(), [](float value) { return std::isfinite(value); });
}

} // namespace

std::string referenceKey(const SceneRun& run, const RenderSettings& settings, const std::string& backend) {
    std::string key =
        fmt::format("isolux {} --backend {}, scene {},{} --size {}x{} --camera {}", ISOLUX_VERSION, backend,
                    run.scene.contentHash, run.environment.options, settings.width, settings.height, settings.camera);
    if (settings.maxDepth != kUnlimitedDepth) key += fmt::format(" --max-depth {}", settings.maxDepth);
    for (const MethodChoice& method : methodsOf(settings)) key += fmt::format(" --{} {}", method.option, method.value);
    return key;
}

ReferenceCache::ReferenceCache(std::filesystem::path folder, std::string key)
    : folder_(std::move(folder)), key_(std::move(key)) {}

std::filesystem::path ReferenceCache::path(std::uint32_t index) const {
    if (folder_.empty()) return {};
    ContentHash hash;
    hash.add(Bytes(key_.begin(), key_.end()));
    return folder_ / fmt::format("{}-{}.exr", hash.hexadecimal(), index + 1);
}

std::optional<Image> ReferenceCache::find(std::uint32_t index, std::uint64_t samples) const {
    std::error_code ignored;
    if (folder_.empty() || !std::filesystem::exists(path(index), ignored)) return std::nullopt;
    try {
        Image image = readImage(path(index));
        if (metadataText(image.metadata, kKeyEntry) != key_) return std::nullopt; // another one of the same hash
        if (metadataUnsigned(image.metadata, "isolux/sampleCount").value_or(0) < samples) return std::nullopt;
        if (image.rgbChannels() && isFinite(image)) return image;
        spdlog::warn("{}: not a reference; it is rendered again", path(index).string());
    } catch (const std::exception& error) {
        spdlog::warn("{}; it is rendered again", error.what());
    }
    return std::nullopt;
}

void ReferenceCache::store(std::uint32_t index, Image image) const {
    if (folder_.empty()) return;
    image.metadata[kKeyEntry] = key_;
    try {
        std::filesystem::create_directories(folder_);
        writeImage(path(index), image);
    } catch (const std::exception& error) {
        spdlog::warn("{}; the reference is not kept", error.what());
    }
}

} // namespace isolux
