#include "device/lobe_distribution.h"

#include "reference/fresnel.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace isolux::test {
namespace {

/// Directions named by the microfacet normal that leads there, and by whether it reflects or transmits: the logarithm
/// of its slope over alpha, and its azimuth, both in [0, 1). Narrow lobes fill these coordinates as wide ones do.
class MicrofacetCoordinates {
public:
    static constexpr int kSlopes = 14, kAzimuths = 8, kBins = 2 * kSlopes * kAzimuths;

    MicrofacetCoordinates(const DeviceLobe& lobe, const Vec3d& wo)
        : lobe_(lobe), wo_(wo), alpha_(lobe.alpha() > 0.0 ? lobe.alpha() : 1.0),
          range_(std::log1p(kLargestSlope / alpha_)) {}

    [[nodiscard]] int binOf(const Vec3d& wi) const {
        const Vec3d h = lobe_.microfacetOf(wo_, wi);
        const double s = std::log1p(std::hypot(h.x, h.y) / h.z / alpha_) / range_;
        const double azimuth = 0.5 + std::atan2(h.y, h.x) / (2.0 * kPi);
        const int row = std::min(static_cast<int>(s * kSlopes), kSlopes - 1);
        const int column = std::min(static_cast<int>(azimuth * kAzimuths), kAzimuths - 1);
        return ((wi.z < 0.0 ? kSlopes : 0) + row) * kAzimuths + column;
    }

    /// The direction at a place; zero if there is none.
    [[nodiscard]] Vec3d direction(double s, double azimuth, bool below) const {
        const Vec3d h = microfacet(s, azimuth);
        if (glm::dot(wo_, h) <= 0.0) return Vec3d(0.0);
        if (below && lobe_.isSolid() && dielectricFresnel(glm::dot(wo_, h), lobe_.eta()) == 1.0) return Vec3d(0.0);
        const Vec3d wi = throughMicrofacet(h, below);
        return below == (wi.z < 0.0) ? wi : Vec3d(0.0);
    }

    /// Solid angle over the area of a place, by differences.
    [[nodiscard]] double jacobian(double s, double azimuth, bool below) const {
        constexpr double kStep = 1e-6;
        const auto along = [&](double ds, double da) {
            const Vec3d ahead = throughMicrofacet(microfacet(s + ds, azimuth + da), below);
            return (ahead - throughMicrofacet(microfacet(s - ds, azimuth - da), below)) / (2.0 * kStep);
        };
        return glm::length(glm::cross(along(kStep, 0.0), along(0.0, kStep)));
    }

private:
    [[nodiscard]] Vec3d microfacet(double s, double azimuth) const {
        const double slope = std::expm1(s * range_) * alpha_;
        const double phi = 2.0 * kPi * (azimuth - 0.5);
        return glm::normalize(Vec3d(slope * std::cos(phi), slope * std::sin(phi), 1.0));
    }
    [[nodiscard]] Vec3d throughMicrofacet(const Vec3d& h, bool below) const {
        const Vec3d mirrored = reflectAt(h, wo_);
        if (!below) return mirrored;
        return lobe_.isSolid() ? refractAt(h, wo_, lobe_.eta()) : Vec3d(mirrored.x, mirrored.y, -mirrored.z);
    }

    static constexpr double kLargestSlope = 1e4;
    const DeviceLobe& lobe_;
    Vec3d wo_;
    double alpha_; ///< 1 where the lobe's own is 0: some other lobe is broad
    double range_;
};

/// An estimate of a density's integral over a bin.
struct BinMass {
    double mean = 0.0;
    double variance = 0.0; ///< of the mean

    BinMass& operator+=(const BinMass& other) {
        mean += other.mean;
        variance += other.variance;
        return *this;
    }
};

/// Pearson's statistic; bins that expect few samples are one.
class ChiSquare {
public:
    ChiSquare(const std::vector<double>& counts, const std::vector<BinMass>& masses, double samples) {
        double restCount = 0.0;
        BinMass rest;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (masses[i].mean * samples >= kFewest) {
                add(counts[i], masses[i], samples);
                continue;
            }
            restCount += counts[i];
            rest += masses[i];
        }
        // What expects next to nothing is at least no surprise: a sample of one or two is.
        rest.mean = std::max(rest.mean, kFewest / samples);
        add(std::max(restCount, rest.mean * samples), rest, samples);
    }

