// The fixture of every device test: a device under the validation layers, which must have said nothing at the end.
#pragma once

#include "gpu/device.h"
#include "support/render.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace isolux::test {

class DeviceTest : public ::testing::Test {
protected:
    void SetUp() override {
        RecordProperty("device", device_.description().name);
        RecordProperty("driver", device_.description().driverVersion);
    }
    void TearDown() override {
        for (const std::string& message : device_.validationMessages()) ADD_FAILURE() << message;
    }

    [[nodiscard]] Film render(const Scene& scene, const RenderSettings& settings, const RenderOptions& options = {}) {
        return renderOnDevice(device_, scene, settings, options);
    }

    Device device_{{"", Validation::on}};
};

[[nodiscard]] inline RenderSettings imageSettings(std::uint32_t width, std::uint32_t height, std::uint32_t samples) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.sampleCount = samples;
    return settings;
}

/// The number of pixels whose statistics are not the same to the last bit.
[[nodiscard]] inline std::size_t differingPixels(const Film& a, const Film& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        if (!(a.pixels[i] == b.pixels[i])) ++count;
    return count;
}

} // namespace isolux::test
