// The four-wide tree with quantised child boxes that devices walk: 64 bytes a node, four children in four reads.
#pragma once

#include "accel/bvh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace isolux {

/// What a child slot holds, in 32 bits. Leaves name up to 8 neighbouring entries of `WideBvh::primitives`.
class WideChild {
public:
    static constexpr std::uint32_t kEmpty = 0xFFFFFFFFu;
    static constexpr std::uint32_t kLeafBit = 0x80000000u;
    static constexpr std::uint32_t kCountShift = 28;
    static constexpr std::uint32_t kMaxCount = 8;
    static constexpr std::uint32_t kMaxFirst = (1u << kCountShift) - 1;

    static constexpr WideChild empty() { return WideChild(kEmpty); }
    static WideChild inner(std::uint32_t node);
    static WideChild leaf(std::uint32_t first, std::uint32_t count);

    [[nodiscard]] constexpr std::uint32_t bits() const { return bits_; }
    [[nodiscard]] constexpr bool isEmpty() const { return bits_ == kEmpty; }
    [[nodiscard]] constexpr bool isLeaf() const { return !isEmpty() && (bits_ & kLeafBit) != 0; }
    [[nodiscard]] constexpr std::uint32_t node() const { return bits_; }
    [[nodiscard]] constexpr std::uint32_t first() const { return bits_ & kMaxFirst; }
    [[nodiscard]] constexpr std::uint32_t count() const { return ((bits_ & ~kLeafBit) >> kCountShift) + 1; }

private:
    constexpr explicit WideChild(std::uint32_t bits) : bits_(bits) {}
    std::uint32_t bits_;
};

/// Child boxes are origin + q * 2^exponent per axis, rounded outwards (Ylitie, Karras and Laine 2017, with powers of
/// two, which decode exactly but for one rounded addition; a spare unit in the last place covers any rounding mode).
struct WideNode {
    static constexpr int kWidth = 4;

    Vec3f origin{0.0f};
    std::array<std::int8_t, 3> exponent{};
    std::array<std::array<std::uint8_t, kWidth>, 3> lower{}; ///< [axis][child]
    std::array<std::array<std::uint8_t, kWidth>, 3> upper{};
    std::array<WideChild, kWidth> children{WideChild::empty(), WideChild::empty(), WideChild::empty(),
                                           WideChild::empty()};

    /// A child's box as a device decodes it.
    [[nodiscard]] Box3f childBounds(int child) const;
};

struct WideBvh {
    std::vector<WideNode> nodes;           ///< nodes[0] is the root; parents before children; none if empty
    std::vector<std::uint32_t> primitives; ///< indices of the boxes, leaf by leaf
    std::uint32_t stackBound = 1;          ///< most entries a depth-first traversal can hold at once
};

/// Collapses a binary tree whose leaves hold at most WideChild::kMaxCount primitives.
[[nodiscard]] WideBvh buildWideBvh(const Bvh& bvh);

} // namespace isolux