    /// A standard normal number (Wilson and Hilferty 1931); the counts' sum is known, which takes a degree of freedom.
    [[nodiscard]] double deviate() const {
        const double k = std::max(bins_ - 1, 1), spread = 2.0 / (9.0 * k);
        return (std::cbrt(sum_ / k) - (1.0 - spread)) / std::sqrt(spread);
    }

private:
    void add(double count, const BinMass& mass, double samples) {
        const double difference = count - samples * mass.mean;
        sum_ += difference * difference / (samples * mass.mean + samples * samples * mass.variance);
        ++bins_;
    }

    static constexpr double kFewest = 20.0; ///< that a bin of its own expects
    double sum_ = 0.0;
    int bins_ = 0;
};

constexpr std::size_t kSamples = 20000;
constexpr int kCells = 6; ///< an edge of the grid over a bin on which densities are integrated

/// A rectangle of microfacet coordinates, of reflection or of transmission.
struct Cell {
    Vec2d corner;
    Vec2d size;
    bool below;

    [[nodiscard]] Cell part(int row, int column, int rows, int columns) const {
        const Vec2d small = size / Vec2d(rows, columns);
        return {corner + Vec2d(row, column) * small, small, below};
    }
};

/// Samples of a view, and densities on a grid over all directions.
class Distribution {
public:
    Distribution(LobeKernel& kernel, std::size_t lobe, const Vec3f& wo, std::uint64_t seed)
        : kernel_(kernel), lobe_(lobe), wo_(wo), coordinates_(kernel.lobe(lobe), Vec3d(wo)), random_(seed) {
        for (std::size_t i = 0; i < kSamples; ++i)
            queries_.push_back(kernel.sampling(lobe, wo_, {word(), word(), 0u, word()}));
        for (int bin = 0; bin < MicrofacetCoordinates::kBins; ++bin) addGrid(bin);
        answers_ = kernel.answer(queries_);
        count();
        integrate();
    }

    /// Of the histogram over all directions, delta lobes and what leads nowhere.
    [[nodiscard]] double shape() const { return ChiSquare(counts_, masses_, kSamples).deviate(); }
    /// Of how many samples lead somewhere, delta lobes apart: the density's integral.
    [[nodiscard]] double whole() const {
        const double share = 1.0 - (counts_[kDelta] + counts_[kNowhere]) / kSamples;
        // At least one sample may have been lost by chance.
        const double variance = (share * (1.0 - share) + 1.0 / kSamples) / kSamples + all_.variance;
        return (share - all_.mean) / std::sqrt(variance);
    }

private:
    static constexpr std::size_t kDelta = MicrofacetCoordinates::kBins, kNowhere = kDelta + 1;

    /// A place on the grid, evaluated by one query.
    struct Place {
        int bin;
        double solidAngle;
    };

    std::uint32_t word() { return static_cast<std::uint32_t>(random_() >> 32); }
    double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

    /// Two points in each cell of a grid: what they differ by is the error.
    void addGrid(int bin) {
        constexpr int kSlopes = MicrofacetCoordinates::kSlopes, kAzimuths = MicrofacetCoordinates::kAzimuths;
        const Cell whole{{double(bin / kAzimuths % kSlopes) / kSlopes, double(bin % kAzimuths) / kAzimuths},
                         {1.0 / kSlopes, 1.0 / kAzimuths},
                         bin >= MicrofacetCoordinates::kBins / 2};
        for (int i = 0; i < kCells * kCells; ++i) {
            const Cell cell = whole.part(i / kCells, i % kCells, kCells, kCells);
            if (isCut(cell))
                addCut(bin, cell);
            else
                for (int point = 0; point < 2; ++point) add(bin, cell, randomIn(cell), 1.0);
        }
    }

