// The albedo tables against quadrature of the definition in other variables: over directions, not over normals.
#include "scene/albedo_tables.h"

#include "core/math.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace isolux {
namespace {

/// Which of the lobe's parts are added up.
struct Albedo {
    double reflected = 0.0; ///< with F = 1
    double fresnel = 0.0;   ///< with F = (1 - cosine)^5
    double glass = 0.0;     ///< reflection and transmission of a dielectric
};

double stretched(double mu, double alpha) { return std::sqrt(alpha * alpha * (1.0 - mu * mu) + mu * mu); }

/// Smith's function, of which the height-correlated G2 = 1/(1 + Lambda(wo) + Lambda(wi)) (Heitz 2014, eq. 72, 99).
double lambda(double mu, double alpha) { return 0.5 * (stretched(mu, alpha) / mu - 1.0); }

double fresnel(double cosine, double eta) {
    const double squared = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    if (squared <= 0.0) return 1.0;
    const double beyond = std::sqrt(squared);
    const double s = (cosine - eta * beyond) / (cosine + eta * beyond);
    const double p = (eta * cosine - beyond) / (eta * cosine + beyond);
    return 0.5 * (s * s + p * p);
}

Vec3d refracted(const Vec3d& wo, const Vec3d& h, double eta) {
    const double cosine = glm::dot(wo, h);
    const double beyond = std::sqrt(std::max(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0));
    return (cosine / eta - beyond) * h - wo / eta;
}

/// Integrates over all normals, not the visible ones: h = (sin t cos p, sin t sin p, cos t) with tan t = alpha
/// sqrt(u / (1 - u)) has the density D cos t; each counts with G2 |wo.h| / (mu cos t).
Albedo integrate(double mu, double alpha, double eta) {
    constexpr int kSteps = 400;
    const Vec3d wo(std::sqrt(1.0 - mu * mu), 0.0, mu);
    const double lambdaO = lambda(mu, alpha);
    Albedo sum;
    for (int i = 0; i < kSteps; ++i) {
        // u = 1 - (1 - s)^4 resolves the long tail.
        const double s = (i + 0.5) / kSteps;
        const double rest = (1.0 - s) * (1.0 - s) * (1.0 - s) * (1.0 - s);
        const double weightU = 4.0 * (1.0 - s) * (1.0 - s) * (1.0 - s) / kSteps;
        const double tangent = alpha * std::sqrt((1.0 - rest) / rest);
        const double z = 1.0 / std::sqrt(1.0 + tangent * tangent);
        for (int j = 0; j < kSteps; ++j) {
            const double phi = kPi * (j + 0.5) / kSteps;
            const Vec3d h(z * tangent * std::cos(phi), z * tangent * std::sin(phi), z);
            const double cosine = glm::dot(wo, h);
            if (cosine <= 0.0) continue;
            const double weight = weightU / kSteps * cosine / (mu * z);
            const auto masked = [&](double mi) { return weight / (1.0 + lambdaO + lambda(std::abs(mi), alpha)); };
            const double up = 2.0 * cosine * h.z - mu;
            const double f = fresnel(cosine, eta);
            if (up > 0.0) {
                sum.reflected += masked(up);
                sum.fresnel += masked(up) * std::pow(1.0 - cosine, 5.0);
                sum.glass += f * masked(up);
            }
            const double down = refracted(wo, h, eta).z;
            if (f < 1.0 && down < 0.0) sum.glass += (1.0 - f) * masked(down);
        }
    }
    return sum;
}

/// Linear between the nodes of an axis: the lower one and how far it is to the next.
struct Place {
    std::size_t node;
    double fraction;
};
Place place(double coordinate, std::uint32_t nodes) {
    const double position = coordinate * (nodes - 1);
    const auto node = std::min(static_cast<std::size_t>(position), std::size_t{nodes} - 2);
    return {node, position - static_cast<double>(node)};
}

double interpolate(std::span<const float> table, std::uint32_t width, const Place& x, const Place& y) {
    const auto row = [&](std::size_t j) {
        return table[j * width + x.node] * (1.0 - x.fraction) + table[j * width + x.node + 1] * x.fraction;
    };
    return row(y.node) * (1.0 - y.fraction) + row(y.node + 1) * y.fraction;
}

double angleCoordinate(double mu, double alpha) {
    const double m = std::sqrt(mu);
    const double y = std::sqrt(alpha);
    return m * (1.0 + y) / (m + y);
}

double reflectionAt(double mu, double alpha) {
    return interpolate(reflectionAlbedo(), kAlbedoAngles, place(angleCoordinate(mu, alpha), kAlbedoAngles),
                       place(std::sqrt(alpha), kAlbedoRoughnesses));
}

double fresnelAt(double mu, double alpha) {
    return interpolate(fresnelAlbedo(), kFresnelAngles, place(std::sqrt(mu), kFresnelAngles),
                       place(std::sqrt(alpha), kAlbedoRoughnesses));
}

double glassAt(double mu, double alpha, double ior, std::size_t side) {
    const Place x = place(angleCoordinate(mu, alpha), kGlassAngles);
    const Place y = place(std::sqrt(alpha), kGlassRoughnesses);
    const Place z = place(std::sqrt((ior - 1.0) / (ior + 1.0)), kGlassIndices);
    constexpr std::size_t kSlice = std::size_t{kGlassAngles} * kGlassRoughnesses;
    const auto slice = [&](std::size_t k) {
        return interpolate(glassAlbedo().subspan((side * kGlassIndices + k) * kSlice, kSlice), kGlassAngles, x, y);
    };
    return slice(z.node) * (1.0 - z.fraction) + slice(z.node + 1) * z.fraction;
}

/// Cosine and alpha from [0.05, 1]: the quadrature over all normals is good to 1e-3 there, not where few are visible.
std::array<double, 2> randomPoint(std::mt19937& random) {
    const auto draw = [&] { return std::pow(20.0, std::uniform_real_distribution(-1.0, 0.0)(random)); };
    const double mu = draw();
    return {mu, draw()};
}

constexpr double kQuadrature = 1e-3;    // of `integrate`, by halving its steps
constexpr double kInterpolation = 5e-3; // what the tables promise of a white furnace

TEST(AlbedoTables, HaveTheSizesTheySay) {
    EXPECT_EQ(reflectionAlbedo().size(), kAlbedoAngles * kAlbedoRoughnesses);
    EXPECT_EQ(fresnelAlbedo().size(), kFresnelAngles * kAlbedoRoughnesses);
    EXPECT_EQ(glassAlbedo().size(), 2 * kGlassAngles * kGlassRoughnesses * kGlassIndices);
}

TEST(AlbedoTables, AreShares) {
    for (const std::span<const float> table : {reflectionAlbedo(), fresnelAlbedo(), glassAlbedo()})
        for (const float value : table) {
            EXPECT_GE(value, 0.0f);
            EXPECT_LE(value, 1.0f);
        }
    for (const float value : glassAlbedo()) ASSERT_GT(value, 0.0f) << "its inverse compensates";
}

TEST(AlbedoTables, HaveTheirLimits) {
    for (const double alpha : {1e-3, 0.1, 1.0}) EXPECT_NEAR(reflectionAt(0.0, alpha), 1.0, 1e-4) << "grazing";
    for (const double mu : {0.1, 0.5, 1.0}) {
        EXPECT_NEAR(reflectionAt(mu, 0.0), 1.0, 1e-3) << "smooth";
        EXPECT_NEAR(fresnelAt(mu, 0.0), std::pow(1.0 - mu, 5.0), 2e-3);
        // Linear in the table's coordinate, h = 1/47: half of h^2/4 of the second derivative, below 1.
        EXPECT_NEAR(glassAt(mu, 0.5, 1.0, 0), (mu + stretched(mu, 0.5)) / (2.0 * stretched(mu, 0.5)), 1e-3);
        for (const std::size_t side : {0u, 1u}) {
            EXPECT_NEAR(glassAt(mu, 0.0, 1.5, side), 1.0, 1e-3);
            EXPECT_NEAR(glassAt(mu, 0.5, 1e15, side), reflectionAt(mu, 0.5), kInterpolation) << "reflects everything";
        }
    }
}

TEST(AlbedoTables, NodesAreTheIntegrals) {
    for (const std::size_t y : {10u, 20u, 31u})
        for (const std::size_t x : {18u, 24u, 29u}) {
            const double root = static_cast<double>(y) / (kAlbedoRoughnesses - 1);
            const double t = static_cast<double>(x) / (kAlbedoAngles - 1);
            const double m = t * root / (1.0 + root - t);
            const Albedo expected = integrate(m * m, root * root, 1.5);
            EXPECT_NEAR(reflectionAlbedo()[y * kAlbedoAngles + x], expected.reflected, kQuadrature) << x << ", " << y;
            const Albedo other = integrate(t * t, root * root, 1.5);
            EXPECT_NEAR(fresnelAlbedo()[y * kFresnelAngles + x], other.fresnel / other.reflected, kQuadrature);
        }
}

TEST(AlbedoTables, InterpolationKeepsAFurnaceWhite) {
    std::mt19937 random(5);
    for (int i = 0; i < 60; ++i) {
        const auto [mu, alpha] = randomPoint(random);
        const Albedo expected = integrate(mu, alpha, 1.5);
        EXPECT_NEAR(expected.reflected / reflectionAt(mu, alpha), 1.0, kInterpolation + kQuadrature)
            << mu << ", " << alpha;
        EXPECT_NEAR(expected.fresnel / expected.reflected, fresnelAt(mu, alpha), kInterpolation + kQuadrature);
    }
}

TEST(AlbedoTables, InterpolationKeepsGlassWhite) {
    std::mt19937 random(6);
    for (const double ior : {1.1, 1.33, 1.5, 2.4})
        for (const std::size_t side : {0u, 1u})
            for (int i = 0; i < 20; ++i) {
                const auto [mu, alpha] = randomPoint(random);
                const double expected = integrate(mu, alpha, side == 0 ? ior : 1.0 / ior).glass;
                EXPECT_NEAR(expected / glassAt(mu, alpha, ior, side), 1.0, kInterpolation + kQuadrature)
                    << mu << ", " << alpha << ", " << ior << ", " << side;
            }
}

} // namespace
} // namespace isolux
