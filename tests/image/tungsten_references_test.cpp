// Scenes of Bitterli's collection against their images by Tungsten, block by block and on the mean, where materials and
// light transport coincide. README.md says how the rest differs and why.
//
// The images bring no error estimate. Their noise, from second differences of pixels two apart (their tent filter
// reaches one pixel), is 0.03 % of a block's mean in the Cornell box and 0.01 % in veach-mis, a tenth of the noise here
// or less: they are taken as exact.
#include "core/log.h"
#include "film/image.h"
#include "load/gltf.h"
#include "report/blocks.h"
#include "support/render.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace isolux::test {
namespace {

/// R, G and B averaged over squares of `edge` pixels.
Image averagedDown(const Image& large, std::uint32_t edge) {
    Image small{large.width / edge, large.height / edge, {"R", "G", "B"}, {}, {}};
    small.values.assign(small.pixelCount() * 3, 0.0F);
    const std::array<std::size_t, 3> channels = large.rgbChannels().value();
    const float share = 1.0F / static_cast<float>(edge * edge);
    for (std::size_t pixel = 0; pixel < large.pixelCount(); ++pixel) {
        const std::size_t to = pixel / large.width / edge * small.width + pixel % large.width / edge;
        for (std::size_t c = 0; c < 3; ++c) small.values[to * 3 + c] += large.value(pixel, channels[c]) * share;
    }
    return small;
}

double luminanceAt(const Image& image, std::size_t pixel) {
    return luminance(Vec3d(image.value(pixel, 0), image.value(pixel, 1), image.value(pixel, 2)));
}

/// Whether a pixel or one beside it is brighter than any surface that only reflects.
bool isNearLamp(const Image& image, std::uint32_t x, std::uint32_t y) {
    constexpr double kBrightest = 1.0;
    for (std::uint32_t row = std::max(y, 1U) - 1; row < std::min(y + 2, image.height); ++row)
        for (std::uint32_t column = std::max(x, 1U) - 1; column < std::min(x + 2, image.width); ++column)
            if (luminanceAt(image, std::size_t{row} * image.width + column) > kBrightest) return true;
    return false;
}

class TungstenReferences : public ::testing::Test {
protected:
    void SetUp() override {
        setVerbosity(Verbosity::quiet);
        shared_ = sharedFolder();
        if (!shared_ && !inContinuousIntegration()) GTEST_SKIP() << "../shared is not here";
        ASSERT_TRUE(shared_) << "../shared is missing";
    }

    void load(const std::string& name, std::uint32_t edge) {
        const std::filesystem::path folder = *shared_ / "scenes" / "ref" / name;
        truth_ = averagedDown(readImage(folder / "TungstenRender.exr"), edge);
        scene_ = loadScene(folder / (name + ".glb"));
        settings_.width = truth_.width;
        settings_.height = truth_.height;
        settings_.sampleCount = longTests() ? 512 : 64;
        settings_.seed = 22;
    }

    /// Whether the device's image agrees, in the pixels that the mask selects.
    void expectAgreement(std::span<const std::uint8_t> mask = {}) const {
        const Image image = imageFromFilm(renderOnDevice(Device({}), scene_, settings_), {});
        const auto comparison = compareBlocks(image, truth_, mask);
        ASSERT_TRUE(comparison);
        const BlockDifference& worst = comparison->blocks.at(comparison->worst);
        const double percent = 100.0 / meanOf(truth_, mask);
        fmt::print("mean {:+.3f} % (beyond {:.3f} % it fails), z {:.2f}; worst of {} blocks ({}, {}), z {:.2f}\n",
                   percent * comparison->whole.difference,
                   percent * comparison->whole.standardError * comparison->limit, comparison->whole.z,
                   comparison->blocks.size(), worst.x, worst.y, worst.z);
        EXPECT_TRUE(comparison->agree());
    }

    Scene scene_;
    Image truth_;
    RenderSettings settings_;

private:
    /// Of luminance, over the pixels that the mask selects.
    static double meanOf(const Image& image, std::span<const std::uint8_t> mask) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
            if (!mask.empty() && mask[pixel] == 0) continue;
            sum += luminanceAt(image, pixel);
            count += 1.0;
        }
        return sum / count;
    }

    std::optional<std::filesystem::path> shared_;
};

TEST_F(TungstenReferences, CornellBoxAgreesBlockByBlock) {
    load("cornell-box", 8);
    expectAgreement();
}

/// The image shows light of one bounce. Above the plates and below them are surfaces that are Lambertian, and the
/// lamps, which are left out with the pixels around them: they are a hundred to ten thousand times as bright.
TEST_F(TungstenReferences, VeachMisAgreesWhereNothingIsMetal) {
    load("veach-mis", 5);
    settings_.maxDepth = 1;
    std::vector<std::uint8_t> mask(truth_.pixelCount(), 0);
    for (std::uint32_t y = 0; y < truth_.height; ++y)
        for (std::uint32_t x = 0; x < truth_.width; ++x)
            mask[y * truth_.width + x] = (y < 48 || y >= 128) && !isNearLamp(truth_, x, y) ? 1 : 0;
    expectAgreement(mask);
}

} // namespace
} // namespace isolux::test
