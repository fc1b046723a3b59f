// Pictures that took equal time, and their differences from the reference.
#include "app/converge_output.h"
#include "core/platform.h"
#include "core/stopwatch.h"
#include "report/comparison.h"
#include "report/heatmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace isolux {
namespace {

constexpr const char* kReferenceName = "reference";
constexpr const char* kMapSuffix = "-flip";

double medianSeconds(const MeasuredVariant& measured) {
    std::vector<double> seconds;
    for (const SeedSamples& seed : measured.seeds) seconds.push_back(seed.end.wallSeconds);
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    return *middle;
}

double equalSeconds(const std::vector<MeasuredVariant>& variants) {
    double least = std::numeric_limits<double>::infinity();
    for (const MeasuredVariant& measured : variants)
        if (!measured.seeds.empty()) least = std::min(least, medianSeconds(measured));
    return least;
}

std::string safeName(const std::string& name) {
    std::string safe = name;
    for (char& c : safe) {
        const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
        if (!kept) c = '_';
    }
    return safe.front() == '.' ? "_" + safe : safe;
}

/// Renders and writes one variant's; nothing if it was interrupted.
std::optional<EqualTimeImage> writeVariant(const std::filesystem::path& folder, const std::string& fileName,
                                           const MeasuredVariant& measured, SeedRequest request,
                                           const ErrorMeter& meter, const ProgressCallback& progress) {
    request.samples = measured.variant.settings.sampleCount;
    const std::optional<double> seconds = request.stopping.seconds;
    request.stopping = measured.variant.stopping;
    request.stopping.seconds = seconds;
    const Stopwatch watch;
    const Film film = measured.renderer->render(request, {}, progress);
    EqualTimeImage written{measured.variant.name, fileName + ".png", fileName + kMapSuffix + ".png"};
    written.seconds = watch.seconds();
    if (interruptRequested()) return std::nullopt;
    const Image image = imageFromFilm(film, {});
    const ComparisonReport comparison = compareImages(image, meter.reference(), {}, FlipOptions{});
    writeImage(folder / written.image, image);
    writeImage(folder / written.flip, makeHeatmap(HeatmapQuantity::flip, image, meter.reference(), comparison).image);
    written.samplesPerPixel = samplesPerPixel(film);
    written.relativeRmse = meter.measure(film, MeasureFlip::no).relativeRmse;
    written.flipMean = comparison.flip->mean;
    return written;
}

} // namespace

std::vector<std::string> fileNames(const std::vector<std::string>& variants) {
    std::set<std::string> taken{kReferenceName};
    std::vector<std::string> names;
    for (const std::string& variant : variants) {
        const std::string safe = safeName(variant);
        std::string name = safe;
        for (int i = 2; taken.contains(name) || taken.contains(name + kMapSuffix); ++i)
            name = fmt::format("{}-{}", safe, i);
        taken.insert({name, name + kMapSuffix});
        names.push_back(name);
    }
    return names;
}

EqualTimeImages writeImages(const std::filesystem::path& folder, const std::vector<MeasuredVariant>& variants,
                            const ConvergeLimits& limits, const ErrorMeter& meter, ProgressBar& bar) {
    EqualTimeImages images;
    images.reference = std::string(kReferenceName) + ".png";
    images.seconds = equalSeconds(variants);
    writeImage(folder / images.reference, meter.reference());
    std::vector<std::string> names;
    names.reserve(variants.size());
    for (const MeasuredVariant& measured : variants) names.push_back(measured.variant.name);
    const std::vector<std::string> files = fileNames(names);
    const ProgressCallback whole = bar.callback();
    for (std::size_t i = 0; i < variants.size() && !interruptRequested(); ++i) {
        const auto progress = [&](double part) {
            return whole((static_cast<double>(i) + part) / static_cast<double>(variants.size()));
        };
        SeedRequest request{limits.firstSeed, 0, {}};
        request.stopping.seconds = images.seconds;
        if (auto written = writeVariant(folder, files[i], variants[i], request, meter, progress))
            images.variants.push_back(std::move(*written));
    }
    return images;
}

} // namespace isolux
