#include "report/convergence_curves.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <random>

namespace isolux {
namespace {

[[noreturn]] void refuse(const std::string& variant, const ErrorSample& sample, std::string_view message) {
    throwBadInput(fmt::format("variant \"{}\"", variant),
                  fmt::format("seed {}, checkpoint {}: {}", sample.seed, sample.checkpoint, message));
}

/// The samples of a variant by seed and checkpoint, each once.
using Ordered = std::map<std::uint64_t, std::map<std::uint32_t, const ErrorSample*>>;

SeedCurves curvesOfVariant(const std::string& name, const Ordered& ordered) {
    SeedCurves curves;
    curves.name = name;
    const std::size_t count = ordered.begin()->second.size();
    curves.checkpoints.resize(count);
    for (const auto& [seed, checkpoints] : ordered) {
        curves.seeds.push_back(seed);
        std::size_t expected = 0;
        for (const auto& [checkpoint, sample] : checkpoints) {
            if (checkpoint != expected || expected == count)
                refuse(name, *sample,
                       fmt::format("every seed must have the same checkpoints, from 0 to {}", count - 1));
            curves.checkpoints[expected++].push_back(sample);
        }
        if (expected != count)
            refuse(name, *checkpoints.begin()->second,
                   fmt::format("the seed has {} of {} checkpoints", expected, count));
    }
    return curves;
}

MeanCurve meanCurve(const std::vector<const SeedTable*>& tables, std::span<const std::size_t> seeds) {
    MeanCurve curve;
    std::vector<double> drawn(seeds.size());
    const auto draw = [&](const std::vector<double>& bySeed) -> const std::vector<double>& {
        std::transform(seeds.begin(), seeds.end(), drawn.begin(), [&](std::size_t seed) { return bySeed[seed]; });
        return drawn;
    };
    for (const auto& bySeed : *tables[0]) curve.samples.push_back(mean(draw(bySeed)));
    for (const auto& bySeed : *tables[1]) curve.seconds.push_back(median(draw(bySeed)));
    for (const auto& bySeed : *tables[2]) curve.mse.push_back(mean(draw(bySeed)));
    return curve;
}

/// The same numbers for the same seeds, others for others (FNV-1a; Fowler, Noll and Vo 1991).
std::uint64_t hashOf(const std::vector<std::uint64_t>& seeds) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::uint64_t seed : seeds) {
        for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (seed >> (8 * byte) & 0xffu)) * 0x100000001b3u;
    }
    return hash;
}

/// Uniform below `count` up to count / 2^32: the standard's distributions differ between libraries.
std::size_t drawIndex(std::mt19937_64& random, std::size_t count) {
    return static_cast<std::size_t>((random() >> 32) * count >> 32);
}

} // namespace

double median(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

SeedTable SeedCurves::table(double ErrorSample::*figure) const {
    SeedTable table;
    for (const auto& samples : checkpoints) {
        std::vector<double>& row = table.emplace_back();
        for (const ErrorSample* sample : samples) row.push_back(sample->*figure);
    }
    return table;
}

std::vector<SeedCurves> curvesOf(const std::vector<ErrorSample>& samples) {
    std::vector<std::string> names;
    std::map<std::string, Ordered> variants;
    for (const ErrorSample& sample : samples) {
        if (!variants.contains(sample.variant)) names.push_back(sample.variant);
        if (!(sample.wallSeconds > 0.0)) refuse(sample.variant, sample, "wall seconds must be above 0");
        if (!(sample.samplesPerPixel > 0.0)) refuse(sample.variant, sample, "samples must be above 0");
        if (!variants[sample.variant][sample.seed].emplace(sample.checkpoint, &sample).second)
            refuse(sample.variant, sample, "given twice");
    }
    std::vector<SeedCurves> curves;
    curves.reserve(names.size());
    for (const std::string& name : names) curves.push_back(curvesOfVariant(name, variants[name]));
    return curves;
}

ResampledCurves resampleCurves(const SeedCurves& curves, std::uint32_t resamples) {
    const SeedTable samples = curves.table(&ErrorSample::samplesPerPixel);
    const SeedTable seconds = curves.table(&ErrorSample::wallSeconds);
    const SeedTable mse = curves.table(&ErrorSample::mse);
    const std::vector<const SeedTable*> tables{&samples, &seconds, &mse};
    std::vector<std::size_t> drawn(curves.seeds.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) drawn[i] = i;
    ResampledCurves result{meanCurve(tables, drawn), {}, drawn.size()};
    if (drawn.size() < 2) return result;
    std::mt19937_64 random(hashOf(curves.seeds));
    for (std::uint32_t resample = 0; resample < resamples; ++resample) {
        for (std::size_t& index : drawn) index = drawIndex(random, drawn.size());
        result.resamples.push_back(meanCurve(tables, drawn));
    }
    return result;
}

} // namespace isolux