    [[nodiscard]] Vec2d randomIn(const Cell& cell) { return cell.corner + Vec2d(unit(), unit()) * cell.size; }
    [[nodiscard]] bool exists(const Vec2d& at, const Cell& cell) const {
        return coordinates_.direction(at.x, at.y, cell.below) != Vec3d(0.0);
    }

    /// Whether there are directions at some of the cell's corners only: densities end there.
    [[nodiscard]] bool isCut(const Cell& cell) const {
        int corners = 0;
        for (const Vec2d& side : {Vec2d(0, 0), Vec2d(0, 1), Vec2d(1, 0), Vec2d(1, 1)})
            if (exists(cell.corner + side * cell.size, cell)) ++corners;
        return corners % 4 != 0;
    }

    /// Two of the points that have directions, for all of those.
    void addCut(int bin, const Cell& cell) {
        constexpr int kRows = 16, kColumns = 4;
        std::vector<Vec2d> found;
        for (int i = 0; i < kRows * kColumns; ++i) {
            const Vec2d at = randomIn(cell.part(i / kColumns, i % kColumns, kRows, kColumns));
            if (exists(at, cell)) found.push_back(at);
        }
        const double share = static_cast<double>(found.size()) / (kRows * kColumns);
        for (int point = 0; point < 2 && !found.empty(); ++point)
            add(bin, cell, found[random_() % found.size()], share);
    }

    void add(int bin, const Cell& cell, const Vec2d& at, double share) {
        const Vec3d wi = coordinates_.direction(at.x, at.y, cell.below);
        const double area = wi == Vec3d(0.0) ? 0.0 : cell.size.x * cell.size.y * share;
        const double solidAngle = area > 0.0 ? area * coordinates_.jacobian(at.x, at.y, cell.below) : 0.0;
        places_.push_back({bin, solidAngle});
        queries_.push_back(kernel_.evaluating(lobe_, wo_, Vec3f(solidAngle > 0.0 ? wi : Vec3d(0.0, 0.0, 1.0))));
    }

    void count() {
        counts_.assign(kNowhere + 1, 0.0);
        for (std::size_t i = 0; i < kSamples; ++i) {
            const Vec3d wi(answers_[i].directionPdf);
            const bool delta = answers_[i].outcome.y != 0;
            const std::size_t bin = delta              ? kDelta
                                    : wi == Vec3d(0.0) ? kNowhere
                                                       : static_cast<std::size_t>(coordinates_.binOf(wi));
            counts_[bin] += 1.0;
        }
    }

    void integrate() {
        masses_.assign(kNowhere + 1, {});
        for (std::size_t i = 0; i < places_.size(); i += 2) {
            const double a = answers_[kSamples + i].directionPdf.w * places_[i].solidAngle;
            const double b = answers_[kSamples + i + 1].directionPdf.w * places_[i + 1].solidAngle;
            const BinMass mass{(a + b) / 2.0, (a - b) * (a - b) / 4.0};
            masses_[static_cast<std::size_t>(places_[i].bin)] += mass;
            all_ += mass;
        }
        const double broad = answers_[0].probabilities.z;
        masses_[kDelta] = {1.0 - broad, 0.0};
        masses_[kNowhere] = {std::max(broad - all_.mean, 0.0), all_.variance};
    }

    const LobeKernel& kernel_;
    std::size_t lobe_;
    Vec3f wo_;
    MicrofacetCoordinates coordinates_;
    std::mt19937_64 random_;
    LobeQueries queries_;
    std::vector<Place> places_;
    LobeAnswers answers_;
    std::vector<double> counts_;
    std::vector<BinMass> masses_;
    BinMass all_;
};

} // namespace

DistributionDeviates compareDistribution(LobeKernel& kernel, std::size_t lobe, const Vec3f& wo, std::uint64_t seed) {
    const Distribution found(kernel, lobe, wo, seed);
    return {found.shape(), found.whole()};
}

} // namespace isolux::test
