// Lobes and whole surfaces: what is sampled has the density that is claimed, no energy appears, and directions change
// places.
#include "unit/reference_lobes.h"

#include "report/statistics.h"

namespace isolux {
namespace {

using namespace test;

const std::vector<double> kAlphas = {1e-3, 0.03, 0.3, 1.0};
const std::vector<double> kCosines = {1.0, 0.6, 0.1, 1e-3};

/// Directions named by the microfacet normal that leads there: the logarithm of its slope over alpha, its azimuth, and
/// whether it reflects or transmits. Narrow lobes fill these coordinates as wide ones do.
class MicrofacetCoordinates {
public:
    static constexpr int kSlopes = 14, kAzimuths = 8, kBins = 2 * kSlopes * kAzimuths;

    MicrofacetCoordinates(const LobeCase& surface, const Vec3d& wo)
        : wo_(wo), alpha_(surface.point.alpha), solid_(surface.point.isSolid()),
          eta_(surface.side == Side::front ? surface.point.ior : 1.0 / surface.point.ior),
          range_(std::log1p(kLargestSlope / alpha_)) {}

    [[nodiscard]] int binOf(const Vec3d& wi) const {
        const bool below = wi.z < 0;
        const Vec3d sum = !below ? wo_ + wi : solid_ ? wo_ + eta_ * wi : wo_ + Vec3d(wi.x, wi.y, -wi.z);
        const Vec3d h = sum.z < 0 ? -sum : sum;
        const double s = std::log1p(std::hypot(h.x, h.y) / h.z / alpha_) / range_;
        const double azimuth = 0.5 + std::atan2(h.y, h.x) / (2 * kPi);
        const int row = std::min(static_cast<int>(s * kSlopes), kSlopes - 1);
        const int column = std::min(static_cast<int>(azimuth * kAzimuths), kAzimuths - 1);
        return ((below ? kSlopes : 0) + row) * kAzimuths + column;
    }

    /// The direction at a place in [0, 1)^2 of a side; zero if there is none.
    [[nodiscard]] Vec3d direction(double s, double azimuth, bool below) const {
        const Vec3d h = microfacet(s, azimuth);
        if (glm::dot(wo_, h) <= 0) return Vec3d(0.0);
        if (below && solid_ && dielectricFresnel(glm::dot(wo_, h), eta_) == 1.0) return Vec3d(0.0);
        const Vec3d wi = throughMicrofacet(h, below);
        return below == (wi.z < 0) ? wi : Vec3d(0.0);
    }

    /// Solid angle over the area of the place, by differences.
    [[nodiscard]] double jacobian(double s, double azimuth, bool below) const {
        constexpr double kStep = 1e-6;
        const auto along = [&](double ds, double da) {
            const Vec3d ahead = throughMicrofacet(microfacet(s + ds, azimuth + da), below);
            return (ahead - throughMicrofacet(microfacet(s - ds, azimuth - da), below)) / (2 * kStep);
        };
        return glm::length(glm::cross(along(kStep, 0), along(0, kStep)));
    }

private:
    [[nodiscard]] Vec3d microfacet(double s, double azimuth) const {
        const double slope = std::expm1(s * range_) * alpha_;
        const double phi = 2 * kPi * (azimuth - 0.5);
        return glm::normalize(Vec3d(slope * std::cos(phi), slope * std::sin(phi), 1.0));
    }
    [[nodiscard]] Vec3d throughMicrofacet(const Vec3d& h, bool below) const {
        const Vec3d mirrored = reflectAt(h, wo_);
        if (!below) return mirrored;
        return solid_ ? refractAt(h, wo_, eta_) : Vec3d(mirrored.x, mirrored.y, -mirrored.z);
    }

