// Renders the same image with one seed after another, by either backend; what takes time at the beginning is done once.
#pragma once

#include "app/backends.h"
#include "gpu/device.h"

#include <functional>
#include <memory>
#include <optional>

namespace isolux {

struct SeedRequest {
    std::uint64_t seed = 0;
    std::uint32_t samples = 0; ///< a pixel; the most, if something else may stop it earlier
    StoppingRule stopping;
};

/// Told after each pass of 1, 1, 2, 4, 8, 16, 16, ... samples a pixel what is done; `no` ends the render.
using PassCallback = std::function<Continue(const Film&)>;

class SeedRenderer {
public:
    SeedRenderer() = default;
    virtual ~SeedRenderer() = default;
    SeedRenderer(const SeedRenderer&) = delete;
    SeedRenderer& operator=(const SeedRenderer&) = delete;

    /// Interrupted by `progress`, the film holds what was finished.
    [[nodiscard]] virtual Film render(const SeedRequest& request, const PassCallback& pass,
                                      const ProgressCallback& progress) = 0;
    /// Of all renders so far, measured on the device; nothing where that is not known.
    [[nodiscard]] virtual std::optional<double> deviceSeconds() const = 0;
    /// Of what was done once: building, uploading, compiling.
    [[nodiscard]] virtual double setupSeconds() const = 0;
};

/// On the device or, without one, on the processor in double precision.
[[nodiscard]] std::unique_ptr<SeedRenderer> makeSeedRenderer(const Device* device, const Scene& scene,
                                                             const RenderSettings& settings, double dispatchSeconds);

} // namespace isolux
