// The random words of a sample, by sampler: integer arithmetic alone, so that every backend draws the same numbers.
// shaders/core/sample_sequence.glsl is its twin.
#pragma once

#include "core/philox.h"

#include <cstdint>

namespace isolux {

/// Samples are dealt to so many independently randomised replicates in turn: sample s belongs to replicate s mod
/// kReplicates. Samplers whose samples depend on each other take their variance from the replicates' means.
inline constexpr std::uint32_t kReplicates = 16;

/// What a sampler must know of the render. `cellBits`: the least B with 2^B * 16 at least the
/// samples that are planned.
struct SequencePlan {
    std::uint64_t seed = 0;
    std::uint32_t cellBits = 0;
};

/// The least B with 2^B * 16 >= samples.
[[nodiscard]] std::uint32_t cellBitsFor(std::uint64_t samples);

/// Which sample, of which pixel.
struct SampleIndex {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t sample = 0;
};

/// Nested uniform scrambling, approximated by a hash (Owen 1995; Laine and Karras 2011): bit b of the result is bit b
/// of `x`, flipped by a function of the key and of the bits above b.
[[nodiscard]] std::uint32_t nestedScramble(std::uint32_t x, std::uint32_t key);

/// The same with "below" for "above": the Laine-Karras hash itself, with the constants of Vegdahl 2021.
[[nodiscard]] std::uint32_t laineKarrasHash(std::uint32_t x, std::uint32_t key);

[[nodiscard]] std::uint32_t reverseBits(std::uint32_t x);

/// The second dimension of Sobol's sequence, bits reversed: bit r is the parity of the bits c of `index` with r & c = r
/// (Lucas' theorem on Pascal's triangle modulo 2, in five steps of shifts).
[[nodiscard]] std::uint32_t pascalTransform(std::uint32_t index);

/// Bits of x and y interleaved, x lowest; both below 2^16.
[[nodiscard]] std::uint32_t mortonIndex(std::uint32_t x, std::uint32_t y);

/// A block of four words under each sampler; host/scene/README.md, "Random numbers".
[[nodiscard]] PhiloxBlock independentBlock(const SequencePlan& plan, const SampleIndex& index, std::uint32_t block);
[[nodiscard]] PhiloxBlock stratifiedBlock(const SequencePlan& plan, const SampleIndex& index, std::uint32_t block);
[[nodiscard]] PhiloxBlock sobolBlock(const SequencePlan& plan, const SampleIndex& index, std::uint32_t block);
[[nodiscard]] PhiloxBlock sobolBlueNoiseBlock(const SequencePlan& plan, const SampleIndex& index, std::uint32_t block);

} // namespace isolux