    static constexpr double kLargestSlope = 1e4;
    Vec3d wo_;
    double alpha_;
    bool solid_;
    double eta_;
    double range_;
};

/// An estimate of a density's integral over one bin.
struct BinMass {
    double mean = 0.0;
    double variance = 0.0; ///< of the mean
};

/// Two points in each cell of a grid over the bin: what they differ by is the error.
BinMass massOfBin(const Bsdf<double>& bsdf, const MicrofacetCoordinates& coordinates, int bin, Random& random) {
    constexpr int kGrid = 10;
    constexpr double kCellArea =
        1.0 / (kGrid * kGrid * MicrofacetCoordinates::kSlopes * MicrofacetCoordinates::kAzimuths);
    const bool below = bin >= MicrofacetCoordinates::kBins / 2;
    const int row = bin / MicrofacetCoordinates::kAzimuths % MicrofacetCoordinates::kSlopes;
    const int column = bin % MicrofacetCoordinates::kAzimuths;
    const auto densityIn = [&](int cellRow, int cellColumn) {
        const double s = (row + (cellRow + random.unit()) / kGrid) / MicrofacetCoordinates::kSlopes;
        const double azimuth = (column + (cellColumn + random.unit()) / kGrid) / MicrofacetCoordinates::kAzimuths;
        const Vec3d wi = coordinates.direction(s, azimuth, below);
        return wi == Vec3d(0.0) ? 0.0 : bsdf.evaluate(wi).pdf * coordinates.jacobian(s, azimuth, below) * kCellArea;
    };
    BinMass mass;
    for (int cell = 0; cell < kGrid * kGrid; ++cell) {
        const int cellRow = cell / kGrid, cellColumn = cell % kGrid;
        const double a = densityIn(cellRow, cellColumn), b = densityIn(cellRow, cellColumn);
        mass.mean += (a + b) / 2.0;
        mass.variance += (a - b) * (a - b) / 4.0;
    }
    return mass;
}

/// The sum of squares of (count - expected) over its standard deviation, and of how many bins: those that expect
/// enough, the others together as one. The last bin is of samples that lead nowhere.
struct ChiSquare {
    double sum = 0.0;
    int bins = 0;

    ChiSquare(const std::vector<double>& counts, const std::vector<BinMass>& masses, double samples) {
        double restCount = 0.0, restMass = 0.0, restVariance = 0.0;
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (masses[i].mean * samples >= 20.0) {
                add(counts[i], masses[i].mean, masses[i].variance, samples);
                continue;
            }
            restCount += counts[i];
            restMass += masses[i].mean;
            restVariance += masses[i].variance;
        }
        if (restMass * samples >= 20.0)
            add(restCount, restMass, restVariance, samples);
        else
            EXPECT_LE(restCount, 60.0) << "samples where the density has next to nothing: " << restMass << " last "
                                       << counts.back() << " " << masses.back().mean;
    }
    /// Wilson and Hilferty 1931: a standard normal number.
    [[nodiscard]] double deviate() const {
        const double k = bins, spread = 2.0 / (9.0 * k);
        return (std::cbrt(sum / k) - (1.0 - spread)) / std::sqrt(spread);
    }

private:
    void add(double count, double mass, double variance, double samples) {
        const double difference = count - samples * mass;
        sum += difference * difference / (samples * mass + samples * samples * variance);
        ++bins;
    }
};

constexpr int kSamples = 40000;
/// Standard normal deviates: one false alarm in 1e6 comparisons.
constexpr double kLimit = 4.9;

struct Comparison {
    double shape = 0.0; ///< deviate of the chi-square over all bins
    double whole = 0.0; ///< deviate of how many samples lead somewhere: the density's integral
};

Comparison compare(const LobeCase& surface, double cosine, Random& random) {
    const Vec3d wo = directionOfCosine(cosine);
    const Bsdf<double> bsdf(surface.point, wo, surface.side);
    const MicrofacetCoordinates coordinates(surface, wo);
    std::vector<double> counts(MicrofacetCoordinates::kBins + 1, 0.0);
    for (int i = 0; i < kSamples; ++i) {
        const auto word = [&] { return wordOf(random.unit()); };
        const std::uint32_t u = word(), v = word();
        const auto sample = bsdf.sample({u, v, 0, word()});
        ++counts[static_cast<std::size_t>(sample ? coordinates.binOf(sample->wi) : MicrofacetCoordinates::kBins)];
    }
    std::vector<BinMass> masses;
    BinMass all;
    for (int bin = 0; bin < MicrofacetCoordinates::kBins; ++bin) {
        masses.push_back(massOfBin(bsdf, coordinates, bin, random));
        all.mean += masses.back().mean;
        all.variance += masses.back().variance;
    }
    masses.push_back({std::max(1.0 - all.mean, 0.0), all.variance});
    const double lost = counts.back() / kSamples;
    // At least one sample may have been lost by chance.
    const double spread = std::sqrt((lost * (1.0 - lost) + 1.0 / kSamples) / kSamples + all.variance);
    return {ChiSquare(counts, masses, kSamples).deviate(), (1.0 - lost - all.mean) / spread};
}

TEST(ReferenceLobes, AreSampledWithTheirDensity) {
    Random random(17);
    for (const double alpha : kAlphas)
        for (const LobeCase& surface : lobeCases(alpha))
            for (const double cosine : kCosines) {
                SCOPED_TRACE(surface.name + ", alpha " + std::to_string(alpha) + ", cosine " + std::to_string(cosine));
                const Comparison found = compare(surface, cosine, random);
                EXPECT_LT(found.shape, kLimit);
                EXPECT_LT(std::abs(found.whole), kLimit);
            }
}

/// A lobe sampled through its microfacet and evaluated from the direction.
TEST(ReferenceLobes, SamplesCarryTheirDensityAndWeight) {
    Random random(5);
    for (const double alpha : kAlphas)
        for (const LobeCase& surface : lobeCases(alpha))
            for (int i = 0; i < 300; ++i) {
                const Bsdf<double> bsdf(surface.point, directionOfCosine(random.between(1e-3, 1.0)), surface.side);
                const auto sample = bsdf.sample(latticeWords(static_cast<std::uint32_t>(i)));
                if (!sample) continue;
                ASSERT_NEAR(glm::length(sample->wi), 1.0, 1e-12);
                const Scattered<double> again = bsdf.evaluate(sample->wi);
                // Rounding of the direction, over the width of the lobe.
                const double tolerance = 1e-13 / (alpha * alpha);
                ASSERT_NEAR(again.pdf / *sample->pdf, 1.0, tolerance) << surface.name << ' ' << alpha;
                const Vec3d value = sample->weight * *sample->pdf;
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(again.value[c], value[c], tolerance * *sample->pdf) << surface.name;
            }
}

TEST(ReferenceLobes, UniformDirectionsHaveTheSameMean) {
    constexpr std::uint32_t kCount = 200000;
    for (const LobeCase& surface : lobeCases(0.5)) {
        const Bsdf<double> bsdf(surface.point, directionOfCosine(0.6), surface.side);
        Vec3d sum(0.0);
        for (std::uint32_t i = 0; i < kCount; ++i) {
            const auto sample = bsdf.sampleUniformly(latticeWords(i));
            if (sample) sum += Vec3d(sample->weight / (sample->transmits() ? bsdf.radianceScale() : 1.0));
        }
        const Vec3d expected = albedoOf(bsdf, kCount).mean;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / kCount, expected[c], 2e-3) << surface.name;
    }
}

