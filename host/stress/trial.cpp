#include "stress/trial.h"

#include "core/error.h"
#include "core/stopwatch.h"
#include "reference/reference.h"
#include "render/path_renderer.h"
#include "report/paired.h"
#include "stress/film_mean.h"
#include "stress/ray_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace isolux {
namespace {

bool stopped(const StressBench& bench) { return bench.interrupted && bench.interrupted(); }

ProgressCallback stopping(const StressBench& bench) {
    return [&bench](double) { return stopped(bench) ? Continue::no : Continue::yes; };
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

/// By squares, so that faults that brighten do not make up for those that darken. A pixel has no more than samples.
std::uint64_t probeFaults(const Film& film, const Probe& probe) {
    std::uint64_t faults = 0;
    for (const PixelStatistics& pixel : film.pixels) {
        const double shift = luminance(pixel.mean) - probe.value;
        const auto count = static_cast<double>(pixel.sampleCount);
        const double squares = pixel.luminanceSquaredDeviation + count * shift * shift;
        const double changed = squares / (probe.faultChange * probe.faultChange);
        faults += static_cast<std::uint64_t>(std::llround(std::min(changed, count)));
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

/// Two black images do not differ, and something is infinitely more than nothing.
Interval biasOf(const Film& film, const Film& reference) {
    if (meanLuminance(reference) != 0.0) return pairedDifferences(film, reference).luminanceBias;
    const double bias = meanLuminance(film) == 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    return {bias, bias, bias};
}

/// What a renderer makes of the trial; nothing to compare with yet.
struct Rendered {
    StressFigures figures;
    std::optional<Film> film;
};

/// `render` may count what only it knows of.
template <typename Render> Rendered tried(const char* renderer, const RenderTrial& trial, const Render& render) {
    Rendered rendered;
    rendered.figures.renderer = renderer;
    const Stopwatch watch;
    try {
        std::uint64_t differentBits = 0;
        rendered.film = render(differentBits);
        rendered.figures.mean = meanLuminance(*rendered.film);
        rendered.figures.faults = faultsOf(*rendered.film, trial);
        rendered.figures.faults.differentBits = differentBits;
        if (trial.expected) rendered.figures.error = errorOf(*rendered.film, trial);
    } catch (const Error& error) {
        if (error.code() == ExitCode::tryAgain) throw;
        rendered.figures.failure = error.what();
    }
    rendered.figures.seconds = watch.seconds();
    return rendered;
}

Rendered triedOnDevice(const RenderTrial& trial, const StressBench& bench) {
    return tried(kStressDevice, trial, [&](std::uint64_t& differentBits) {
        Film film = onDevice(trial, trial.scene, bench);
        if (trial.sameBitsAs && !stopped(bench))
            differentBits = differentPixels(film, onDevice(trial, *trial.sameBitsAs, bench), trial.imageFactor);
        return film;
    });
}

Rendered triedOnProcessor(const char* renderer, Precision precision, const RenderTrial& trial,
                          const StressBench& bench) {
    return tried(renderer, trial, [&](std::uint64_t&) { return onProcessor(trial, precision, bench); });
}

std::vector<Rendered> renderedByAll(const RenderTrial& trial, const StressBench& bench) {
    std::vector<Rendered> all;
    all.push_back(triedOnDevice(trial, bench));
    if (trial.renderers != Renderers::deviceAlone && !stopped(bench))
        all.push_back(triedOnProcessor(kStressSingle, Precision::singlePrecision, trial, bench));
    if (trial.renderers == Renderers::all && !stopped(bench))
        all.push_back(triedOnProcessor(kStressDouble, Precision::doublePrecision, trial, bench));
    return all;
}

/// Nothing if it was interrupted: films that were cut short hold different samples, or none.
std::vector<StressFigures> runTrial(const RenderTrial& trial, const StressBench& bench) {
    std::vector<Rendered> all = renderedByAll(trial, bench);
    std::vector<StressFigures> figures;
    if (stopped(bench)) return figures;
    const std::optional<Film>& reference = all.back().film;
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
