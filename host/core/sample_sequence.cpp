#include "core/sample_sequence.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace isolux {
namespace {

constexpr std::uint32_t kReplicateMask = kReplicates - 1;
constexpr std::uint32_t kReplicateBits = std::bit_width(kReplicateMask);
static_assert(std::has_single_bit(kReplicates));
constexpr std::uint32_t kSecondKeys = 0x80000000u;
constexpr std::uint64_t kKeySeed = std::uint64_t{0x5EED5E71u} << 32;
constexpr std::uint32_t kAllPixels = 0xFFFFFFFFu;
constexpr std::uint32_t kMaxCellBits = 16;

/// Keys of scrambles: apart from the words of any sample.
PhiloxBlock keyBlock(const SequencePlan& plan, std::uint32_t x, std::uint32_t y, std::uint32_t counter,
                     std::uint32_t block) {
    return randomBlock(plan.seed ^ kKeySeed, x, y, counter, block);
}

/// The highest `bits` bits of a word that starts with `cell`, the rest from `jitter`; `bits` below 32.
std::uint32_t withinCell(std::uint32_t cell, std::uint32_t bits, std::uint32_t jitter) {
    return bits == 0 ? jitter : cell << (32 - bits) | jitter >> bits;
}

PhiloxBlock sobolWords(std::uint32_t index, const PhiloxBlock& shuffles, const PhiloxBlock& scrambles) {
    PhiloxBlock words{};
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const std::uint32_t shuffled = nestedScramble(index, shuffles[pair]);
        words[2 * pair] = reverseBits(laineKarrasHash(shuffled, scrambles[2 * pair]));
        words[2 * pair + 1] = reverseBits(laineKarrasHash(pascalTransform(shuffled), scrambles[2 * pair + 1]));
    }
    return words;
}

/// Spreads the lower 16 bits to the even places.
std::uint32_t spreadBits(std::uint32_t x) {
    x = (x | x << 8) & 0x00FF00FFu;
    x = (x | x << 4) & 0x0F0F0F0Fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

} // namespace

std::uint32_t cellBitsFor(std::uint64_t samples) {
    const std::uint64_t cells = std::max<std::uint64_t>((samples + kReplicateMask) >> kReplicateBits, 1);
    return static_cast<std::uint32_t>(std::bit_width(cells - 1));
}

std::uint32_t reverseBits(std::uint32_t x) {
    x = x << 16 | x >> 16;
    x = (x & 0x00FF00FFu) << 8 | (x >> 8 & 0x00FF00FFu);
    x = (x & 0x0F0F0F0Fu) << 4 | (x >> 4 & 0x0F0F0F0Fu);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

std::uint32_t laineKarrasHash(std::uint32_t x, std::uint32_t key) {
    x ^= x * 0x3D20ADEAu;
    x += key;
    x *= key >> 16 | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return x;
}

std::uint32_t nestedScramble(std::uint32_t x, std::uint32_t key) {
    return reverseBits(laineKarrasHash(reverseBits(x), key));
}

std::uint32_t pascalTransform(std::uint32_t index) {
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0F0F0F0Fu;
    index ^= index >> 8 & 0x00FF00FFu;
    return index ^ (index >> 16 & 0x0000FFFFu);
}

std::uint32_t mortonIndex(std::uint32_t x, std::uint32_t y) { return spreadBits(x) | spreadBits(y) << 1; }

PhiloxBlock independentBlock(const SequencePlan& plan, const SampleIndex& index, std::uint32_t block) {
    return randomBlock(plan.seed, index.x, index.y, index.sample, block);
}

PhiloxBlock stratifiedBlock(const SequencePlan& plan, const SampleIndex& index, std::uint32_t block) {
    const std::uint32_t bits = std::min(plan.cellBits, kMaxCellBits);
    const std::uint32_t columnBits = (bits + 1) / 2;
    const std::uint32_t within = index.sample >> kReplicateBits;
    const std::uint32_t round = within >> bits;
    const PhiloxBlock jitter = independentBlock(plan, index, block);
    const PhiloxBlock keys =
        keyBlock(plan, index.x, index.y, (index.sample & kReplicateMask) + (round << kReplicateBits), block);
    PhiloxBlock words{};
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const std::uint32_t shuffled = nestedScramble(within, keys[pair]);
        const std::uint32_t cell =
            bits == 0 ? 0 : reverseBits(laineKarrasHash(shuffled, keys[2 + pair])) >> (32 - bits);
        const std::uint32_t column = cell & ((1u << columnBits) - 1);
        words[2 * pair] = withinCell(column, columnBits, jitter[2 * pair]);
        words[2 * pair + 1] = withinCell(cell >> columnBits, bits - columnBits, jitter[2 * pair + 1]);
    }
    return words;
}

PhiloxBlock sobolBlock(const SequencePlan& plan, const SampleIndex& index, std::uint32_t block) {
    const std::uint32_t replicate = index.sample & kReplicateMask;
    return sobolWords(index.sample >> kReplicateBits, keyBlock(plan, index.x, index.y, replicate, block),
                      keyBlock(plan, index.x, index.y, replicate + kSecondKeys, block));
}

PhiloxBlock sobolBlueNoiseBlock(const SequencePlan& plan, const SampleIndex& index, std::uint32_t block) {
    assert(index.sample >> kReplicateBits >> plan.cellBits == 0);
    const std::uint32_t replicate = index.sample & kReplicateMask;
    const std::uint32_t place = mortonIndex(index.x, index.y) << plan.cellBits | index.sample >> kReplicateBits;
    return sobolWords(place, keyBlock(plan, kAllPixels, kAllPixels, replicate, block),
                      keyBlock(plan, kAllPixels, kAllPixels, replicate + kSecondKeys, block));
}

} // namespace isolux
