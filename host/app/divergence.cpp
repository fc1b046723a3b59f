#include "app/divergence.h"

#include "core/platform.h"
#include "reference/reference.h"

namespace isolux {
namespace {

Continue untilInterrupt(double) { return interruptRequested() ? Continue::no : Continue::yes; }

class PixelProbe {
public:
    PixelProbe(PathRenderer& renderer, const Scene& scene, const RenderSettings& settings, const PairedPixel& pixel)
        : renderer_(renderer), scene_(scene), settings_(settings), pixel_(pixel) {}

    [[nodiscard]] bool differs(std::uint32_t sample, std::uint32_t maxDepth) {
        renderer_.setSamples({sample, 1});
        renderer_.setMaxDepth(maxDepth);
        Film film(settings_.width, settings_.height);
        renderer_.render(film, {pixel_.x, pixel_.y, 1, 1}, untilInterrupt);
        RenderSettings settings = settings_;
        settings.plannedSamples = settings.firstSample + settings.sampleCount; // of the whole render
        settings.firstSample = sample;
        settings.sampleCount = 1;
        settings.maxDepth = maxDepth;
        const Film reference = renderReferenceRegion(scene_, settings, {Precision::doublePrecision, PathSignatures::on},
                                                     {pixel_.x, pixel_.y, 1, 1}, untilInterrupt);
        return film.at(pixel_.x, pixel_.y).pathSignature != reference.at(0, 0).pathSignature;
    }

private:
    PathRenderer& renderer_;
    const Scene& scene_;
    RenderSettings settings_;
    PairedPixel pixel_;
};

/// The least depth at which a sample's paths differ; paths are short, so one depth after the other.
std::uint32_t firstBounce(PixelProbe& probe, std::uint32_t sample, std::uint32_t maxDepth) {
    for (std::uint32_t depth = 0; depth < maxDepth && !interruptRequested(); ++depth)
        if (probe.differs(sample, depth)) return depth;
    return maxDepth;
}

} // namespace

std::optional<Divergence> findDivergence(PathRenderer& renderer, const Scene& scene, const RenderSettings& settings,
                                         const PairedPixel& pixel) {
    PixelProbe probe(renderer, scene, settings, pixel);
    for (std::uint32_t i = 0; i < settings.sampleCount && !interruptRequested(); ++i) {
        const std::uint32_t sample = settings.firstSample + i;
        if (probe.differs(sample, settings.maxDepth))
            return Divergence{sample, firstBounce(probe, sample, settings.maxDepth)};
    }
    return std::nullopt;
}

} // namespace isolux
