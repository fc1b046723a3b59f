// Cryptomatte (Friedman and Jones 2015, specification 1.2): which named things a pixel shows, and how much of each.
#pragma once

#include "film/film.h"
#include "film/image.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace isolux {

/// MurmurHash3_x86_32 (Appleby 2011) of the bytes of `text`, seed 0.
[[nodiscard]] std::uint32_t murmurHash3(std::string_view text);

/// The number that stands for a name: its hash as a float32, which is always finite and normal.
[[nodiscard]] float cryptomatteId(std::string_view name);

/// 32 ranks, where other renderers keep 6 by default: a pixel with more shows crumbs of at most 3 % each, and every
/// layer costs 16 bytes a pixel of the whole image.
inline constexpr std::size_t kMostLayers = 16;

/// One set of names, such as those of the objects.
class Cryptomatte {
public:
    struct Rank {
        float id = 0.0f;
        float coverage = 0.0f; ///< share of the pixel's samples
    };

    /// `names` by object; objects that share one become one. `type` begins the names of the channels.
    Cryptomatte(std::string type, std::vector<std::string> names);

    /// What a pixel shows, the largest coverage first.
    [[nodiscard]] std::vector<Rank> ranks(const PixelAovs& pixel, std::uint64_t sampleCount) const;
    /// How many layers of two ranks each hold every rank of every pixel; at least one and at most kMostLayers. A
    /// warning counts the pixels that show more things than fit, and the largest share of one that is left out.
    [[nodiscard]] std::size_t layerCount(const Film& film) const;
    /// "TYPE00.R", "TYPE00.G", ...: id and coverage in turn.
    [[nodiscard]] std::vector<std::string> channels(std::size_t layers) const;
    /// How to decode the channels, and the manifest: every name with its id.
    [[nodiscard]] Metadata metadata() const;

private:
    std::string type_;
    std::vector<std::string> names_;
    std::vector<float> ids_; ///< beside names_
};

} // namespace isolux
