// What the tests of films and image files share: a folder of their own, small films and images, a disk that is full.
#pragma once

#include "core/error.h"
#include "core/platform.h"
#include "film/image.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <sys/resource.h>

namespace isolux::film_test {

namespace fs = std::filesystem;

/// A folder of its own for each test, gone when the test is.
class ImageFile : public testing::Test {
protected:
    ImageFile() : folder_(fs::temp_directory_path() / ("isolux_film_test." + std::to_string(processId()))) {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~ImageFile() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::size_t fileCount() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

private:
    fs::path folder_;
};

inline Image makeImage(std::uint32_t width, std::uint32_t height, std::vector<std::string> channels) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = std::move(channels);
    image.values.resize(image.pixelCount() * image.channels.size());
    return image;
}

/// An image of one pixel with the colour `r`, `g`, `b`.
inline Image onePixel(float r, float g, float b) {
    Image image = makeImage(1, 1, {"R", "G", "B"});
    image.values = {r, g, b};
    return image;
}

inline Film makeFilm(std::uint32_t width, std::uint32_t height, int samples) {
    Film film(width, height);
    std::mt19937 engine(7);
    std::exponential_distribution<double> radiance(2.0);
    for (PixelStatistics& pixel : film.pixels) {
        for (int s = 0; s < samples; ++s) {
            pixel.add({radiance(engine), radiance(engine), radiance(engine)});
            pixel.hitCount += s % 2 == 0;
        }
    }
    return film;
}

inline std::string readBytes(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Runs `action`, which must throw an Error with this code, and returns its message.
template <typename Action> std::string errorOf(ExitCode code, const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "no Error was thrown";
    return "";
}

inline void expectMentions(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
}

/// Files of this process may not grow beyond some size: the nearest to a full disk that needs no disk.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit limit = before_;
        limit.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

} // namespace isolux::film_test
