// The shared test scenes, for tests of loading them.
#pragma once

#include "load/gltf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace isolux {

namespace fs = std::filesystem;

/// The shared test scenes beside the checkout, or nothing after having skipped or failed the test.
inline std::optional<fs::path> sharedScenes() {
    const fs::path folder = fs::path(ISOLUX_SOURCE_DIR) / ".." / "shared" / "scenes";
    if (fs::is_directory(folder)) return folder;
    const auto report = [&]() {
        if (std::getenv("CI") != nullptr) FAIL() << "needs " << folder << ", which is not there";
        GTEST_SKIP() << "needs the test scenes in ../shared";
    };
    report();
    return std::nullopt;
}

inline std::vector<fs::path> gltfFilesIn(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
    return files;
}

} // namespace isolux