/// f without the compensation, which depends on wo alone.
Vec3d singleScattering(const LobeCase& surface, const Vec3d& wo, const Vec3d& wi) {
    const Scattered<double> scattered = Bsdf<double>(surface.point, wo, surface.side).evaluate(wi);
    const double albedo = surface.point.isSolid()
                              ? glassAlbedoAt(wo.z, surface.point.alpha, surface.point.ior, surface.side)
                              : reflectionAlbedoAt(wo.z, surface.point.alpha);
    const bool glass = surface.point.transmission == 1.0;
    const Vec3d compensation = glass ? Vec3d(1 / albedo) : Vec3d(1.0) + surface.point.base * (1 / albedo - 1);
    return scattered.value / (std::abs(wi.z) * compensation);
}

TEST(ReferenceLobes, AreReciprocal) {
    Random random(9);
    for (const double alpha : {0.03, 0.3, 1.0}) {
        for (const LobeCase& surface : lobeCases(alpha)) {
            const bool single = surface.point.metal == 1.0 || surface.point.transmission == 1.0;
            if (!single) continue; // the base darkens by wo alone
            for (int i = 0; i < 300; ++i) {
                const Vec3d wo = directionOfCosine(random.between(0.01, 1.0));
                Vec3d wi = directionOfCosine(random.between(0.01, 1.0), random.between(0.0, 2 * kPi));
                const bool below = surface.point.transmission > 0.0 && i % 2 == 1;
                LobeCase back = surface;
                double scaling = 1.0; // radiance over the square of the index is what travels both ways alike
                Vec3d there = wi, backWi = wo;
                if (below) {
                    wi.z = -wi.z;
                    backWi.z = -backWi.z;
                    back.side = surface.side == Side::front ? Side::back : Side::front;
                    const double eta = surface.side == Side::front ? surface.point.ior : 1 / surface.point.ior;
                    if (surface.point.isSolid()) scaling = eta * eta;
                }
                const Vec3d f = singleScattering(surface, wo, wi) * scaling;
                const Vec3d g = singleScattering(back, there, backWi);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(f[c], g[c], 1e-9 * std::max(f[c], 1e-3)) << surface.name << ' ' << alpha << below;
            }
        }
    }
}

