#include "app/divergence.h"

#include "core/platform.h"
#include "reference/reference.h"

namespace isolux {
namespace {

Continue untilInterrupt(double) { return interruptRequested() ? Continue::no : Continue::yes; }

/// Renders the pixel's samples from one to the last. The end of the range stays, since some samplers depend on it.
class PixelProbe {
public:
    PixelProbe(PathRenderer& renderer, const Scene& scene, const RenderSettings& settings, const PairedPixel& pixel)
        : renderer_(renderer), scene_(scene), settings_(settings), pixel_(pixel) {}

    [[nodiscard]] bool differs(std::uint32_t firstSample, std::uint32_t maxDepth) {
        RenderSettings settings = settings_;
        settings.firstSample = firstSample;
        settings.sampleCount = settings_.firstSample + settings_.sampleCount - firstSample;
        settings.maxDepth = maxDepth;
        renderer_.setSamples({firstSample, settings.sampleCount});
        renderer_.setMaxDepth(maxDepth);
        Film film(settings.width, settings.height);
        renderer_.render(film, {pixel_.x, pixel_.y, 1, 1}, untilInterrupt);
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

/// A sample that differs and after which the sum of all does not, by halving; that of the whole range must differ.
std::uint32_t differingSample(PixelProbe& probe, const RenderSettings& settings) {
    std::uint32_t low = settings.firstSample;
    for (std::uint32_t high = settings.firstSample + settings.sampleCount; high - low > 1 && !interruptRequested();) {
        const std::uint32_t middle = low + (high - low) / 2;
        (probe.differs(middle, settings.maxDepth) ? low : high) = middle;
    }
    return low;
}

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
    if (!probe.differs(settings.firstSample, settings.maxDepth)) return std::nullopt;
    const std::uint32_t sample = differingSample(probe, settings);
    return Divergence{sample, firstBounce(probe, sample, settings.maxDepth)};
}

} // namespace isolux
