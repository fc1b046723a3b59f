#include "app/seed_renderer.h"

#include "reference/reference.h"
#include "render/path_renderer.h"

namespace isolux {
namespace {

class DeviceSeedRenderer : public SeedRenderer {
public:
    DeviceSeedRenderer(const Device& device, const Scene& scene, const RenderSettings& settings, double dispatchSeconds)
        : settings_(settings), hasTimestamps_(device.limits().secondsPerTimestamp > 0.0),
          renderer_(device, scene, settings, options(dispatchSeconds)) {}

    [[nodiscard]] Film render(const SeedRequest& request, const PassCallback& pass,
                              const ProgressCallback& progress) override {
        Film film(settings_.width, settings_.height);
        pass_ = pass;
        renderer_.setSeed(request.seed);
        renderer_.setSamples({0, request.samples});
        renderer_.setStopping(request.stopping);
        renderer_.render(film, progress);
        return film;
    }

    [[nodiscard]] std::optional<double> deviceSeconds() const override {
        if (!hasTimestamps_) return std::nullopt;
        return renderer_.statistics().deviceSeconds;
    }

    [[nodiscard]] double setupSeconds() const override {
        const RenderStatistics& statistics = renderer_.statistics();
        return statistics.packSeconds + statistics.uploadSeconds + statistics.compileSeconds;
    }

private:
    [[nodiscard]] RenderOptions options(double dispatchSeconds) {
        RenderOptions options;
        options.dispatchSeconds = dispatchSeconds;
        options.firstPasses = FirstPasses::growing;
        options.pass = [this](const Film& film) { return pass_ ? pass_(film) : Continue::yes; };
        return options;
    }

    RenderSettings settings_;
    bool hasTimestamps_;
    PassCallback pass_;
    PathRenderer renderer_;
};

class ProcessorSeedRenderer : public SeedRenderer {
public:
    ProcessorSeedRenderer(const Scene& scene, const RenderSettings& settings) : scene_(scene), settings_(settings) {}

    [[nodiscard]] Film render(const SeedRequest& request, const PassCallback& pass,
                              const ProgressCallback& progress) override {
        RenderSettings settings = settings_;
        settings.seed = request.seed;
        settings.firstSample = 0;
        // What samplers prepare for stays, whatever the number of samples is.
        settings.plannedSamples = settings_.plannedSamples == 0 ? settings_.sampleCount : settings_.plannedSamples;
        settings.sampleCount = request.samples;
        ReferenceOptions options;
        options.stopping = request.stopping;
        options.pass = pass;
        return renderReference(scene_, settings, options, progress);
    }

    [[nodiscard]] std::optional<double> deviceSeconds() const override { return std::nullopt; }
    [[nodiscard]] double setupSeconds() const override { return 0.0; }

private:
    const Scene& scene_;
    RenderSettings settings_;
};

} // namespace

std::unique_ptr<SeedRenderer> makeSeedRenderer(const Device* device, const Scene& scene, const RenderSettings& settings,
                                               double dispatchSeconds) {
    if (device == nullptr) return std::make_unique<ProcessorSeedRenderer>(scene, settings);
    return std::make_unique<DeviceSeedRenderer>(*device, scene, settings, dispatchSeconds);
}

} // namespace isolux
