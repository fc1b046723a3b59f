#include "stress/trial.h"

#include "core/error.h"
#include "core/stopwatch.h"
#include "reference/reference.h"
#include "render/path_renderer.h"
#include "report/paired.h"
#include "stress/film_mean.h"
#include "stress/ray_trial.h"

#include <cmath>
#include <utility>

namespace isolux {
namespace {

ProgressCallback stopping(const StressBench& bench) {
    return [&bench](double) { return bench.interrupted && bench.interrupted() ? Continue::no : Continue::yes; };
}

Film onDevice(const RenderTrial& trial, const Scene& scene, const StressBench& bench) {
    Film film(trial.settings.width, trial.settings.height);
    PathRenderer renderer(bench.device, scene, trial.settings, {});
    renderer.render(film, stopping(bench));
    return film;
}

Film onProcessor(const RenderTrial& trial, Precision precision, const StressBench& bench) {
    ReferenceOptions options;
    options.precision = precision;
    return renderReference(trial.scene, trial.settings, options, stopping(bench));
}

/// The closed form's own uncertainty may lie to either side.
Interval errorOf(const Film& film, const RenderTrial& trial) {
    const double expected = *trial.expected;
    Interval error = normalInterval(meanLuminance(film) / expected - 1.0, standardError(film) / std::abs(expected));
    error.low -= trial.expectedUncertainty;
    error.high += trial.expectedUncertainty;
    return error;
}

std::uint64_t probeFaults(const Film& film, const Probe& probe) {
    std::uint64_t faults = 0;
    for (const PixelStatistics& pixel : film.pixels) {
        const double change = std::abs(luminance(pixel.mean) - probe.value) * static_cast<double>(pixel.sampleCount);
        faults += static_cast<std::uint64_t>(std::llround(change / probe.faultChange));
    }
    return faults;
}

StressFaults faultsOf(const Film& film, const RenderTrial& trial) {
    StressFaults faults;
    for (const PixelStatistics& pixel : film.pixels) faults.tried += pixel.sampleCount;
    faults.nonFinite = film.diagnostics.nonFiniteSamples;
    faults.negative = film.diagnostics.negativeSamples;
    faults.stackOverflows = film.diagnostics.stackOverflows;
    faults.invalidIndices = film.diagnostics.invalidIndices;
    // A sample that is not finite says nothing about the probe, and is counted already.
    if (!trial.probe || faults.nonFinite > 0) return faults;
    (trial.probe->symptom == Symptom::leak ? faults.leaks : faults.selfHits) = probeFaults(film, *trial.probe);
    return faults;
}

std::uint64_t differentPixels(const Film& film, const Film& other, double factor) {
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i)
        if (film.pixels[i].mean != other.pixels[i].mean * factor) ++different;
    return different;
}

/// Two black images do not differ, and the bias of something from nothing is no number.
Interval biasOf(const Film& film, const Film& reference) {
    if (meanLuminance(reference) == 0.0) return {};
    return pairedDifferences(film, reference).luminanceBias;
}

/// What a renderer makes of the trial; nothing to compare with yet.
struct Rendered {
    StressFigures figures;
    std::optional<Film> film;
};

template <typename Render> Rendered tried(const char* renderer, const RenderTrial& trial, const Render& render) {
    Rendered rendered;
    rendered.figures.renderer = renderer;
    const Stopwatch watch;
    try {
        rendered.film = render();
        rendered.figures.mean = meanLuminance(*rendered.film);
        rendered.figures.faults = faultsOf(*rendered.film, trial);
        if (trial.expected) rendered.figures.error = errorOf(*rendered.film, trial);
    } catch (const Error& error) {
        if (error.code() == ExitCode::tryAgain) throw;
        rendered.figures.failure = error.what();
    }
    rendered.figures.seconds = watch.seconds();
    return rendered;
}

std::vector<StressFigures> runTrial(const RenderTrial& trial, const StressBench& bench) {
    Rendered device = tried(kStressDevice, trial, [&] { return onDevice(trial, trial.scene, bench); });
    if (device.film && trial.sameBitsAs)
        device.figures.faults.differentBits =
            differentPixels(*device.film, onDevice(trial, *trial.sameBitsAs, bench), trial.imageFactor);
    std::vector<Rendered> all;
    all.push_back(std::move(device));
    if (trial.renderers != Renderers::deviceAlone)
        all.push_back(
            tried(kStressSingle, trial, [&] { return onProcessor(trial, Precision::singlePrecision, bench); }));
    if (trial.renderers == Renderers::all)
        all.push_back(
            tried(kStressDouble, trial, [&] { return onProcessor(trial, Precision::doublePrecision, bench); }));
    const std::optional<Film>& reference = all.back().film;
    std::vector<StressFigures> figures;
    for (Rendered& rendered : all) {
        const bool isReference = &rendered == &all.back();
        if (trial.renderers == Renderers::all && !isReference && reference && rendered.film)
            rendered.figures.bias = biasOf(*rendered.film, *reference);
        figures.push_back(rendered.figures);
    }
    return figures;
}

} // namespace

Trial trialOf(std::function<RenderTrial()> make) {
    return [make = std::move(make)](const StressBench& bench) {
        if (!bench.exported) return runTrial(make(), bench);
        bench.exported(make());
        return std::vector<StressFigures>{};
    };
}

Trial trialOf(std::function<RayTrial()> make) {
    return [make = std::move(make)](const StressBench& bench) {
        return bench.exported ? std::vector<StressFigures>{} : runRays(make(), bench);
    };
}

Trial trialBy(Trial run) {
    return [run = std::move(run)](const StressBench& bench) {
        return bench.exported ? std::vector<StressFigures>{} : run(bench);
    };
}

} // namespace isolux
