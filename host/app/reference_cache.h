// Keeps references, images of many samples, between runs: by what they converge to.
#pragma once

#include "app/backends.h"
#include "film/image.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace isolux {

/// Everything that decides what a render converges to, in words: program, scene, environment, camera, size, methods.
/// `settings` are those of the references.
[[nodiscard]] std::string referenceKey(const SceneRun& run, const RenderSettings& settings, const std::string& backend);

class ReferenceCache {
public:
    /// `folder`: made when something is stored; empty: nothing is kept.
    ReferenceCache(std::filesystem::path folder, std::string key);

    /// Reference number `index` if there is one of the same key, with at least so many samples a pixel. A damaged file
    /// is as good as none; that is logged.
    [[nodiscard]] std::optional<Image> find(std::uint32_t index, std::uint64_t samples) const;
    /// Keeps the image, which gets the key as metadata. A failure is logged: it costs time, not correctness.
    void store(std::uint32_t index, Image image) const;
    /// Where reference number `index` is or would be; empty if nothing is kept.
    [[nodiscard]] std::filesystem::path path(std::uint32_t index) const;

private:
    std::filesystem::path folder_;
    std::string key_;
};

} // namespace isolux
