// Discrete sampling by an integer alias table: the definition of light choice that both renderers share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// Walker's alias method (Walker 1977; Vose 1991) in integers. There are 2^m bins. A first random word's top m bits
/// choose the bin; a second word w keeps the bin's own item if w < threshold or alias == the bin itself, else its
/// alias. Every probability is therefore a multiple of 2^-(32+m), and `pdf` is that rational, rounded once.
struct AliasTable {
    struct Bin {
        std::uint32_t threshold = 0;
        std::uint32_t alias = 0;
    };
    std::vector<Bin> bins;   ///< 2^m of them, at least as many as items
    std::vector<double> pdf; ///< one per item, sums to 1
    std::uint32_t bits = 0;  ///< m
};

/// Builds the table for non-negative weights; every item of positive weight can be chosen, whatever the others weigh.
/// Empty if no weight is positive. At most 2^28 items.
[[nodiscard]] AliasTable buildAliasTable(std::span<const double> weights);

/// The item that two random words choose.
[[nodiscard]] inline std::uint32_t sampleAliasTable(const AliasTable& table, std::uint32_t binWord,
                                                    std::uint32_t aliasWord) {
    const std::uint32_t bin = table.bits == 0 ? 0 : binWord >> (32 - table.bits);
    return aliasWord < table.bins[bin].threshold ? bin : table.bins[bin].alias;
}

} // namespace isolux
