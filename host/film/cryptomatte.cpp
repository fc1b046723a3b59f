#include "film/cryptomatte.h"

#include "core/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <utility>

namespace isolux {
namespace {

/// The four bytes or fewer at the start of `bytes`, the first one lowest, on any machine.
std::uint32_t littleEndianWord(std::string_view bytes) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(bytes.size(), 4); ++i)
        word |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    return word;
}

std::uint32_t scramble(std::uint32_t word) { return std::rotl(word * 0xcc9e2d51u, 15) * 0x1b873593u; }

/// Spreads every bit over the whole word: MurmurHash3's last step.
std::uint32_t avalanche(std::uint32_t hash) {
    hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
    return hash ^ (hash >> 16);
}

/// The bits of an id, in the form that manifests have.
std::string hexadecimal(float id) { return fmt::format("{:08x}", std::bit_cast<std::uint32_t>(id)); }

/// A JSON string (RFC 8259, section 7).
std::string jsonString(std::string_view text) {
    std::string json = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            json += fmt::format("\\{}", c);
        else if (static_cast<unsigned char>(c) < 0x20)
            json += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            json += c;
    }
    return json + '"';
}

} // namespace

std::uint32_t murmurHash3(std::string_view text) {
    std::uint32_t hash = 0;
    std::string_view rest = text;
    for (; rest.size() >= 4; rest.remove_prefix(4))
        hash = std::rotl(hash ^ scramble(littleEndianWord(rest)), 13) * 5 + 0xe6546b64u;
    hash ^= scramble(littleEndianWord(rest));
    return avalanche(hash ^ static_cast<std::uint32_t>(text.size()));
}

/// Exponents 0 and 255 would make denormal, infinite or NaN values, which not every program keeps: their lowest bit is
/// flipped (specification 1.2, "Floating point conversion").
float cryptomatteId(std::string_view name) {
    const std::uint32_t hash = murmurHash3(name);
    const std::uint32_t exponent = (hash >> 23) & 0xffu;
    return std::bit_cast<float>(exponent == 0 || exponent == 255 ? hash ^ (1u << 23) : hash);
}

Cryptomatte::Cryptomatte(std::string type, std::vector<std::string> names)
    : type_(std::move(type)), names_(std::move(names)) {
    ids_.reserve(names_.size());
    for (const std::string& name : names_) ids_.push_back(cryptomatteId(name));
}

std::vector<Cryptomatte::Rank> Cryptomatte::ranks(const PixelAovs& pixel, std::uint64_t sampleCount) const {
    std::map<float, std::uint64_t> samples; // sorted, so that equal coverages come in the same order everywhere
    for (const PixelAovs::Coverage& coverage : pixel.objects) samples[ids_[coverage.object]] += coverage.samples;
    std::vector<std::pair<float, std::uint64_t>> sorted(samples.begin(), samples.end());
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::vector<Rank> ranks;
    ranks.reserve(sorted.size());
    for (const auto& [id, count] : sorted)
        ranks.push_back({id, static_cast<float>(static_cast<double>(count) / static_cast<double>(sampleCount))});
    return ranks;
}

std::size_t Cryptomatte::layerCount(const Film& film) const {
    std::size_t most = 1;
    std::size_t crowded = 0;
    double leftOut = 0.0;
    for (std::size_t i = 0; i < film.aovs.size(); ++i) {
        if (film.aovs[i].objects.size() <= most) continue;
        const std::vector<Rank> shown = ranks(film.aovs[i], film.pixels[i].sampleCount);
        most = std::max(most, std::min(shown.size(), 2 * kMostLayers));
        if (shown.size() <= 2 * kMostLayers) continue;
        ++crowded;
        double coverage = 0.0;
        for (std::size_t rank = 2 * kMostLayers; rank < shown.size(); ++rank) coverage += shown[rank].coverage;
        leftOut = std::max(leftOut, coverage);
    }
    if (crowded > 0)
        spdlog::warn("{}: {} pixels show more than {} things; of one {:.3g} % of the coverage is left out", type_,
                     crowded, 2 * kMostLayers, 100.0 * leftOut);
    return (most + 1) / 2;
}

std::vector<std::string> Cryptomatte::channels(std::size_t layers) const {
    std::vector<std::string> names;
    for (std::size_t layer = 0; layer < layers; ++layer) {
        for (const char channel : {'R', 'G', 'B', 'A'})
            names.push_back(fmt::format("{}{:02}.{}", type_, layer, channel));
    }
    return names;
}

Metadata Cryptomatte::metadata() const {
    std::map<std::string, float> ids;
    for (std::size_t object = 0; object < names_.size(); ++object) ids[names_[object]] = ids_[object];
    std::string manifest;
    for (const auto& [name, id] : ids)
        manifest += fmt::format("{}{}:\"{}\"", manifest.empty() ? "" : ",", jsonString(name), hexadecimal(id));
    const std::string prefix = "cryptomatte/" + hexadecimal(cryptomatteId(type_)).substr(0, 7);
    return {{prefix + "/name", type_},
            {prefix + "/hash", "MurmurHash3_32"},
            {prefix + "/conversion", "uint32_to_float32"},
            {prefix + "/manifest", "{" + manifest + "}"}};
}

} // namespace isolux