/// What the tables of albedos promise.
constexpr double kTableError = 0.005;
constexpr double kSigmas = 4.5;

/// No surface returns more than it gets.
TEST(ReferenceLobes, NoEnergyAppears) {
    for (const double alpha : {1e-3, 0.03, 0.1, 0.3, 0.6, 1.0})
        for (LobeCase& surface : lobeCases(alpha))
            for (const double cosine : {1.0, 0.6, 0.2, 0.05, 1e-3}) {
                surface.point.base = Vec3d(1.0);
                const Bsdf<double> bsdf(surface.point, directionOfCosine(cosine), surface.side);
                const Albedo albedo = albedoOf(bsdf, 4096);
                const Vec3d least = albedo.mean - kSigmas * albedo.standardError;
                EXPECT_LE(maxComponent(least), 1.0 + kTableError) << surface.name << ' ' << alpha << ' ' << cosine;
            }
}

void expectWhite(const LobeCase& surface, double cosine) {
    const Albedo albedo = albedoOf(Bsdf<double>(surface.point, directionOfCosine(cosine), surface.side), 12000);
    EXPECT_NEAR(albedo.mean.x, 1.0, kTableError + kSigmas * albedo.standardError.x)
        << surface.name << ", alpha " << surface.point.alpha << ", cosine " << cosine;
}

TEST(ReferenceLobes, WhiteSurfacesReturnEverything) {
    for (const double alpha : {1e-3, 0.03, 0.1, 0.25, 0.4, 0.7, 1.0})
        for (const double cosine : {1.0, 0.85, 0.6, 0.3, 0.1, 0.02}) {
            expectWhite({"metal", metalPoint(alpha)}, cosine);
            expectWhite({"thin glass", glassPoint(alpha, 1.5, Body::wall)}, cosine);
            expectWhite({"coated", coatedPoint(alpha, 1.5)}, cosine);
            expectWhite({"coated, dense", coatedPoint(alpha, 2.4)}, cosine);
            for (const double ior : {1.1, 1.33, 1.5, 2.0})
                for (const Side side : {Side::front, Side::back})
                    expectWhite({side == Side::front ? "glass" : "glass from inside",
                                 glassPoint(alpha, ior, Body::solid), side},
                                cosine);
        }
}

/// Metal of a share m beside a dielectric on a base: each share returns what it gets, whatever the other does.
TEST(ReferenceLobes, WhitePartlyMetalSurfacesReturnEverything) {
    for (const double metal : {0.0, 0.25, 0.5, 0.75, 1.0})
        for (const double roughness : {0.0, 0.1, 0.5, 1.0})
            for (const double cosine : {1.0, 0.6, 0.1}) {
                const MaterialPoint<double> point = partlyMetalPoint(roughness * roughness, metal);
                // Lattices of this size integrate what the lobes weigh to some 1e-4.
                const Albedo albedo = albedoOf(Bsdf<double>(point, directionOfCosine(cosine), Side::front), 60000);
                EXPECT_NEAR(albedo.mean.x, 1.0, kTableError) << metal << ' ' << roughness << ' ' << cosine;
            }
}

/// The shares weigh 1 together, each reflects (F0 + (F90 - F0) R)(E + F0 (1 - E)) <= 1 of its light, and the base gets
/// what the dielectric leaves in its brightest channel.
TEST(ReferenceLobes, SpecularAndDiffuseNeverExceedOne) {
    Random random(21);
    const auto color = [&] { return Vec3d(random.unit(), random.unit(), random.unit()); };
    for (int i = 0; i < 300; ++i) {
        MaterialPoint<double> point = partlyMetalPoint(random.unit(), random.unit());
        point.base = color();
        point.f90 = random.unit();
        point.f0 = point.f90 * color();
        const double cosine = random.between(0.01, 1.0);
        const Albedo albedo = albedoOf(Bsdf<double>(point, directionOfCosine(cosine), Side::front), 8192);
        EXPECT_LE(maxComponent(albedo.mean - kSigmas * albedo.standardError), 1.0 + kTableError) << i;
    }
}

