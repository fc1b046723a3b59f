#include "film/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace isolux {

void PixelStatistics::add(const Vec3d& radiance) {
    ++sampleCount;
    const Vec3d before = radiance - mean;
    mean += before / static_cast<double>(sampleCount);
    const Vec3d after = radiance - mean;
    squaredDeviation += before * after;
    luminanceSquaredDeviation += luminance(before) * luminance(after);
}

void PixelStatistics::merge(const PixelStatistics& other) {
    hitCount += other.hitCount;
    pathSignature += other.pathSignature;
    if (other.sampleCount == 0) return;
    const double total = static_cast<double>(sampleCount + other.sampleCount);
    const Vec3d delta = other.mean - mean;
    const double cross = static_cast<double>(sampleCount) * (static_cast<double>(other.sampleCount) / total);
    squaredDeviation += other.squaredDeviation + delta * delta * cross;
    luminanceSquaredDeviation += other.luminanceSquaredDeviation + luminance(delta) * luminance(delta) * cross;
    mean += delta * (static_cast<double>(other.sampleCount) / total);
    sampleCount += other.sampleCount;
}

Vec3d PixelStatistics::variance() const {
    return sampleCount < 2 ? Vec3d(0.0) : squaredDeviation / static_cast<double>(sampleCount - 1);
}

double PixelStatistics::luminanceVariance() const {
    return sampleCount < 2 ? 0.0 : luminanceSquaredDeviation / static_cast<double>(sampleCount - 1);
}

void PixelAovs::add(const FirstHit& hit) {
    albedo += hit.albedo;
    normal += hit.normal;
    depth += hit.depth;
    addCoverage(hit.object, 1);
}

void PixelAovs::addCoverage(std::uint32_t object, std::uint64_t samples) {
    const auto place = std::lower_bound(objects.begin(), objects.end(), object,
                                        [](const Coverage& c, std::uint32_t wanted) { return c.object < wanted; });
    if (place != objects.end() && place->object == object)
        place->samples += samples;
    else
        objects.insert(place, {object, samples});
}

void PixelAovs::merge(const PixelAovs& other) {
    albedo += other.albedo;
    normal += other.normal;
    depth += other.depth;
    for (const Coverage& coverage : other.objects) addCoverage(coverage.object, coverage.samples);
}

std::uint64_t PixelAovs::hitCount() const {
    std::uint64_t count = 0;
    for (const Coverage& coverage : objects) count += coverage.samples;
    return count;
}

void Diagnostics::merge(const Diagnostics& other) {
    nonFiniteSamples += other.nonFiniteSamples;
    negativeSamples += other.negativeSamples;
    stackOverflows += other.stackOverflows;
    invalidIndices += other.invalidIndices;
}

void PixelReplicates::add(std::uint32_t sample, const Vec3d& radiance) {
    sum[sample % kCount] += radiance;
    ++sampleCount[sample % kCount];
}

void PixelReplicates::refine(PixelStatistics& pixel) const {
    Vec3d total(0.0);
    std::uint64_t samples = 0;
    std::uint32_t replicates = 0;
    for (std::uint32_t r = 0; r < kCount; ++r) {
        total += sum[r];
        samples += sampleCount[r];
        if (sampleCount[r] > 0) ++replicates;
    }
    if (replicates < 2) return;
    const Vec3d mean = total / static_cast<double>(samples);
    Vec3d scatter(0.0);
    double luminanceScatter = 0.0;
    for (std::uint32_t r = 0; r < kCount; ++r) {
        if (sampleCount[r] == 0) continue;
        const double count = sampleCount[r];
        const Vec3d deviation = sum[r] / count - mean;
        scatter += count * deviation * deviation;
        luminanceScatter += count * luminance(deviation) * luminance(deviation);
    }
    // PixelStatistics divides by samples - 1, as for independent samples.
    const double toSamples = static_cast<double>(pixel.sampleCount - 1) / static_cast<double>(replicates - 1);
    pixel.squaredDeviation = scatter * toSamples;
    pixel.luminanceSquaredDeviation = luminanceScatter * toSamples;
}

void Film::refineVariance() {
    assert(replicates.empty() || replicates.size() == pixels.size());
    for (std::size_t i = 0; i < replicates.size(); ++i) replicates[i].refine(pixels[i]);
}

std::uint64_t Film::minSampleCount() const {
    std::uint64_t least = pixels.empty() ? 0 : pixels.front().sampleCount;
    for (const PixelStatistics& pixel : pixels) least = std::min(least, pixel.sampleCount);
    return least;
}

std::uint64_t Film::maxSampleCount() const {
    std::uint64_t most = 0;
    for (const PixelStatistics& pixel : pixels) most = std::max(most, pixel.sampleCount);
    return most;
}

double estimatedRelativeRmse(const Film& film) {
    Vec3d sum(0.0);
    Vec3d varianceSum(0.0); // of the pixels' means
    for (const PixelStatistics& pixel : film.pixels) {
        if (pixel.sampleCount < 2) return std::numeric_limits<double>::quiet_NaN();
        sum += pixel.mean;
        varianceSum += pixel.variance() / static_cast<double>(pixel.sampleCount);
    }
    const double values = 3.0 * static_cast<double>(film.pixels.size());
    return std::sqrt(glm::dot(varianceSum, Vec3d(1.0)) * values) / glm::dot(sum, Vec3d(1.0));
}

} // namespace isolux
