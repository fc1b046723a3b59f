// Lobes and whole materials by the shaders that ship: sampled with the density they claim, no energy lost or gained,
// the same as the double reference.
#include "device/device_test.h"
#include "device/lobe_distribution.h"
#include "device/lobe_rounding.h"
#include "report/statistics.h"
#include "unit/reference_lobes.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace isolux::test {
namespace {

const std::vector<double> kAlphas = {1e-3, 1e-2, 0.1, 0.5, 1.0};
const std::vector<double> kCosines = {1.0, 0.7, 0.1, 1e-3};

using LobeTable = std::vector<DeviceLobe> (*)(double alpha);

std::vector<DeviceLobe> lobesOf(LobeTable table, const std::vector<double>& alphas) {
    std::vector<DeviceLobe> lobes;
    for (const double alpha : alphas)
        for (const DeviceLobe& lobe : table(alpha)) lobes.push_back(lobe);
    return lobes;
}

/// A lobe and a direction it is seen from.
struct View {
    std::size_t lobe;
    double cosine;
};

/// All pairs; on drivers that repeat what another has done about a tenth, by an odd step that meets every cosine.
std::vector<View> viewsOf(std::size_t lobes, const std::vector<double>& cosines) {
    std::vector<View> views;
    const auto step = static_cast<std::size_t>(std::lround(1.0 / workShare())) | 1u;
    for (std::size_t i = 0; i < lobes * cosines.size(); i += step)
        views.push_back({i / cosines.size(), cosines[i % cosines.size()]});
    return views;
}

std::string nameOf(const DeviceLobe& lobe, double cosine) {
    return lobe.name + ", ior " + std::to_string(lobe.material.ior) + ", alpha " + std::to_string(lobe.alpha()) +
           ", cosine " + std::to_string(cosine);
}

/// Standard normal deviates that none of `comparisons` exceeds by chance but once in a thousand runs (Sidak 1967).
double limitOf(std::size_t comparisons) {
    return normalQuantile(std::pow(1.0 - 1e-3, 1.0 / static_cast<double>(comparisons)));
}

class Lobes : public DeviceTest {};

TEST_F(Lobes, AreSampledWithTheirDensity) {
    std::vector<double> alphas = kAlphas;
    alphas.push_back(0.0);
    const std::vector<DeviceLobe> lobes = lobesOf(deviceLobes, alphas);
    LobeKernel kernel(device_, lobes);
    const std::vector<View> views = viewsOf(lobes.size(), kCosines);
    const double limit = limitOf(3 * views.size()); // the second comparison has two sides
    for (std::size_t i = 0; i < views.size(); ++i) {
        const View& view = views[i];
        const DistributionDeviates found = compareDistribution(kernel, view.lobe, outgoingOfCosine(view.cosine), i);
        EXPECT_LT(found.shape, limit) << nameOf(lobes[view.lobe], view.cosine);
        EXPECT_LT(std::abs(found.whole), limit) << nameOf(lobes[view.lobe], view.cosine);
    }
}

/// Seeded words and directions.
class RandomQueries {
public:
    glm::uvec4 words() {
        const std::uint32_t x = word(), y = word();
        return {x, y, 0u, word()};
    }
    /// As many grazing ones as others: the logarithm of their cosine is uniform from 1e-3 on.
    Vec3f outgoing() { return turned(outgoingOfCosine(std::pow(10.0, -3.0 * unit()))); }
    double unit() { return word() * 0x1p-32; }

private:
    std::uint32_t word() { return static_cast<std::uint32_t>(engine_()); }
    Vec3f turned(const Vec3f& w) {
        const double phi = 2.0 * kPi * unit();
        return {static_cast<float>(w.x * std::cos(phi)), static_cast<float>(w.x * std::sin(phi)), w.z};
    }

