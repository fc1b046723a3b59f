// Reflectance of boundaries, and the directions of mirrors and of refraction, against what optics says of them.
#include "reference/fresnel.h"
#include "unit/reference_scenes.h"

#include <gtest/gtest.h>

namespace isolux {
namespace {

using namespace test;

TEST(ReferenceFresnel, NormalIncidence) {
    for (const double eta : {1.0, 1.33, 1.5, 2.42, 1 / 1.5}) {
        const double root = (eta - 1) / (eta + 1);
        EXPECT_NEAR(dielectricFresnel(1.0, eta), root * root, 1e-15) << eta;
    }
}

TEST(ReferenceFresnel, BrewsterAngleReflectsOnePolarisationAlone) {
    for (const double eta : {1.33, 1.5, 1 / 1.5}) {
        const double cosine = 1 / std::sqrt(1 + eta * eta); // tan = eta
        // There the reflected and the refracted ray are at right angles: sin(a - b)^2/2 with b = 90 degrees - a.
        const double perpendicular = 2 * cosine * cosine - 1;
        EXPECT_NEAR(dielectricFresnel(cosine, eta), perpendicular * perpendicular / 2, 1e-15) << eta;
    }
}

TEST(ReferenceFresnel, TotalReflectionBeyondTheCriticalAngle) {
    const double eta = 1 / 1.5;
    const double critical = std::sqrt(1 - eta * eta);
    EXPECT_EQ(dielectricFresnel(critical * (1 - 1e-12), eta), 1.0);
    EXPECT_EQ(dielectricFresnel(0.0, eta), 1.0);
    EXPECT_LT(dielectricFresnel(critical * (1 + 1e-12), eta), 1.0);
    EXPECT_EQ(dielectricFresnel(0.0, 1.5), 1.0) << "grazing";
}

TEST(ReferenceFresnel, TheSameFromBothSides) {
    for (const double cosine : {0.05, 0.3, 0.8, 1.0}) {
        const double beyond = std::sqrt(1 - (1 - cosine * cosine) / (1.5 * 1.5));
        EXPECT_NEAR(dielectricFresnel(cosine, 1.5), dielectricFresnel(beyond, 1 / 1.5), 1e-14);
    }
}

TEST(ReferenceFresnel, EqualIndicesReflectNothing) {
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    for (const double cosine : {1.0, 0.5, 1e-3}) {
        const double rounding = 2 * kEpsilon / (cosine * cosine); // relative, of the cosine beyond
        EXPECT_LE(dielectricFresnel(cosine, 1.0), rounding * rounding);
    }
}

TEST(ReferenceFresnel, SnellAndMirror) {
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d h = random.direction();
        Vec3d wo = random.direction();
        if (glm::dot(wo, h) < 0) wo = -wo;
        const double eta = random.between(0.4, 2.5);
        const Vec3d mirrored = reflectAt(h, wo);
        ASSERT_NEAR(glm::dot(mirrored, h), glm::dot(wo, h), 1e-14);
        ASSERT_NEAR(glm::length(glm::cross(mirrored, h) + glm::cross(wo, h)), 0.0, 1e-14);
        if (dielectricFresnel(glm::dot(wo, h), eta) == 1.0) continue;
        const Vec3d refracted = refractAt(h, wo, eta);
        ASSERT_NEAR(glm::length(refracted), 1.0, 1e-12);
        ASSERT_LT(glm::dot(refracted, h), 0.0);
        // n1 sin(a1) = n2 sin(a2), in one plane and to the other side of the normal.
        ASSERT_NEAR(glm::length(glm::cross(h, wo) + eta * glm::cross(h, refracted)), 0.0, 1e-12);
    }
}

TEST(ReferenceFresnel, SchlickAtBothEnds) {
    EXPECT_EQ(schlickWeight(1.0), 0.0);
    EXPECT_EQ(schlickWeight(0.0), 1.0);
    EXPECT_NEAR(schlickWeight(0.5), 1.0 / 32, 1e-15);
}

} // namespace
} // namespace isolux
