// Two renders of the same random numbers, pixel against pixel: what differs is rounding, a branch that rounding turned,
// or a mistake. Path signatures tell the last two apart.
#pragma once

#include "film/film.h"
#include "report/statistics.h"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <vector>

namespace isolux {

enum class Signature { same, different };

/// Why a pixel is outside the tolerance, if it is.
enum class Explanation { withinTolerance, otherBranch, rounding, none };

struct PairedPixel {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    Vec3d value{0.0};
    Vec3d reference{0.0};
    double relativeDifference = 0.0;
    Signature signature = Signature::same;
    Explanation explanation = Explanation::withinTolerance;
};

/// Counts are of lit pixels: those with radiance in either film. litPixels = withinTolerance + otherBranch + rounding +
/// unexplained.
struct PairedDifferences {
    double tolerance = 0.0;
    std::uint64_t pixelCount = 0;
    std::uint64_t litPixels = 0;
    std::uint64_t differentSignatures = 0; ///< lit pixels where some path took another branch, whatever the difference
    std::uint64_t withinTolerance = 0;
    std::uint64_t otherBranch = 0; ///< outside the tolerance, and the signatures differ
    std::uint64_t rounding = 0;    ///< outside on the same branches, but single precision on the CPU errs there as well
    std::uint64_t unexplained = 0; ///< outside the tolerance without either reason
    double medianDifference = 0.0; ///< of the relative differences of lit pixels
    double difference999 = 0.0;    ///< their 99.9th percentile
    Interval luminanceBias;        ///< relative bias of mean luminance, paired
    std::vector<PairedPixel> worst; ///< unexplained ones first, then by relative difference; at most ten
};

/// A pixel's relative difference: the largest over the channels of |a_c - b_c| / max(|b_c|, luminance(b)), b being the
/// reference. Each channel is held to its own value, but a channel darker than the pixel's luminance, whose rounding
/// comes from the brighter ones, to that. It is infinite where the reference is black and the image is not, and where
/// either is not finite.
[[nodiscard]] double relativeDifference(const Vec3d& value, const Vec3d& reference);

struct PairedOptions {
    double tolerance = 1e-3; ///< relative difference that rounding may cause in any pixel
    /// The reference's films in single precision, if the film under test is: some paths (between spheres, say) amplify
    /// rounding thousandfold, and then two correct programs differ as much from double as from each other. A pixel
    /// whose difference is at most kRoundingFactor times that of any of these is explained by rounding. One with path
    /// signatures counts only where they are the reference's, as another branch is no rounding error, unless
    /// kUntoldAfter of them agree that the branch cannot be told.
    std::span<const Film> singlePrecision;
};

/// Rounding errors are random: by chance a single-precision film's may be small where the other's is large. If both are
/// alike and normal, their ratio has Cauchy's distribution: one film is a hundred times closer in 2/pi atan(1/100) =
/// 0.6 % of the pixels whose rounding matters. All of k films whose rounding is independent are in E[(2 Phi(|x|/100) -
/// 1)^k], x normal, so about (2/pi)^(k/2) 100^-k E|x|^k: 6e-5, 8e-7 and 1e-8 for k = 2, 3, 4.
inline constexpr double kRoundingFactor = 100.0;

/// With this many films of single precision all of which left the reference's branch in a pixel, that precision cannot
/// tell the branch there, and rounding explains what one that met it is off by, to the same factor. A mistake is not
/// hidden so: few pixels are of that kind (11 of 134,000 lit ones in six scenes with meshes of many small triangles),
/// whatever else is wrong.
inline constexpr std::size_t kUntoldAfter = 4;

/// Compares the films of one scene, seed and range of samples, rendered with path signatures. Throws Error (bad input)
/// if their sizes or sample counts differ.
[[nodiscard]] PairedDifferences pairedDifferences(const Film& film, const Film& reference,
                                                  const PairedOptions& options = {});

[[nodiscard]] std::string toText(const PairedDifferences& differences);
[[nodiscard]] nlohmann::ordered_json toJson(const PairedDifferences& differences);

} // namespace isolux