    std::mt19937 engine_{3};
};

/// Differences are measured in what rounding each input once moves the reference by (lobe_rounding.h). A lobe takes
/// some tens of operations one after the other, each of which rounds by a few units on a device that Vulkan allows.
/// Measured: 0 of the limit on lavapipe.
constexpr double kRoundings = 32.0;

class LobeRounding : public Lobes {
protected:
    std::vector<double> alphas() const { return {0.0, 1e-3, 1e-2, 0.1, 0.5, 1.0}; }
    const std::size_t count_ = static_cast<std::size_t>(1000 * workShare()); ///< queries a lobe
    RandomQueries random_;
};

double ratio(const Vec3d& found, const Vec3d& expected, const Vec3d& rounding) {
    return maxComponent(glm::abs(found - expected) / glm::max(rounding, Vec3d(1e-300)));
}

TEST_F(LobeRounding, SamplesAreThoseOfTheReference) {
    LobeKernel kernel(device_, lobesOf(deviceLobes, alphas()));
    LobeQueries queries;
    for (std::size_t i = 0; i < kernel.lobeCount() * count_; ++i)
        queries.push_back(kernel.sampling(i / count_, random_.outgoing(), random_.words()));
    const LobeAnswers answers = kernel.answer(queries);
    std::size_t unstable = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        SCOPED_TRACE(nameOf(kernel.lobe(i / count_), queries[i].outgoing.z));
        const glm::uvec4& words = queries[i].random;
        const RoundedSample expected =
            sampleRounded(kernel, i / count_, Vec3f(queries[i].outgoing), {words.x, words.y, 0u, words.w});
        if (!expected.stable) {
            ++unstable;
            continue;
        }
        const Vec3d wi(answers[i].directionPdf);
        ASSERT_EQ(expected.exact.has_value(), wi != Vec3d(0.0));
        if (!expected.exact) continue;
        ASSERT_EQ(answers[i].outcome.x, shared::kLobeDiffuse + static_cast<std::uint32_t>(expected.exact->lobe));
        ASSERT_EQ(answers[i].outcome.y == 0u, expected.exact->pdf.has_value());
        ASSERT_LT(glm::length(wi - expected.exact->wi) / expected.direction, kRoundings);
        if (expected.exact->pdf) continue;
        ASSERT_LT(ratio(Vec3d(answers[i].value), expected.exact->weight, expected.weight), kRoundings);
    }
    EXPECT_LT(unstable, queries.size() / 1000);
}

/// At sampled directions, where the density must be that of something that happens, and at any others.
TEST_F(LobeRounding, ValuesAndDensitiesAreThoseOfTheReference) {
    LobeKernel kernel(device_, lobesOf(deviceLobes, alphas()));
    LobeQueries queries;
    for (std::size_t i = 0; i < kernel.lobeCount() * count_; ++i) {
        Vec3f wi = random_.outgoing();
        if (random_.unit() < 0.5) wi.z = -wi.z;
        const Vec3f wo = random_.outgoing();
        queries.push_back(i % 4 == 0 ? kernel.evaluating(i / count_, wo, wi)
                                     : kernel.sampling(i / count_, wo, random_.words()));
    }
    const LobeAnswers answers = kernel.answer(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        SCOPED_TRACE(nameOf(kernel.lobe(i / count_), queries[i].outgoing.z));
        const Vec3f wi(answers[i].directionPdf);
        if (answers[i].outcome.y != 0u || wi == Vec3f(0.0f)) continue;
        if (i % 4 != 0) {
            ASSERT_GT(answers[i].directionPdf.w, 0.0f);
        }
        const Rounded expected = evaluateRounded(kernel, i / count_, Vec3f(queries[i].outgoing), wi);
        ASSERT_LT(ratio(Vec3d(answers[i].value), expected.exact.value, expected.value), kRoundings);
        ASSERT_LT(ratio(Vec3d(answers[i].directionPdf.w), Vec3d(expected.exact.pdf), Vec3d(expected.pdf)), kRoundings);
    }
}

/// What travels from wi to wo apart from the compensation, which depends on wo alone, and what rounding moves it by.
struct SingleScattering {
    Vec3d f;
    Vec3d rounding;
};

