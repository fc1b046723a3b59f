// Tone maps and exposure: anchors computed by hand from the published formulas, what every map must keep, and PNGs.
#include "film_fixture.h"

#include "core/srgb.h"
#include "film/tonemap.h"

#include <array>
#include <cmath>
#include <limits>

namespace isolux {
namespace {

using namespace film_test;

constexpr std::array kAll{Tonemap::none, Tonemap::reinhard, Tonemap::aces, Tonemap::agx, Tonemap::pbrNeutral};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3d shown(Tonemap tonemap, const Vec3d& radiance) { return applyDisplay({tonemap, 0.0}, radiance); }

/// AgX's matrices keep grey nearly: the sums of their rows are 1 with errors from -4.8e-5 to 1.37e-4 (inset) and from
/// -1.72e-4 to 5.9e-5 (outset). Those of the inset move a channel by 1/(16.5 ln 2) of them along the curve, whose slope
/// is at most 2.07. In encoded values: how far one channel is from the curve, and two channels from each other.
constexpr double kAgxError = 1.72e-4 + 1.37e-4 * 2.07 / (16.5 * 0.6931);
constexpr double kAgxSpread = 2.31e-4 + 1.85e-4 * 2.07 / (16.5 * 0.6931);
/// The rows of ACES's output matrix sum to 1 within 1e-5, and the fit reaches 1/0.983729.
constexpr double kAcesError = 1e-5 / 0.983729 + 1e-15;

/// How far the channels of a grey may part in linear values, of which sRGB's slope is at most 2.4/1.055 that of encoded
/// ones. Maps without matrices: rounding.
double greyTolerance(Tonemap tonemap) {
    if (tonemap == Tonemap::aces) return kAcesError;
    return tonemap == Tonemap::agx ? kAgxSpread * 2.4 / 1.055 : 1e-15;
}

TEST(Tonemap, NamesAreRead) {
    EXPECT_EQ(parseTonemap("none"), Tonemap::none);
    EXPECT_EQ(parseTonemap("reinhard"), Tonemap::reinhard);
    EXPECT_EQ(parseTonemap("aces"), Tonemap::aces);
    EXPECT_EQ(parseTonemap("agx"), Tonemap::agx);
    EXPECT_EQ(parseTonemap("pbr-neutral"), Tonemap::pbrNeutral);
    const std::string message = errorOf(ExitCode::badInput, [] { (void)parseTonemap("filmic"); });
    expectMentions(message, "filmic");
    expectMentions(message, "none, reinhard, aces, agx, pbr-neutral");
}

TEST(Tonemap, BlackStaysBlackAndNothingLeavesTheDisplay) {
    for (const Tonemap tonemap : kAll) {
        EXPECT_EQ(shown(tonemap, Vec3d(0.0)), Vec3d(0.0));
        for (const Vec3d& color :
             {Vec3d(1e4, 0.0, 0.0), Vec3d(0.0, 5.0, 0.0), Vec3d(0.0, 0.1, 1e30), Vec3d(1e-9, 3, 7)}) {
            const Vec3d result = shown(tonemap, color);
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(result[c], 0.0);
                EXPECT_LE(result[c], 1.0);
            }
        }
    }
}

TEST(Tonemap, GreyStaysGreyAndBrightensWithRadiance) {
    for (const Tonemap tonemap : kAll) {
        double before = 0.0;
        for (int step = -1400; step <= 1000; ++step) {
            const double stop = step / 100.0;
            const Vec3d result = shown(tonemap, Vec3d(std::exp2(stop)));
            EXPECT_GE(result.y, before) << static_cast<int>(tonemap) << " at 2^" << stop;
            EXPECT_NEAR(result.x, result.y, greyTolerance(tonemap));
            EXPECT_NEAR(result.z, result.y, greyTolerance(tonemap));
            before = result.y;
        }
        EXPECT_GT(before, 0.98) << "a bright grey is nearly white";
    }
}

/// Eq. 3: L/(1 + L), on luminance: the ratios of channels stay.
TEST(Tonemap, ReinhardScalesByLuminance) {
    EXPECT_NEAR(shown(Tonemap::reinhard, Vec3d(0.18)).x, 0.18 / 1.18, 1e-15);
    EXPECT_NEAR(shown(Tonemap::reinhard, Vec3d(1.0)).x, 0.5, 1e-15);
    const Vec3d result = shown(Tonemap::reinhard, {0.4, 0.2, 0.1}); // luminance 0.2353
    EXPECT_NEAR(result.x, 0.4 / 1.2353, 1e-15);
    EXPECT_NEAR(result.y, 0.2 / 1.2353, 1e-15);
}

/// The fit (v(v + 0.0245786) - 0.000090537)/(v(0.983729 v + 0.432951) + 0.238081) at greys around 18 %.
TEST(Tonemap, AcesMeetsTheFitAtGreys) {
    const std::array<std::array<double, 2>, 5> anchors{{{0.01125, 0.001285748039},
                                                        {0.045, 0.011714242018},
                                                        {0.18, 0.105591247229},
                                                        {0.72, 0.505775435600},
                                                        {2.88, 0.867350691756}}};
    for (const auto& [radiance, expected] : anchors)
        EXPECT_NEAR(shown(Tonemap::aces, Vec3d(radiance)).x, expected, kAcesError * expected + 1e-11);
    const Vec3d red = shown(Tonemap::aces, {4.0, 0.0, 0.0});
    EXPECT_GT(red.y, 0.0) << "bright colours lose saturation";
}

/// The polynomial at the greys' places among 16.5 stops; what a PNG gets is that value and not another encoding of it.
TEST(Tonemap, AgxMeetsTheCurveInDisplayCodes) {
    const std::array<std::array<double, 2>, 5> anchors{{{0.01125, 0.107023189590},
                                                        {0.045, 0.265694490872},
                                                        {0.18, 0.496730567378},
                                                        {0.72, 0.737462126079},
                                                        {2.88, 0.908961234575}}};
    for (const auto& [radiance, expected] : anchors)
        EXPECT_NEAR(srgbFromLinear(shown(Tonemap::agx, Vec3d(radiance)).y), expected, kAgxError);
    EXPECT_EQ(shown(Tonemap::agx, Vec3d(1e-5)), Vec3d(0.0)) << "the polynomial is negative at the dark end";
    EXPECT_NEAR(srgbFromLinear(shown(Tonemap::agx, Vec3d(100.0)).y), 0.99858, kAgxError) << "its value at 1";
}

/// Below the start of compression a colour is itself less the offset: 0.04, or x - x^2/0.16 where the least channel x
/// is at most 0.08.
TEST(Tonemap, PbrNeutralIsTheIdentityLessItsOffset) {
    const Vec3d base = shown(Tonemap::pbrNeutral, {0.7, 0.4, 0.1});
    EXPECT_NEAR(base.x, 0.66, 1e-15);
    EXPECT_NEAR(base.y, 0.36, 1e-15);
    EXPECT_NEAR(base.z, 0.06, 1e-15);
    EXPECT_NEAR(shown(Tonemap::pbrNeutral, Vec3d(0.04)).x, 0.01, 1e-15);
    EXPECT_EQ(shown(Tonemap::pbrNeutral, {0.5, 0.0, 0.0}), Vec3d(0.5, 0.0, 0.0));
    EXPECT_NEAR(shown(Tonemap::pbrNeutral, Vec3d(0.8)).x, 0.76, 1e-15);
    EXPECT_NEAR(shown(Tonemap::pbrNeutral, Vec3d(1.0)).x, 1.0 - 0.0576 / 0.44, 1e-15);
    EXPECT_NEAR(shown(Tonemap::pbrNeutral, Vec3d(2.0)).x, 0.96, 1e-15);
    // p = 3, pn = 1 - 0.0576/2.48, g = 1/(0.15 (p - pn) + 1): a pure red towards white
    const double peak = 1.0 - 0.0576 / 2.48;
    const double white = 1.0 - 1.0 / (0.15 * (3.0 - peak) + 1.0);
    const Vec3d red = shown(Tonemap::pbrNeutral, {3.0, 0.0, 0.0});
    EXPECT_NEAR(red.x, peak, 1e-15);
    EXPECT_NEAR(red.y, peak * white, 1e-15);
}

TEST(Tonemap, ExposureCountsInStopsBeforeTheMap) {
    EXPECT_EQ(applyDisplay({Tonemap::none, 1.0}, {0.1, 0.2, 0.3}), Vec3d(0.2, 0.4, 0.6));
    EXPECT_EQ(applyDisplay({Tonemap::none, -2.0}, {0.4, 0.8, 2.0}), Vec3d(0.1, 0.2, 0.5));
    for (const Tonemap tonemap : kAll) EXPECT_EQ(applyDisplay({tonemap, 3.0}, Vec3d(0.05)), shown(tonemap, Vec3d(0.4)));
}

TEST(Tonemap, NegativeIsBlackInfiniteIsWhiteAndNanStays) {
    for (const Tonemap tonemap : kAll) {
        EXPECT_EQ(shown(tonemap, Vec3d(-1.0, -1e30, -kInfinity)), Vec3d(0.0));
        EXPECT_GT(shown(tonemap, Vec3d(kInfinity)).y, 0.99);
        EXPECT_TRUE(std::isnan(shown(tonemap, {kNan, 0.5, 0.5}).x));
        EXPECT_EQ(std::isnan(shown(tonemap, {kNan, 0.5, 0.5}).y), tonemap != Tonemap::none);
    }
}

// --- Files ---

TEST_F(ImageFile, PngHoldsWhatTheDisplayShows) {
    Image image = makeImage(2, 1, {"R", "G", "B"});
    image.values = {0.18f, 0.18f, 0.18f, 4.0f, 1.0f, 0.25f};
    for (const Tonemap tonemap : kAll) {
        const DisplayTransform display{tonemap, -1.5};
        writeImage(path("a.png"), image, display);
        const Image read = readImage(path("a.png"));
        for (std::size_t pixel = 0; pixel < 2; ++pixel) {
            const float* const rgb = image.values.data() + 3 * pixel;
            const Vec3d expected = applyDisplay(display, {rgb[0], rgb[1], rgb[2]});
            for (int c = 0; c < 3; ++c) // half a code of 255
                EXPECT_NEAR(srgbFromLinear(double{read.value(pixel, static_cast<std::size_t>(c))}),
                            srgbFromLinear(expected[c]), 0.5 / 255.0 + 1e-6);
        }
    }
}

TEST_F(ImageFile, LinearFilesIgnoreTheDisplay) {
    const Image image = onePixel(0.25f, 2.0f, 8.0f); // powers of two, which RGBE holds
    for (const char* name : {"a.exr", "a.hdr"}) {
        writeImage(path(name), image, {Tonemap::agx, 3.0});
        EXPECT_EQ(readImage(path(name)).values, image.values) << name;
    }
}

/// The colour under partial coverage is mapped as if it covered the pixel; the display composites it afterwards.
TEST_F(ImageFile, PngMapsColourNotMultipliedByAlpha) {
    Image image = makeImage(2, 1, {"R", "G", "B", "A"});
    image.values = {0.5f, 0.5f, 0.5f, 0.25f, 0.0f, 0.0f, 0.0f, 0.0f};
    writeImage(path("a.png"), image, {Tonemap::reinhard, 0.0});
    const Image read = readImage(path("a.png"));
    ASSERT_EQ(read.channels.size(), 4u);
    const double alpha = double{read.values[3]};
    EXPECT_NEAR(alpha, 0.25, 0.5 / 255.0);
    EXPECT_NEAR(srgbFromLinear(double{read.values[0]} / alpha), srgbFromLinear(2.0 / 3.0), 0.5 / 255.0 + 1e-6);
    for (std::size_t c = 4; c < 8; ++c) EXPECT_EQ(read.values[c], 0.0f);
}

TEST_F(ImageFile, PngShowsNanAsBlackAndInfinityAsWhite) {
    Image image = makeImage(2, 1, {"R", "G", "B"});
    image.values = {NAN, 1.0f, 1.0f, INFINITY, INFINITY, INFINITY};
    for (const Tonemap tonemap : {Tonemap::reinhard, Tonemap::aces, Tonemap::agx, Tonemap::pbrNeutral}) {
        writeImage(path("a.png"), image, {tonemap, 0.0});
        EXPECT_EQ(readImage(path("a.png")).values, (std::vector<float>{0, 0, 0, 1, 1, 1})) << static_cast<int>(tonemap);
    }
}

} // namespace
} // namespace isolux
