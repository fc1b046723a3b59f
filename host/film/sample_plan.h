// Which pixels take how many samples next: all of them, those whose error is still too large, as many as time allows,
// until the image is good enough. Both renderers follow it, so they stop for the same reasons.
#pragma once

#include "core/pacing.h"
#include "film/film.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace isolux {

/// When a pixel has samples enough: 1.96 sigma / sqrt(n) <= tolerance * mean, of luminance, in the pixel and in each of
/// its eight neighbours. Tested after `minSamples`, and then after every `batch` more. A black pixel whose camera rays
/// met something must wait for kBlackPatience times as many samples, as 0 <= 0 says nothing about light that few
/// samples find. Stopping so is biased (Kirk and Arvo 1991): README.md has the figures.
struct AdaptiveRule {
    static constexpr std::uint32_t kBlackPatience = 16;

    double tolerance = 0.05;
    std::uint32_t batch = 32; ///< at least 1
    std::uint32_t minSamples = 64;
};

/// What may end a render before all samples are taken.
struct StoppingRule {
    std::optional<double> seconds; ///< stop after about this time, at least one sample a pixel
    std::optional<AdaptiveRule> adaptive;
    /// Stop when estimatedRelativeRmse(film) is at most this; judged after each pass from 16 samples on. Also when it
    /// is still NaN after 1024: no number of samples is sure to tell the error of an image that is black or holds NaN.
    std::optional<double> relativeError;
};

/// A pixel of a film: x in the lower 16 bits, y in the upper.
[[nodiscard]] constexpr std::uint32_t packPixel(std::uint32_t x, std::uint32_t y) { return x | (y << 16); }
[[nodiscard]] constexpr std::uint32_t pixelX(std::uint32_t pixel) { return pixel & 0xFFFFu; }
[[nodiscard]] constexpr std::uint32_t pixelY(std::uint32_t pixel) { return pixel >> 16; }

/// Samples firstSample ... firstSample + sampleCount - 1 of some pixels.
struct Pass {
    std::uint32_t firstSample = 0;
    std::uint32_t sampleCount = 0;
    std::span<const std::uint32_t> pixels; ///< in the order the plan was given; valid until the next call of `next`
};

/// How large the first passes are: as large as the others, or 1, 1, 2, 4, 8 samples, which shows and interrupts sooner.
enum class FirstPasses { full, growing };

struct SampleRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

class SamplePlan {
public:
    static constexpr std::uint32_t kLargestPass = 16; ///< samples; renderers sum so many in single precision

    /// `pixels`: what is to be rendered. The clock of a time limit starts here.
    SamplePlan(const StoppingRule& rule, const SampleRange& samples, FirstPasses firstPasses,
               std::vector<std::uint32_t> pixels);

    /// The next pass, judged by what `film` holds after the one before, its variance refined; nothing when all is done.
    /// All pixels of a pass have taken the same samples so far.
    [[nodiscard]] std::optional<Pass> next(const Film& film);

    /// How much of the work is done when `part` of the current pass is: of the samples that pixels still active may
    /// take, of the time, or of what the error takes to fall, whichever ends first; in [0, 1], and never less than
    /// before.
    [[nodiscard]] double fraction(double part) const;

private:
    void judgeError(const Film& film);
    void dropFinishedPixels(const Film& film);
    [[nodiscard]] std::uint32_t samplesUntilTest() const;
    [[nodiscard]] std::uint32_t nextPassSamples() const;

    StoppingRule rule_;
    SampleRange samples_;
    FirstPasses firstPasses_;
    Pacing pacing_;
    std::vector<std::uint32_t> pixels_; ///< still active
    std::uint32_t done_ = 0;            ///< samples that every active pixel has taken
    std::uint32_t passSamples_ = 0;     ///< of the current pass
    std::uint64_t taken_ = 0;           ///< samples of all pixels
    double errorFraction_ = 0.0;        ///< (wanted error / error)^2: the error falls with the root of the samples
};

/// Which pixels satisfy the rule, they and their neighbours; `film.width * film.height` entries, row by row. A pixel
/// without two samples satisfies nothing; one outside the film is no neighbour.
[[nodiscard]] std::vector<bool> satisfiedPixels(const Film& film, const AdaptiveRule& rule);

} // namespace isolux