/// Radiance over the square of the index is what travels both ways alike (Veach 1997, 5.2): each way bears one of the
/// two.
SingleScattering singleScattering(const LobeKernel& kernel, std::size_t lobe, const shared::LobeQueryRecord& query,
                                  const shared::LobeAnswerRecord& answer) {
    const DeviceLobe& surface = kernel.lobe(lobe);
    const Vec3f wi(query.incoming);
    const bool glass = surface.material.transmission > 0.0;
    const double boost = 1.0 / reflectionAlbedoAt(double(query.outgoing.z), surface.alpha()) - 1.0;
    const Vec3d compensation = glass ? Vec3d(answer.compensation.x) : 1.0 + surface.material.baseColor * boost;
    const double scaling = surface.isSolid() && wi.z < 0.0f ? surface.eta() : 1.0;
    const Vec3d factor = scaling / (std::abs(double(wi.z)) * compensation);
    const Vec3d rounding = evaluateRounded(kernel, lobe, Vec3f(query.outgoing), wi).value;
    return {Vec3d(answer.value) * factor, rounding * factor};
}

TEST_F(LobeRounding, SingleScatteringIsReciprocal) {
    const std::vector<DeviceLobe> lobes = lobesOf(oneLobeEach, kAlphas); // even: from the front, odd: from the back
    LobeKernel kernel(device_, lobes);
    LobeQueries queries;
    for (std::size_t i = 0; i < lobes.size() * count_; ++i) {
        const Vec3f wo = random_.outgoing(), wi = random_.outgoing();
        const std::size_t lobe = i / count_;
        const bool below = lobes[lobe].material.transmission > 0.0 && i % 2 == 1;
        const float side = below ? -1.0f : 1.0f;
        queries.push_back(kernel.evaluating(lobe, wo, {wi.x, wi.y, side * wi.z}));
        queries.push_back(kernel.evaluating(below ? lobe ^ 1u : lobe, wi, {wo.x, wo.y, side * wo.z}));
    }
    const LobeAnswers answers = kernel.answer(queries);
    for (std::size_t i = 0; i < queries.size(); i += 2) {
        const std::size_t lobe = i / 2 / count_;
        const std::size_t back = queries[i].incoming.z < 0.0f ? lobe ^ 1u : lobe;
        const SingleScattering there = singleScattering(kernel, lobe, queries[i], answers[i]);
        const SingleScattering again = singleScattering(kernel, back, queries[i + 1], answers[i + 1]);
        ASSERT_LT(ratio(there.f, again.f, there.rounding + again.rounding), kRoundings)
            << nameOf(lobes[lobe], queries[i].outgoing.z);
    }
}

/// The part of light that is not absorbed, with a t interval: a lattice shifted at random, once for each value.
class Albedos {
public:
    explicit Albedos(LobeKernel& kernel) : kernel_(kernel) {}

    /// The interval of the largest channel.
    Interval of(const View& view, double confidence) {
        LobeQueries queries;
        const Vec3f wo = outgoingOfCosine(view.cosine);
        const std::uint32_t points = pointsOf(kernel_.lobe(view.lobe));
        for (std::size_t shift = 0; shift < kShifts; ++shift) {
            const glm::uvec4 offset = random_.words();
            for (std::uint32_t i = 0; i < points; ++i) {
                const PhiloxBlock words = latticeWords(i);
                queries.push_back(
                    kernel_.sampling(view.lobe, wo, offset + glm::uvec4(words[0], words[1], 0u, words[3])));
            }
        }
        const LobeAnswers answers = kernel_.answer(queries);
        std::vector<double> means(kShifts, 0.0);
        for (std::size_t i = 0; i < answers.size(); ++i)
            means[i / points] += maxComponent(weightOf(kernel_.lobe(view.lobe), answers[i])) / points;
        return meanInterval(means, confidence);
    }

private:
    static constexpr std::size_t kShifts = 24;

    /// Broad lobes lose samples below the surface and at other microfacets: their weights differ.
    static std::uint32_t pointsOf(const DeviceLobe& lobe) { return lobe.alpha() > 0.2 ? 1536 : 512; }

