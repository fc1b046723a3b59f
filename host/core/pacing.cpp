#include "core/pacing.h"

#include <algorithm>

namespace isolux {

std::uint32_t Pacing::nextPass(std::uint32_t done, std::uint32_t total) const {
    const std::uint32_t left = std::min(total - done, largest_);
    if (!limit_ || left == 0) return left;
    if (done == 0) return 1;
    const double elapsed = watch_.seconds();
    const double affordable = (*limit_ - elapsed) / elapsed * static_cast<double>(done);
    const double samples = std::min({static_cast<double>(left), static_cast<double>(done), affordable});
    return samples < 1.0 ? 0 : static_cast<std::uint32_t>(samples);
}

double Pacing::fraction(double done, std::uint32_t total) const {
    const double ofSamples = done / static_cast<double>(total);
    const double ofTime = limit_ ? watch_.seconds() / *limit_ : 0.0;
    return std::clamp(std::max(ofSamples, ofTime), 0.0, 1.0);
}

} // namespace isolux