TEST(ReferenceLobes, FloatAgreesWithDouble) {
    for (const double alpha : {1e-3, 0.03, 0.5})
        for (const LobeCase& surface : lobeCases(alpha))
            for (const double cosine : {0.9, 0.2, 1e-2}) {
                MaterialPoint<float> single;
                single.base = Vec3f(surface.point.base);
                single.metal = static_cast<float>(surface.point.metal);
                single.transmission = static_cast<float>(surface.point.transmission);
                single.alpha = static_cast<float>(alpha);
                single.f0 = Vec3f(surface.point.f0);
                single.f90 = static_cast<float>(surface.point.f90);
                single.ior = static_cast<float>(surface.point.ior);
                single.body = surface.point.body;
                const Vec3d wo = directionOfCosine(cosine);
                const Vec3d expected = albedoOf(Bsdf<double>(surface.point, wo, surface.side), 2000).mean;
                const Vec3d albedo = albedoOf(Bsdf<float>(single, Vec3f(wo), surface.side), 2000).mean;
                // A choice between lobes may fall otherwise in a few samples of the 2000.
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], expected[c], 2e-3) << surface.name << ' ' << alpha;
            }
}

TEST(ReferenceLobes, DeltaLobes) {
    const Vec3d wo = directionOfCosine(0.6);
    const auto only = [&](const MaterialPoint<double>& point, Side side, double x) {
        const Bsdf<double> bsdf(point, wo, side);
        const auto sample = bsdf.sample({0x12345678u, 0x87654321u, 0, wordOf(x)});
        EXPECT_TRUE(sample && !sample->pdf);
        EXPECT_EQ(bsdf.evaluate(Vec3d(0, 0, 1)).pdf, 0.0);
        EXPECT_EQ(bsdf.spreadProbability(), 0.0);
        return *sample;
    };
    const Vec3d gold(0.9, 0.6, 0.2);
    const auto mirror = only(metalPoint(0.0, gold), Side::front, 0.5);
    EXPECT_NEAR(glm::length(mirror.wi - Vec3d(-wo.x, -wo.y, wo.z)), 0.0, 1e-15);
    EXPECT_NEAR(glm::length(mirror.weight - glm::mix(gold, Vec3d(1.0), schlickWeight(0.6))), 0.0, 1e-15);
    const double reflectance = dielectricFresnel(0.6, 1.5);
    const auto thin = only(glassPoint(0.0, 1.5, Body::wall, gold), Side::front, reflectance + 0.01);
    EXPECT_NEAR(glm::length(thin.wi + wo), 0.0, 1e-15) << "straight on";
    EXPECT_EQ(thin.weight, gold);
    EXPECT_EQ(thin.lobe, Lobe::glassTransmission);
    const auto reflected = only(glassPoint(0.0, 1.5, Body::wall, gold), Side::front, reflectance - 0.01);
    EXPECT_EQ(reflected.lobe, Lobe::glassReflection);
    EXPECT_EQ(reflected.weight, Vec3d(1.0)) << "no tint";
    const auto into = only(glassPoint(0.0, 1.5, Body::solid, gold), Side::front, 0.9);
    EXPECT_NEAR(into.wi.x, -wo.x / 1.5, 1e-15);
    EXPECT_NEAR(glm::length(into.weight - gold / 2.25), 0.0, 1e-15);
    const auto inside = only(glassPoint(0.0, 1.5, Body::solid, gold), Side::back, 0.999);
    EXPECT_EQ(inside.lobe, Lobe::glassReflection) << "total: the sine of 0.8 is beyond 1/1.5";
    const auto rough = only(glassPoint(0.5, 1.0, Body::solid), Side::front, 0.5);
    EXPECT_NEAR(glm::length(rough.wi + wo), 0.0, 1e-15) << "equal indices: there is no surface, however rough";
    const Bsdf<double> coat(coatedPoint(0.0, 1.5), wo, Side::front);
    EXPECT_GT(coat.spreadProbability(), 0.9);
    EXPECT_LT(coat.spreadProbability(), 1.0);
}

} // namespace
} // namespace isolux