    /// With the scaling of radiance undone.
    [[nodiscard]] static Vec3d weightOf(const DeviceLobe& lobe, const shared::LobeAnswerRecord& answer) {
        const double density = answer.outcome.y != 0u ? 1.0 : answer.directionPdf.w;
        if (density <= 0.0) return Vec3d(0.0);
        const double scaling = lobe.isSolid() && answer.directionPdf.z < 0.0f ? lobe.eta() * lobe.eta() : 1.0;
        return Vec3d(answer.value) * (scaling / density);
    }

    LobeKernel& kernel_;
    RandomQueries random_;
};

/// What the tables of albedos promise (host/scene/README.md).
constexpr double kTableError = 0.005;
/// Half an interval at most: what a test could not see. The median is 0.0014; 0.02 inside glass of index 1.1 at grazing
/// angles, where few samples leave and those weigh much.
constexpr double kResolution = 0.025;

class LobeEnergy : public Lobes {
protected:
    const std::vector<double> alphas_ = {0.0, 1e-3, 0.01, 0.1, 0.3, 0.6, 1.0};
    const std::vector<double> cosines_ = {1.0, 0.85, 0.5, 0.2, 0.05, 0.01, 1e-3};

    void expectWhite(LobeTable table) {
        LobeKernel kernel(device_, lobesOf(table, alphas_));
        Albedos albedos(kernel);
        const std::vector<View> views = viewsOf(kernel.lobeCount(), cosines_);
        for (const View& view : views) {
            const Interval albedo = albedos.of(view, confidence(views.size()));
            EXPECT_LT(albedo.low, 1.0 + kTableError) << nameOf(kernel.lobe(view.lobe), view.cosine);
            EXPECT_GT(albedo.high, 1.0 - kTableError) << nameOf(kernel.lobe(view.lobe), view.cosine);
            EXPECT_LT(albedo.high - albedo.estimate, kResolution) << nameOf(kernel.lobe(view.lobe), view.cosine);
        }
    }

    /// Intervals that all hold but once in a thousand runs.
    static double confidence(std::size_t views) { return std::pow(1.0 - 1e-3, 1.0 / static_cast<double>(views)); }
};

TEST_F(LobeEnergy, WhiteSurfacesReturnEverything) { expectWhite(whiteLobes); }

TEST_F(LobeEnergy, WhitePartlyMetalSurfacesReturnEverything) { expectWhite(partlyMetalLobes); }

TEST_F(LobeEnergy, NoneAppears) {
    std::vector<DeviceLobe> lobes = lobesOf(deviceLobes, alphas_);
    for (DeviceLobe& lobe : lobes) lobe.material.baseColor = Vec3d(1.0);
    LobeKernel kernel(device_, lobes);
    Albedos albedos(kernel);
    const std::vector<View> views = viewsOf(lobes.size(), cosines_);
    for (const View& view : views) {
        const Interval albedo = albedos.of(view, confidence(views.size()));
        EXPECT_LT(albedo.low, 1.0 + kTableError) << nameOf(lobes[view.lobe], view.cosine);
    }
}

/// Both kinds of buffers; solid glass has a table too large for the smallest texel buffers.
TEST_F(Lobes, StorageBuffersGiveTheSame) {
    const std::vector<DeviceLobe> lobes{deviceLobes(0.1)[2], deviceLobes(0.5)[3]};
    LobeKernel texels(device_, lobes, ReadPath::texelBuffers), storage(device_, lobes, ReadPath::storageBuffers);
    RandomQueries random;
    LobeQueries queries;
    for (std::size_t i = 0; i < 1000; ++i) queries.push_back(texels.sampling(i % 2, random.outgoing(), random.words()));
    const LobeAnswers a = texels.answer(queries), b = storage.answer(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        EXPECT_EQ(a[i].directionPdf, b[i].directionPdf) << i;
        EXPECT_EQ(a[i].value, b[i].value) << i;
    }
}

} // namespace
} // namespace isolux::test
