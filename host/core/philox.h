// Random numbers defined by integer arithmetic alone: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers:
// as easy as 1, 2, 3"), indexed by (seed, pixel, sample, block). shaders/core/philox.glsl is its twin.
#pragma once

#include <array>
#include <cstdint>

namespace isolux {

using PhiloxBlock = std::array<std::uint32_t, 4>;

/// Ten rounds of Philox4x32; `counter` and `key` as in the paper, so its known answers hold.
[[nodiscard]] constexpr PhiloxBlock philox4x32(PhiloxBlock counter, std::array<std::uint32_t, 2> key) {
    constexpr std::uint64_t kMultiplier0 = 0xD2511F53u;
    constexpr std::uint64_t kMultiplier1 = 0xCD9E8D57u;
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t product0 = kMultiplier0 * counter[0];
        const std::uint64_t product1 = kMultiplier1 * counter[2];
        counter = {
            static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(product1),
            static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(product0)};
        key[0] += 0x9E3779B9u; // golden ratio
        key[1] += 0xBB67AE85u; // sqrt(3) - 1
    }
    return counter;
}

/// Four 32-bit words for one block of dimensions of one sample of one pixel. host/scene/README.md lists the blocks.
[[nodiscard]] constexpr PhiloxBlock randomBlock(std::uint64_t seed, std::uint32_t pixelX, std::uint32_t pixelY,
                                                std::uint32_t sample, std::uint32_t block) {
    return philox4x32({pixelX, pixelY, sample, block},
                      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
}

/// A word as a number in [0, 1 - 2^-24], exact in float and double alike, and never 1.
template <typename Real> [[nodiscard]] constexpr Real unitReal(std::uint32_t word) {
    return static_cast<Real>(word >> 8) * static_cast<Real>(1.0 / 16777216.0);
}

} // namespace isolux
