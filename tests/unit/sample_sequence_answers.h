// Words of every sampler, worked out apart from the project's code from the text of host/scene/README.md: what the host
// and the devices must draw.
#pragma once

#include "core/sample_sequence.h"

#include <array>

namespace isolux::test {

using BlockFunction = PhiloxBlock (*)(const SequencePlan&, const SampleIndex&, std::uint32_t);

struct SequenceAnswer {
    BlockFunction function;
    SequencePlan plan;
    SampleIndex index;
    std::uint32_t block;
    PhiloxBlock words;
};

inline constexpr std::uint64_t kAnswerSeed = 0x123456789ABCDEF0u;

// clang-format off
inline constexpr std::array kSequenceAnswers{
    SequenceAnswer{independentBlock, {0, 0}, {0, 0, 0}, 0, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
    SequenceAnswer{independentBlock, {7, 4}, {3, 5, 100}, 2, {0x8c17ea4e, 0x79e416d2, 0xf6a67a9a, 0x0b88ad98}},
    SequenceAnswer{independentBlock, {kAnswerSeed, 7}, {1919, 1079, 2047}, 0x80000005, {0x8795dc33, 0xbecac8db, 0x68e515f5, 0xfd3716c5}},
    SequenceAnswer{stratifiedBlock, {0, 0}, {0, 0, 0}, 0, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
    SequenceAnswer{stratifiedBlock, {7, 4}, {3, 5, 100}, 2, {0x2305fa93, 0x9e7905b4, 0x7da99ea6, 0x42e22b66}},
    SequenceAnswer{stratifiedBlock, {kAnswerSeed, 7}, {1919, 1079, 2047}, 0x80000005, {0x68795dc3, 0xb7d9591b, 0x868e515f, 0x7fa6e2d8}},
    SequenceAnswer{stratifiedBlock, {9, 18}, {2, 3, 1120005}, 1, {0x78142549, 0x681a955f, 0xd40cd4db, 0x6084171c}},
    SequenceAnswer{sobolBlock, {0, 0}, {0, 0, 0}, 0, {0xa93ce2f6, 0x32610447, 0x265588ab, 0xb7b56385}},
    SequenceAnswer{sobolBlock, {7, 4}, {3, 5, 100}, 2, {0x2a8d64da, 0x360eb502, 0x1964bf1b, 0x552d05a9}},
    SequenceAnswer{sobolBlock, {kAnswerSeed, 7}, {1919, 1079, 2047}, 0x80000005, {0xf6a9aa37, 0x9a4a0f42, 0xb9a5db54, 0x113074c9}},
    SequenceAnswer{sobolBlueNoiseBlock, {0, 0}, {0, 0, 0}, 0, {0x54d90ffa, 0xcb477cab, 0xaecd4a12, 0x2eee7684}},
    SequenceAnswer{sobolBlueNoiseBlock, {7, 4}, {3, 5, 100}, 2, {0xaa6ad1d2, 0x3990b9ae, 0x678f5534, 0xd615d43f}},
    SequenceAnswer{sobolBlueNoiseBlock, {kAnswerSeed, 7}, {1919, 1079, 2047}, 0x80000005, {0x90b35665, 0xb567b14c, 0xc7548760, 0x17d6cc69}},
};
// clang-format on

} // namespace isolux::test
