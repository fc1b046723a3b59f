// The one-way flow between the folders of host/, enforced on the sources themselves.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

namespace {

const std::filesystem::path kHost = std::filesystem::path(ISOLUX_SOURCE_DIR) / "host";

/// Who may include whom. `shared` is shaders/shared, `kernels` the embedded SPIR-V; app may include everything.
const std::map<std::string, std::set<std::string>> kAllowed{
    {"core", {}},
    {"scene", {"core"}},
    {"accel", {"core"}},
    {"film", {"core"}},
    {"gpu", {"core"}},
    {"load", {"core", "scene"}},
    {"pack", {"core", "scene", "accel", "shared"}},
    {"render", {"core", "scene", "pack", "gpu", "film", "shared", "kernels"}},
    {"reference", {"core", "scene", "accel", "film"}},
    {"report", {"core", "film"}},
    {"stress", {"core", "scene", "load", "pack", "gpu", "film", "render", "reference", "report", "shared"}},
};

/// The quoted includes of a source file.
std::vector<std::string> includesOf(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::vector<std::string> found;
    const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    for (std::string line; std::getline(stream, line);) {
        std::smatch match;
        if (std::regex_search(line, match, pattern)) found.push_back(match[1].str() + match[2].str());
    }
    return found;
}

std::vector<std::filesystem::path> sourcesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") files.push_back(entry.path());
    return files;
}

TEST(IncludeDirections, EveryFolderIsListed) {
    for (const auto& entry : std::filesystem::directory_iterator(kHost))
        if (entry.is_directory() && entry.path().filename() != "app") {
            EXPECT_TRUE(kAllowed.contains(entry.path().filename().string())) << entry.path();
        }
}

TEST(IncludeDirections, NothingIncludesAgainstTheFlow) {
    std::size_t checked = 0;
    for (const auto& [folder, allowed] : kAllowed)
        for (const std::filesystem::path& file : sourcesIn(kHost / folder))
            for (const std::string& include : includesOf(file)) {
                if (include.front() != '"') continue;
                const std::string from = include.substr(1, include.find('/') - 1);
                EXPECT_TRUE(from == folder || allowed.contains(from)) << file << " includes " << include.substr(1);
                ++checked;
            }
    EXPECT_GT(checked, 100u);
}

TEST(IncludeDirections, VulkanStaysInGpuAndRender) {
    for (const std::filesystem::path& file : sourcesIn(kHost)) {
        const std::string folder = std::filesystem::relative(file, kHost).begin()->string();
        if (folder == "gpu" || folder == "render") continue;
        for (const std::string& include : includesOf(file)) {
            EXPECT_EQ(include.find("vulkan/"), std::string::npos) << file;
            EXPECT_NE(include, "<volk.h") << file;
        }
    }
}

TEST(IncludeDirections, SystemHeadersStayInPlatform) {
    const std::regex systemHeader(R"(^<(unistd\.h|fcntl\.h|sys/.*|windows\.h|pthread\.h|dlfcn\.h))");
    for (const std::filesystem::path& file : sourcesIn(kHost)) {
        if (file.filename() == "platform.cpp") continue;
        for (const std::string& include : includesOf(file))
            EXPECT_FALSE(std::regex_search(include, systemHeader)) << file << " includes " << include.substr(1);
    }
}

} // namespace
