#include "scene/alias_table.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace isolux {
namespace {

/// Integer shares of `total` in proportion to `weights`: at least 1 for a positive weight, and summing to `total`.
std::vector<std::uint64_t> integerShares(std::span<const double> weights, std::uint64_t total) {
    // Scaling by the maximum first keeps the sum finite for weights near the largest double.
    const double largest = *std::max_element(weights.begin(), weights.end());
    double sum = 0.0;
    for (const double weight : weights) sum += weight / largest;
    std::vector<std::uint64_t> shares(weights.size(), 0);
    std::uint64_t assigned = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!(weights[i] > 0.0)) continue;
        const double exact = weights[i] / largest / sum * static_cast<double>(total);
        shares[i] = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::floor(exact)));
        assigned += shares[i];
    }
    // The rounding goes to the largest share, where it is relatively least. It may be negative; there are at most 2^28
    // items and at least 2^32 units a bin, so the largest share can always bear it.
    *std::max_element(shares.begin(), shares.end()) += total - assigned;
    return shares;
}

} // namespace

AliasTable buildAliasTable(std::span<const double> weights) {
    AliasTable table;
    if (std::none_of(weights.begin(), weights.end(), [](double weight) { return weight > 0.0; })) return table;
    assert(weights.size() <= (1u << 28));
    table.bits = static_cast<std::uint32_t>(std::bit_width(weights.size() - 1));
    const std::size_t binCount = std::size_t{1} << table.bits;
    constexpr std::uint64_t kBinUnits = std::uint64_t{1} << 32;
    const std::uint64_t total = kBinUnits * binCount;

    std::vector<std::uint64_t> shares = integerShares(weights, total);
    table.pdf.reserve(shares.size());
    for (const std::uint64_t share : shares)
        table.pdf.push_back(static_cast<double>(share) / static_cast<double>(total));

    shares.resize(binCount, 0);
    table.bins.resize(binCount);
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::uint32_t i = 0; i < binCount; ++i) (shares[i] < kBinUnits ? small : large).push_back(i);
    while (!small.empty()) {
        const std::uint32_t lesser = small.back();
        small.pop_back();
        const std::uint32_t greater = large.back();
        table.bins[lesser] = {static_cast<std::uint32_t>(shares[lesser]), greater};
        shares[greater] -= kBinUnits - shares[lesser];
        if (shares[greater] < kBinUnits) {
            large.pop_back();
            small.push_back(greater);
        }
    }
    // In integers what is left fills its bins exactly.
    for (const std::uint32_t i : large) table.bins[i] = {0xFFFFFFFFu, i};
    return table;
}

} // namespace isolux
